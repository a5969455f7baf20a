"""How far pendulums may swing: their picture is larger where none needs the room above the pivot."""

import math

import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.views.reach import amplitude, reach
from tests.tui.harness import Lab


def reaches(scene, seconds, shown):
    """Second by second."""
    lab = Lab(scene)
    return [reach(scene, lab.live.stepping, lab.run(1), shown).widest for _ in range(seconds)]


@pytest.mark.parametrize(
    ("name", "angle"), [("drift", 1.3), ("gentle", 0.13), ("large-swing", math.pi)]
)
def test_the_swing_decides_but_explicit_euler_needs_the_pivot_in_the_middle(name, angle):
    assert reaches(SCENES[name], 20, (1, 2, 3)) == pytest.approx([angle] * 20)
    assert reaches(SCENES[name], 1, range(4)) == [math.pi]


def test_the_bound_only_widens_in_a_run_so_the_picture_never_jumps_back():
    scene = SCENES["gentle"].altered(h=0.6).with_cast(USUAL_CAST[1:])
    seen = reaches(scene, 60, (0, 1, 2))
    assert seen == sorted(seen)


@pytest.mark.parametrize("name", ["drift", "gentle", "crossover"])
def test_no_method_ever_swings_beyond_it(name):
    lab = Lab(SCENES[name])
    for _ in range(300):
        sample = lab.run(1 / 10)
        bound = reach(SCENES[name], lab.live.stepping, sample, (1, 2, 3)).widest
        assert max(abs(reading.theta) for reading in sample.readings[1:]) <= bound


def test_a_method_beyond_its_limit_gets_all_the_room_at_once():
    lab = Lab(SCENES["gentle"])
    lab.live.set_stepping(Stepping(0.7))  # z = 2.2
    assert reach(SCENES["gentle"], lab.live.stepping, lab.live.sample, (2,)).widest == math.pi


def test_the_frame_holds_what_stays_and_leaves_out_what_goes():
    scene = SCENES["gentle"]
    size = amplitude(scene.equations, scene.theta, scene.omega)
    assert size == pytest.approx(0.1)
    lab = Lab(scene)
    for _ in range(30):
        found = reach(scene, lab.live.stepping, lab.run(1), range(4))
        assert found.frame == pytest.approx(1.3 * size)  # although Explicit Euler is far out
