"""The chart: what its title says, and how it answers to the mouse."""

from itertools import product

from textual.events import MouseScrollUp

from engine.scenes import SCENES
from tests.tui.harness import lab
from tui.playback.shown import QUANTITIES, WINDOWS, Shown
from tui.views.lab.time_chart import TimeChart, title


def test_a_title_says_what_the_chart_shows_and_fits_above_the_narrowest_chart():
    for quantity, log, seconds, scene in product(QUANTITIES, (True, False), WINDOWS, ("drift", "spin")):
        text = title(Shown(quantity=quantity, log=log, seconds=seconds), SCENES[scene].exact())
        assert len(text) + 6 <= 52  # of 80 columns the pendulums have 28; two corners, two lines, two spaces
        assert ("per half swing" in text) == (log and scene == "drift")
        assert ("per turn" in text) == (log and scene == "spin")


async def test_the_pointer_reads_the_chart_out_and_the_wheel_takes_another_window():
    async with lab() as theatre:
        await theatre.run(12)
        await theatre.settled()
        chart = theatre.stage.query(TimeChart).first()
        await theatre.pilot.hover(chart, offset=(30, 4))
        told = str(chart.border_subtitle)
        assert [word for word in told.split() if word in "esvr"] == ["e", "s", "v", "r"]
        assert told.startswith(f"{chart._plot.at(29).t:.2f} s:")
        chart.on_mouse_scroll_up(MouseScrollUp(chart, 5, 5, 0, -1, 0, False, False, False))
        await theatre.pilot.pause()
        await theatre.pilot.pause()
        assert theatre.stage.shown.seconds == 5.0
        await theatre.press("u")
        assert theatre.stage.shown.seconds is None
        assert [each.message for each in theatre.app._notifications] == ["Undone: the window of the chart"]
