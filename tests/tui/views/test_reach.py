"""How far pendulums may swing: their picture is larger where none needs the room above the pivot."""

import math

import pytest

from engine.methods import USUAL_CAST
from engine.run.stepping import Stepping
from engine.scenes import SCENES
from tests.tui.drawn import cells
from tests.tui.harness import Lab
from tui.views.lab.pendulums import TOP, Bob, pendulum_picture
from tui.views.reach import REACHES, reach

SMALL, MIDDLE, QUARTER = REACHES


def reaches(scene, seconds, shown=(0, 1, 2, 3)):
    """Second by second."""
    lab = Lab(scene)
    return [reach(scene, lab.live.stepping, lab.run(1), shown) for _ in range(seconds)]


def test_explicit_euler_needs_the_pivot_in_the_middle_from_the_start():
    assert set(reaches(SCENES["drift"], 3)) == {math.pi}


@pytest.mark.parametrize(
    ("name", "angle"), [("drift", MIDDLE), ("gentle", SMALL), ("large-swing", math.pi)]
)
def test_without_it_the_swing_decides(name, angle):
    assert set(reaches(SCENES[name], 20, (1, 2, 3))) == {angle}


def test_the_bound_only_widens_in_a_run_so_the_picture_never_jumps_back():
    scene = SCENES["gentle"].altered(h=0.6).with_cast(USUAL_CAST[1:])
    seen = reaches(scene, 60, (0, 1, 2))
    assert seen == sorted(seen)


def test_no_method_ever_swings_beyond_it():
    for name in ("drift", "gentle", "crossover"):
        lab = Lab(SCENES[name])
        for _ in range(300):
            sample = lab.run(1 / 10)
            bound = reach(SCENES[name], lab.live.stepping, sample, (1, 2, 3))
            assert max(abs(reading.theta) for reading in sample.readings[1:]) <= bound


def test_a_method_beyond_its_limit_gets_all_the_room_at_once():
    lab = Lab(SCENES["gentle"])
    lab.live.set_stepping(Stepping(0.7))  # z = 2.2
    assert reach(SCENES["gentle"], lab.live.stepping, lab.live.sample, (2,)) == math.pi


@pytest.mark.parametrize("angle", REACHES)
@pytest.mark.parametrize("size", [(24, 11), (42, 14), (26, 13), (10, 30)])
def test_hung_from_the_top_a_pendulum_within_its_reach_stays_in_its_pane_and_is_no_shorter(
    size, angle
):
    columns, rows = size
    for theta in (-angle, 0.0, angle):
        shown = cells(pendulum_picture(columns, rows, [Bob(theta, 0)], angle))
        assert min(row for row, _ in shown) * 4 <= TOP
        x = [column for _, column in shown]
        assert max(x) - min(x) + 1 < columns or not theta
    assert span(size, angle) >= span(size, math.pi)


def span(size, angle):
    """Rows from the pivot to the bob of a pendulum at rest."""
    columns, rows = size
    found = [row for row, _ in cells(pendulum_picture(columns, rows, [Bob(0.0, 0)], angle))]
    return max(found) - min(found)
