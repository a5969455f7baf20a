"""The chart's title: which quantity, of what each point is the largest, and how far back."""

from itertools import product

from engine.scenes import SCENES
from tui.playback.shown import QUANTITIES, WINDOWS, Shown
from tui.views.lab.time_chart import title


def test_a_title_says_what_the_chart_shows_and_fits_above_the_narrowest_chart():
    for quantity, log, seconds, scene in product(QUANTITIES, (True, False), WINDOWS, ("drift", "spin")):
        text = title(Shown(quantity=quantity, log=log, seconds=seconds), SCENES[scene].exact())
        assert len(text) + 6 <= 52  # of 80 columns the pendulums have 28; two corners, two lines, two spaces
        assert ("per half swing" in text) == (log and scene == "drift")
        assert ("per turn" in text) == (log and scene == "spin")
