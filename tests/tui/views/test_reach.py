"""How far pendulums swing: their picture is larger where none needs the room above the pivot."""

import math

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.views.viewport import amplitude, reach
from tests.tui.harness import Lab


def reaches(name, seconds, shown):
    """Second by second, with the angles of these methods [rad]."""
    lab = Lab(SCENES[name])
    for _ in range(seconds):
        sample = lab.run(1)
        thetas = [abs(sample.readings[place].theta) for place in shown]
        yield reach(lab.live.scene, lab.live.stepping, sample, shown), thetas


@pytest.mark.parametrize(
    ("name", "low", "high"), [("drift", 1.0, 1.25), ("gentle", 0.1, 0.125), ("large-swing", 2.5, 3)]
)
def test_the_swing_decides_and_explicit_euler_leaves_it_until_it_needs_the_whole_circle(
    name, low, high
):
    found = [each for each, _ in reaches(name, 20, range(4))]
    assert all(low <= each.frame <= high for each in found)
    widest = [each.widest for each in found]
    assert widest == sorted(widest)  # so the picture never jumps back
    scene = SCENES[name]
    assert amplitude(scene.equations, scene.theta, 0.0) == pytest.approx(scene.theta, abs=1e-9)
    assert low <= widest[0] <= widest[-1] == math.pi


@pytest.mark.parametrize("name", ["drift", "gentle", "crossover", "linear"])
def test_no_method_ever_swings_beyond_it(name):
    for found, thetas in reaches(name, 20, (1, 2, 3)):
        assert max(thetas) <= found.frame == found.widest


def test_the_frame_leaves_out_a_method_beyond_its_limit():
    lab = Lab(SCENES["gentle"])
    lab.live.change(Stepping(0.7))  # z = 2.2
    lab.run(20)
    found = reach(SCENES["gentle"], lab.live.stepping, lab.live.sample, (2,))
    assert found.frame < 0.12 < found.widest
    lab.live.start(SCENES["gentle"])
    lab.live.change(Stepping(2.4, equal_cost=True))  # its own z is 1.9
    lab.run(20)
    found = reach(SCENES["gentle"], lab.live.stepping, lab.live.sample, (2,))
    assert 0.12 < found.frame == found.widest
