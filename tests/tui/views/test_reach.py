"""How far pendulums swing: their picture is larger where none needs the room above the pivot."""

import math

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.views.viewport import amplitude, reach
from tests.tui.harness import Lab


@pytest.mark.parametrize(
    ("name", "low", "high"), [("drift", 1.0, 1.25), ("gentle", 0.1, 0.125), ("large-swing", 2.5, 3)]
)
def test_the_swing_decides_and_explicit_euler_leaves_it_until_it_needs_the_whole_circle(
    name, low, high
):
    scene = SCENES[name]
    lab = Lab(scene)
    widest = []
    for _ in range(20):
        sample = lab.run(1)
        found = reach(scene, lab.live.stepping, sample, range(4))
        assert low <= found.frame <= high
        assert max(abs(reading.theta) for reading in sample.readings[1:]) <= found.frame
        widest.append(found.widest)
    assert widest == sorted(widest)  # so the picture never jumps back
    assert amplitude(scene.equations, scene.theta, 0.0) == pytest.approx(scene.theta, abs=1e-9)
    assert low <= widest[0] <= widest[-1] == math.pi


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
