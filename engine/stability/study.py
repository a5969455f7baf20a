"""The stability of a cast: first failures on a ladder of z, and the grid of a map."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from pendu_tui.engine.methods import Method
from pendu_tui.engine.scenes import Scene
from pendu_tui.engine.stability.grid import Grid
from pendu_tui.engine.stability.outcomes import Cells, Failure, first_failure

THETAS = (0.1, 0.5, 1.0, 2.0, 3.0)  # rad, and the scene's own

LADDER = np.geomspace(1e-3, 3.2, 812)
"""The z at which failures are searched, a rung every 1 %, to beyond every linear limit."""


@dataclass(frozen=True, slots=True)
class Row:
    """One method and one amplitude."""

    method: Method
    theta: float  # rad
    failure: Failure | None  # None: holds on the whole ladder
    here: Any  # the CELL at the scene's z


def amplitude(scene: Scene) -> float | None:
    """Return how far the scene's pendulum swings [rad]; None where it spins or rests."""
    if scene.omega == 0 and 0 < abs(scene.theta) < math.pi:
        return abs(scene.theta)
    share = scene.equations.energy()((scene.theta, scene.omega)) / (2 * scene.w0_squared)
    if share >= 1:
        return None
    angle = 2 * math.asin(math.sqrt(share))
    return angle if 0 < angle < math.pi else None


def ladder_of(
    scene: Scene, thetas: Sequence[float] | None, zs: Sequence[float] | None, steps: int
) -> Grid:
    """Return a table's grid: amplitudes [rad] on a ladder of z that includes the scene's own."""
    rungs = np.union1d(LADDER if zs is None else zs, [scene.z])
    if thetas is None:
        thetas = list(THETAS)
        if own := amplitude(scene):
            others = [theta for theta in THETAS if not np.isclose(theta, own, rtol=0.01)]
            thetas = sorted([own, *others])
    return Grid(np.array(thetas), rungs, steps, scene.cast)


def map_of(
    scene: Scene, thetas: Sequence[float] | None, zs: Sequence[float] | None, steps: int
) -> Grid:
    """Return the grid of a map, by default of 100 amplitudes [rad] up to pi and 200 z up to 3.

    If a method of the cast is stable at 3, as BM4 is, z goes up to 3.5.
    """
    if not thetas:
        thetas = ((np.arange(100) + 0.5) * math.pi / 100).tolist()
    if not zs:
        stable_at_3 = any((method.linear_limit or 0) >= 3 for method in scene.cast)
        largest = 3.5 if stable_at_3 else 3.0
        zs = ((np.arange(200) + 0.5) * largest / 200).tolist()
    return Grid(np.array(thetas), np.array(zs), steps, scene.cast)


def table(scene: Scene, grid: Grid, cells: Cells) -> list[Row]:
    """Return the first failure of each method at each amplitude, from the cells of a ladder."""
    here = int(np.searchsorted(grid.z, scene.z))
    rows = []
    for (m, method), (t, theta) in product(enumerate(grid.methods), enumerate(grid.theta.tolist())):
        column = cells[:, m, t]
        rows.append(Row(method, theta, first_failure(grid.z, column), column[here]))
    return rows
