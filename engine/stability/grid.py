"""The map of stability: every method at every step z and amplitude."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from pendu_tui.engine.methods import USUAL_CAST, Cast
from pendu_tui.engine.run.compiled import available
from pendu_tui.engine.stability.outcomes import CELL, UNKNOWN, Cells, Floats, outcomes

PART = 4096  # swings of a method: NumPy's calls cost little, and the arrays fit in the cache
COMPILED_FROM = 100_000_000  # steps of a method: they take as long as importing and compiling


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """The amplitudes, steps and methods of a map, or of a part of one."""

    theta: Floats  # rad, amplitudes between 0 and pi
    z: Floats  # h·w0, above 0
    steps: int
    methods: Cast = USUAL_CAST
    fast: bool | None = None  # compiled by Numba; None: where it is installed and pays

    @property
    def shape(self) -> tuple[int, int, int]:
        """The shape of its cells: (z, methods, theta)."""
        return len(self.z), len(self.methods), len(self.theta)

    def cells(self) -> Cells:
        """Return the outcome of every swing."""
        z, theta = (axis.ravel() for axis in np.meshgrid(self.z, self.theta, indexing="ij"))
        by_method = [
            outcomes(method, theta, z, self.steps, self.compiled).reshape(len(self.z), -1)
            for method in self.methods
        ]
        return np.stack(by_method, axis=1)

    @property
    def compiled(self) -> bool:
        """Whether Numba compiles the loops."""
        if self.fast is None:
            return len(self.theta) * len(self.z) * self.steps >= COMPILED_FROM and available()
        return self.fast

    def unknown(self) -> Cells:
        """Return cells of unknown outcome."""
        return np.full(self.shape, np.array((0, 0.0, UNKNOWN), CELL))

    def parts(self, width: int | None = None) -> list["Part"]:
        """Return the grid cut into `width` z of one method; the cells are the same to the bit.

        They depend on `sin`, that is on processor, libm and Numba, so all workers must be alike.
        """
        width = width or max(1, PART // len(self.theta))
        whole = replace(self, fast=self.compiled)
        zs = [slice(first, first + width) for first in range(0, len(self.z), width)]
        return [
            Part(z, index, replace(whole, z=self.z[z], methods=(method,)))
            for z, (index, method) in product(zs, enumerate(self.methods))
        ]


@dataclass(frozen=True, slots=True)
class Part:
    """Some z of one method of a grid."""

    z: slice
    method: int  # index
    grid: Grid  # of these alone

    def cells(self) -> Cells:
        """Return the outcomes by (z, theta)."""
        return self.grid.cells()[:, 0]


@dataclass(frozen=True, slots=True)
class Piece:
    """A computed part of a map, and the share of the map that is done with its steps."""

    part: Part
    cells: Cells
    done: float


def pieces(grid: Grid, passes: Sequence[int], width: int = 10) -> Iterator[Piece]:
    """Yield the map in pieces of `width` z and one method, with the steps of each pass.

    By default in NumPy, because compiling would delay the first piece.
    """
    for steps in passes:
        parts = replace(grid, steps=steps, fast=bool(grid.fast)).parts(width)
        for done, part in enumerate(parts, 1):
            yield Piece(part, part.cells(), done / len(parts))
