"""Phase space as it looks."""

import math

from engine.scenes import SCENES, Scene
from tui.screens.still import still


async def test_the_neighbourhood_of_the_unstable_point_under_a_crosshair(text_snapshot):
    keys = ["f3", "g", "g", "g", "up", "down", *["z"] * 25]
    text_snapshot("phase-saddle", await still(Scene(theta=math.pi), 0.0, (120, 40), keys=keys))


async def test_unwrapped_one_sees_the_methods_go_away(text_snapshot):
    text_snapshot("phase-unwrapped", await still(SCENES["spin"], 1.5, (80, 24), keys=["f3", "c"]))
