"""Phase space as it looks."""

import math

import pytest

from engine.scenes import SCENES, Scene
from tui.display import Display
from tui.still import still

DRIFT = SCENES["drift"]


@pytest.mark.parametrize(
    ("size", "theme"),
    [((80, 24), "dark"), ((120, 40), "light"), ((200, 60), "dark")],
    ids=["80x24", "120x40", "200x60"],
)
async def test_phase_space_over_the_whole_screen_with_rings_and_the_exact_point(snapshot, size, theme):
    snapshot(f"phase-{size[0]}x{size[1]}-{theme}", await still(DRIFT, 6.0, size, Display(theme), ["f3", "5"]))


async def test_the_neighbourhood_of_the_unstable_point_under_a_crosshair(snapshot):
    keys = ["f3", "g", "g", "g", "up", "down", *["z"] * 25]
    snapshot("phase-saddle", await still(Scene(theta=math.pi), 0.0, (120, 40), keys=keys))


async def test_unwrapped_one_sees_the_methods_go_away(snapshot):
    snapshot("phase-unwrapped", await still(SCENES["spin"], 1.5, (80, 24), keys=["f3", "c"]))
