"""A map of stability -> an .npz file, strip by strip, however large the map."""

import zipfile
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from engine.stability.grid import Grid
from engine.stability.outcomes import CELL, FATES, Cells


def write_map(path: Path, grid: Grid, strips: Iterable[Cells]) -> int:
    """Write a map for numpy.load and return for how many of its z there were strips.

    Arrays `z`, `theta` [rad], `methods`, `steps`, `fates`, and `cells`, of axes (z, methods, theta) and fields
    steps (survived), error (the largest relative energy error) and fate (an index into `fates`, or
    255: not computed).  Raises OSError.
    """
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        _add(archive, "z", grid.z)
        _add(archive, "theta", grid.theta)
        _add(archive, "methods", np.array([method.key for method in grid.methods]))
        _add(archive, "steps", np.array(grid.steps))
        _add(archive, "fates", np.array(FATES))
        return _add_cells(archive, grid, strips)


def _add(archive: zipfile.ZipFile, name: str, array: NDArray[np.generic]) -> None:
    with archive.open(f"{name}.npy", "w") as file:
        npy.write_array(file, array, allow_pickle=False)


def _add_cells(archive: zipfile.ZipFile, grid: Grid, strips: Iterable[Cells]) -> int:
    done = 0
    with archive.open("cells.npy", "w", force_zip64=True) as file:
        header = {"descr": npy.dtype_to_descr(CELL), "fortran_order": False, "shape": grid.shape}
        npy.write_array_header_1_0(file, header)
        for cells in strips:
            file.write(cells.tobytes())
            done += len(cells)
        for at in range(done, len(grid.z)):
            file.write(replace(grid, z=grid.z[at : at + 1]).unknown().tobytes())
    return done
