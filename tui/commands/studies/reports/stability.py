"""What the stability command prints: theory next to measurement, as tables, picture, JSON, CSV, and as a file."""

import math
import sys
import zipfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from rich.text import Text

from engine.methods import Method
from engine.methods.measure import linear_limit
from engine.methods.own import OwnMethod
from engine.scenes import Scene
from engine.stability.grid import Grid
from engine.stability.linear import amplification
from engine.stability.outcomes import BAND, CELL, CHAOTIC, FATES, UNKNOWN, Cells, is_lost
from engine.stability.study import Row, StabilityStudy, amplitude
from tui.cli.errors import Exit
from tui.cli.files import whole_file
from tui.cli.output import console, print_lines, print_picture, warn, write_csv, write_json
from tui.cli.report import print_table
from tui.drawing.palette import PALETTES
from tui.views.stability.picture import picture
from tui.views.stability.words import said

ROW_FIELDS = ("method", "theta", "first_failure_z", "reason", "steps_survived", "first_failure_z_early")
CELL_FIELDS = ("fate", "steps_survived", "max_energy_error")


def print_text(study: StabilityStudy, with_map: bool) -> int:
    """Print the tables and, if asked for, the map, in colour where the terminal has colours."""
    _print_linear(study.scene)
    if _is_linear(study.scene):
        print("\nThis scene is the linear oscillator itself: these limits hold at every amplitude.")
        print("Swings are lost at other steps by a pendulum only: pendu-tui stability --scene drift")
        return Exit.FINE
    rows, whole = study.table()
    _print_pendulum(rows, study)
    if not with_map or not whole:
        return _ended(whole)
    grid, cells, done = study.map()
    print()
    on = console()
    plain = on.color_system is None or on.no_color or "utf" not in on.encoding
    lines = picture(grid, cells, max(40, on.width), None if plain else PALETTES["dark"])
    print_picture(on, (Text.assemble(*((text, style or "") for text, style, _ in line)) for line in lines))
    return _map_ended(done, grid)


def print_json(study: StabilityStudy, with_map: bool) -> int:
    """Print one object: linear, pendulum and, if asked for, map."""
    scene = study.scene
    rows, whole = ([], True) if _is_linear(scene) else study.table()
    fields = {
        "scene": scene.fields(),
        "z": scene.z,
        "steps": study.steps,
        "band": BAND,
        "linear": [
            {
                "method": method.key,
                **dict(zip(("limit_z", "theory_z"), _limits(method), strict=True)),
                "amplification": amplification(method, scene.z),
            }
            for method in scene.cast
        ],
        "pendulum": [
            dict(zip(ROW_FIELDS, _row(row), strict=True))
            | {"at_scene": None if row.here["fate"] == UNKNOWN else _columns(row.here)}
            for row in rows
        ],
    }
    if not with_map or not whole:
        write_json("stability", {**fields, "map": None, "interrupted": not whole})
        return _ended(whole)
    grid, cells, done = study.map()
    map_ = {
        "z": grid.z.tolist(),
        "theta": grid.theta.tolist(),
        "methods": [{"method": method.key, **_columns(cells[:, m])} for m, method in enumerate(grid.methods)],
    }
    write_json("stability", {**fields, "map": map_, "interrupted": done < len(grid.z)})
    return _map_ended(done, grid)


def print_csv(study: StabilityStudy, with_map: bool) -> int:
    """Print a line for every amplitude or, if the map is asked for, for every swing that was computed."""
    if not with_map:
        rows, whole = study.table()
        write_csv(sys.stdout, ROW_FIELDS, map(_row, rows))
        return _ended(whole)
    grid, cells, done = study.map()
    swings = (
        (method.key, z, theta, FATES[fate], steps, error)
        for m, method in enumerate(grid.methods)
        for z, row in zip(grid.z[:done].tolist(), cells[:done, m].tolist(), strict=True)
        for theta, (steps, error, fate) in zip(grid.theta.tolist(), row, strict=True)
    )
    write_csv(sys.stdout, ("method", "z", "theta", *CELL_FIELDS), swings)
    return _map_ended(done, grid)


def write_file(study: StabilityStudy, path: Path, force: bool) -> int:
    """Write the map for numpy.load, strip by strip, however large it is.

    Arrays `z`, `theta` [rad], `methods`, `steps`, `fates`, and `cells`, of axes (z, methods, theta) and fields
    steps (survived), error (the largest relative energy error) and fate (an index into `fates`, or
    255: not computed).
    """
    grid, done = study.grid(), 0
    keys = [method.key for method in grid.methods]
    arrays = {"z": grid.z, "theta": grid.theta, "methods": keys, "steps": grid.steps, "fates": FATES}
    with whole_file(path, force) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w") as file:
                npy.write_array(file, np.asarray(array), allow_pickle=False)
        with archive.open("cells.npy", "w", force_zip64=True) as file:
            header = {"descr": npy.dtype_to_descr(CELL), "fortran_order": False, "shape": grid.shape}
            npy.write_array_header_1_0(file, header)
            for cells in study.computed(grid):
                file.write(cells.tobytes())
                done += len(cells)
            for at in range(done, len(grid.z)):
                file.write(replace(grid, z=grid.z[at : at + 1]).unknown().tobytes())
        if not done:
            raise KeyboardInterrupt
    z, methods, theta = grid.shape
    print(f"{path}: {z} z, {methods} methods, {theta} amplitudes; open it with numpy.load.")
    return _map_ended(done, grid)


def _map_ended(done: int, grid: Grid) -> int:
    return _ended(done == len(grid.z), f"{done} of the map's {len(grid.z)} z were computed and are kept")


def _ended(whole: bool, kept: str = "swings already found lost are kept") -> int:
    if whole:
        return Exit.FINE
    warn(f"interrupted; {kept}.")
    return Exit.INTERRUPTED


def _is_linear(scene: Scene) -> bool:
    """Whether there is nothing but linear theory to say: no top to go over, no chaos, no amplitude that matters."""
    return scene.model == "linear"


def _limits(method: Method) -> tuple[float | None, float | None]:
    """The largest stable z as measured, and in theory; a user's own method has no theory."""
    return linear_limit(method.phases), None if isinstance(method, OwnMethod) else method.linear_limit


def _print_linear(scene: Scene) -> None:
    def limit(z: float | None) -> str:
        return "-" if z is None else f"{z:.9f}" if z else "none"

    z = scene.z
    print("Linear oscillator: spectral radius of one step; stable up to z = h·w0")
    print_table(
        "lrrr",
        ("method", "stable to z, measured", "theory", f"spectral radius at z = {z:.4g}"),
        ((m.label, *map(limit, _limits(m)), f"{amplification(m, z):.9f}") for m in scene.cast),
    )


def _print_pendulum(rows: Sequence[Row], study: StabilityStudy) -> None:
    """Print where swings are lost, and how far from there the scene is."""
    scene, early, all_ = study.scene, f"{study.early:,}", f"{study.steps:,}"
    print_lines(
        "",
        f"Pendulum: a swing counts as lost if within {all_} steps it goes over the top or becomes chaotic;",
        f"without a symplectic method also if its energy leaves the linear oscillator's band by {100 * BAND:.0f} %.",
        f"A limit holds for so many steps and moves down with more: compare that within {early}, or use --steps.",
        f"Margin: the limit over the scene's z, {scene.z:.4g}; below 1 a swing of that amplitude is past its limit.",
    )
    swing = amplitude(scene)
    if swing is not None and not math.isclose(swing, scene.theta):
        speed, far = f" with {scene.omega:g} rad/s" if scene.omega else "", f"{math.degrees(swing):.4g} deg"
        start = f"{math.degrees(scene.theta):.4g} deg{speed}"
        print_lines(f"The start at {start} swings as far as one from rest at {far}: its amplitude.")
    heads = "method", "amplitude", f"lost from z, {early} steps", f"{all_} steps", "h [s]", "failure", "at step"
    print_table("lrrrrlrlr", (*heads, f"at z = {scene.z:.4g}", "margin"), (_cells(row, scene) for row in rows))


def _cells(row: Row, scene: Scene) -> tuple[str, ...]:
    found, fate = row.failure, int(row.here["fate"])
    here = "-" if fate == UNKNOWN else said(row.here)
    if is_lost(row.here) and fate != CHAOTIC:
        here = f"lost at step {row.here['steps'] + 1}"
    where, margin = ("-",) * 4, "-"
    if found:
        step = "-" if found.reason == FATES[CHAOTIC] else str(found.steps + 1)
        where = (f"{found.z:.4g}", f"{found.z / scene.w0:.3g}", found.reason, step)
        margin = f"{found.z / scene.z:.3g}"
    early = f"{row.early.z:.4g}" if row.early else "-"
    return (row.method.label, f"{math.degrees(row.theta):.4g} deg", early, *where, here, margin)


def _row(row: Row) -> tuple[Any, ...]:
    found, early = row.failure, row.early and row.early.z
    return (row.method.key, row.theta, *((found.z, found.reason, found.steps) if found else (None,) * 3), early)


def _columns(cells: Cells) -> dict[str, Any]:
    """CELL_FIELDS of cells, each in the shape of the cells, and None where not computed."""
    known = cells["fate"] != UNKNOWN
    fates = np.array(FATES, object)[np.where(known, cells["fate"], 0)]
    columns = zip(CELL_FIELDS, (fates, cells["steps"], cells["error"]), strict=True)
    return {name: np.where(known, column, np.array(None)).tolist() for name, column in columns}
