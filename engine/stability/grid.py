"""The map of stability: every method at every step z and amplitude, in strips for any executor."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.methods import USUAL_CAST, Cast
from engine.run.compiled import available
from engine.stability.outcomes import CELL, UNKNOWN, Cells, Floats, outcomes

STRIP = 4096
"""Swings of a method in a strip: NumPy's calls cost little, and the arrays stay in the cache."""

COMPILED_FROM = 100_000_000
"""Steps of a method: in NumPy they take as long as importing and compiling."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """The amplitudes, steps and methods of a map.  A strip of a grid is a grid, too."""

    theta: Floats  # rad, amplitudes between 0 and pi
    z: Floats  # h·w0, above 0
    steps: int
    methods: Cast = USUAL_CAST
    fast: bool | None = None  # compiled by Numba; None: where it is installed and pays

    @property
    def shape(self) -> tuple[int, int, int]:
        """(z, methods, theta), the axes of its cells."""
        return len(self.z), len(self.methods), len(self.theta)

    def cells(self) -> Cells:
        """Return the outcome of every swing."""
        z, theta = (axis.ravel() for axis in np.meshgrid(self.z, self.theta, indexing="ij"))
        each = [
            outcomes(m, theta, z, self.steps, self.compiled).reshape(len(self.z), -1)
            for m in self.methods
        ]
        return np.stack(each, axis=1)

    @property
    def compiled(self) -> bool:
        """Whether it is computed by loops that Numba has compiled."""
        if self.fast is None:
            return len(self.theta) * len(self.z) * self.steps >= COMPILED_FROM and available()
        return self.fast

    def unknown(self) -> Cells:
        """Return cells that are not computed yet."""
        return np.full(self.shape, np.array((0, 0.0, UNKNOWN), CELL))

    def strips(self) -> list["Grid"]:
        """Return the grid cut along z.  However it is cut, the cells are the same to the last bit.

        They depend on `sin`, so on processor and libm, and on whether Numba is installed: only
        workers of one kind give the cells that are computed here.
        """
        fast = self.compiled
        width = max(1, STRIP // len(self.theta))
        return [
            replace(self, z=self.z[start : start + width], fast=fast)
            for start in range(0, len(self.z), width)
        ]


@dataclass(frozen=True, slots=True)
class Piece:
    """A part of a map that is shown while it is computed."""

    z: slice
    method: int  # index into the grid's
    cells: Cells  # (z, theta)
    steps: int
    done: float  # the part of the map with these steps that is done


def pieces(grid: Grid, passes: Sequence[int], width: int = 10) -> Iterator[Piece]:
    """Yield the map in pieces of `width` z and one method: with few steps a swing, then with more.

    In NumPy, unless the grid says otherwise: compiling would delay the first piece.
    """
    places = [
        (slice(z, z + width), m)
        for z in range(0, len(grid.z), width)
        for m in range(len(grid.methods))
    ]
    for steps in passes:
        for done, (z, m) in enumerate(places, 1):
            part = replace(
                grid,
                z=grid.z[z],
                methods=grid.methods[m : m + 1],
                steps=steps,
                fast=bool(grid.fast),
            )
            yield Piece(z, m, part.cells()[:, 0], steps, done / len(places))


def default_grid(cast: Cast = USUAL_CAST) -> Grid:
    """Return the centres of 200 steps z, beyond every limit, and of 100 amplitudes up to pi.

    z goes up to 3, or where a method of the cast is still stable there, as BM4 is, up to 3.5.
    """
    top = 3.0
    if any((method.linear_limit or 0) >= 3 for method in cast):
        top = 3.5
    return Grid(
        (np.arange(100) + 0.5) * np.pi / 100, (np.arange(200) + 0.5) * top / 200, 10_000, cast
    )
