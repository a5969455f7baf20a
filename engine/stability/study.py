"""The study behind the stability command: first failures on a ladder of z, and the map."""

import math
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from engine.methods import Method
from engine.scenes import Scene
from engine.stability.grid import Grid, default_grid
from engine.stability.outcomes import Cells, Failure, first_failure, is_lost

Show = Callable[[float, float], None]
"""(done, total)."""

THETAS = (0.1, 0.5, 1.0, 2.0, 3.0)  # rad, and the scene's own

LADDER = np.geomspace(1e-3, 3.2, 812)
"""The z that a failure is looked for at: a rung every 1 %, to beyond every method's linear limit."""


EARLY = 0.1
"""Of the steps: the limit within these shows whether it still moves with the steps."""


@dataclass(frozen=True, slots=True)
class Row:
    """One method and one amplitude."""

    method: Method
    theta: float  # rad
    failure: Failure | None  # None: holds on the whole ladder
    early: Failure | None  # the same within an EARLY share of the steps
    here: Any  # the CELL at the scene's z; its fate is UNKNOWN if Ctrl+C came before


def amplitude(scene: Scene) -> float | None:
    """How far the scene's pendulum swings [rad]; None where it spins or rests."""
    if scene.omega == 0 and 0 < abs(scene.theta) < math.pi:
        return abs(scene.theta)
    share = scene.equations.energy()((scene.theta, scene.omega)) / (2 * scene.w0_squared)
    angle = 2 * math.asin(math.sqrt(share)) if share < 1 else math.pi
    return angle if 0 < angle < math.pi else None


@dataclass(frozen=True, slots=True)
class StabilityStudy:
    """A request, with the executor that computes it and the display of its progress."""

    scene: Scene
    thetas: Sequence[float] | None = None  # rad
    zs: Sequence[float] | None = None
    steps: int = 10_000
    executor: Executor | None = None
    progress: Callable[[], AbstractContextManager[Show]] = lambda: nullcontext(lambda done, total: None)

    @property
    def early(self) -> int:
        """How many steps the EARLY limit rests on."""
        return max(1, round(EARLY * self.steps))

    def table(self) -> tuple[list[Row], bool]:
        """First failures on the ladder, to which the scene's own z is added as a rung; and whether that is all.

        Ctrl+C leaves the rows whose failure was found by then.
        """
        swing, z = amplitude(self.scene), self.scene.z
        thetas = self.thetas or sorted({*THETAS, *([swing] if swing else [])})
        grid = Grid(
            np.array(thetas), np.union1d(LADDER if self.zs is None else self.zs, [z]), self.steps, self.scene.cast
        )
        at, here = int(np.searchsorted(grid.z, z)), replace(grid, z=grid.z[:1]).unknown()[0]
        failures: dict[tuple[int, int], Failure | None] = {}
        early: dict[tuple[int, int], Failure | None] = {}
        done = 0
        try:
            for strip in self.computed(grid):
                for m, t in np.argwhere(is_lost(strip).any(axis=0)).tolist():
                    if (m, t) not in failures:
                        failures[m, t] = first_failure(grid.z[done:], strip[:, m, t])
                    early[m, t] = early.get((m, t)) or first_failure(grid.z[done:], strip[:, m, t], self.early)
                if done <= at < done + len(strip):
                    here = strip[at - done]
                done += len(strip)
        except KeyboardInterrupt:  # while a failure's reason was looked for
            pass
        whole = done == len(grid.z)
        rows = [
            Row(method, theta, failures.get((m, t)), early.get((m, t)), here[m, t])
            for m, method in enumerate(grid.methods)
            for t, theta in enumerate(thetas)
            if whole or (m, t) in failures
        ]
        return rows, whole

    def grid(self) -> Grid:
        grid = default_grid(self.scene.cast)
        theta = grid.theta if self.thetas is None else np.array(self.thetas)
        return Grid(theta, grid.z if self.zs is None else np.array(self.zs), self.steps, self.scene.cast)

    def map(self) -> tuple[Grid, Cells, int]:
        """The map, and for how many of its z it was computed before Ctrl+C."""
        grid = self.grid()
        cells, done = grid.unknown(), 0
        for strip in self.computed(grid):
            cells[done : done + len(strip)] = strip
            done += len(strip)
        return grid, cells, done

    def computed(self, grid: Grid) -> Iterator[Cells]:
        """Strip after strip, until all are done or Ctrl+C is pressed.  Raises BrokenExecutor if a worker dies."""
        strips, done = grid.compute(self.executor), 0
        with self.progress() as show:
            while done < len(grid.z):
                try:
                    strip = next(strips)
                except KeyboardInterrupt:
                    return
                done += len(strip)
                show(done, len(grid.z))
                yield strip
