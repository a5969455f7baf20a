"""Phase space as it looks."""

import math

from engine.scenes import Scene
from tui.screens.still import still


async def test_the_neighbourhood_of_the_unstable_point_under_a_crosshair(text_snapshot):
    hide_all = ["1", "2", "3", "4"]  # their errors would be the last bit of a sine
    keys = ["f3", *["g"] * 7, "up", "down", *["z"] * 25, *hide_all]
    text_snapshot("phase-saddle", await still(Scene(theta=math.pi), 0.0, (120, 40), keys=keys))
