"""Words and numbers about the ring and a state."""

import math

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.engine.studies.ring import Neighbours
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.views.phase import area_text
from pendu_tui.tui.views.portrait import ring_text


def followed(live, steps=200):
    """A ring carried by so many steps."""
    ring = Neighbours(0.1)
    ring.follow(live.scene, live.sample.run, live.sample.step, live.changes, steps)
    return ring


@pytest.mark.parametrize(
    ("ratio", "text"),
    [
        (1.0, "1"),
        (1 + 2**-52, "1 + 2.2e-16"),
        (1 - 3e-7, "1 - 3.0e-07"),
        (0.99783850123, "0.997838501"),
        (3.42e12, "3.420e+12"),
        (999.5, "999.500000000"),
        (1000.5, "1.000e+03"),
        (1.1e-3, "0.001100000"),
        (0.9e-3, "9.000e-04"),
        (0.0, "< 1e-308"),
        (math.inf, "> 1e308"),
    ],
)
def test_an_area_has_digits_enough_to_tell_it_from_one(ratio, text):
    assert area_text(ratio) == text


def test_a_ring_that_is_behind_says_by_how_many_steps():
    live = Live(Scene())
    live.step(200)
    assert ring_text(live, followed(live)) == "ring, radius 0.1 rad"
    assert ring_text(live, followed(live, 50)) == "ring, radius 0.1 rad, 150 steps behind"
    of_before = followed(live)
    live.start(live.scene)
    live.step(7)
    assert ring_text(live, of_before).endswith(", 7 steps behind")
    stiff = Live(SCENES["stiff-slow"])
    assert ring_text(stiff, None) == stiff.scene.why_no_ring != ""


def test_with_friction_the_true_motion_leaves_less_area_even_after_a_change_of_h():
    live = Live(SCENES["damped"])
    live.step(100)
    live.change(Stepping(0.05, cast=live.scene.cast))
    live.step(100)
    left = f"{math.exp(-0.05 * 7.5):.9f}"
    ring = followed(live)
    assert f"the true motion leaves {left} of its area" in ring_text(live, ring)
