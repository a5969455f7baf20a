"""The report of the stability command: theory next to measurement, and the map, also as a file."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.text import Text

from engine.methods import Method
from engine.methods.measure import linear_limit
from engine.methods.own import OwnMethod
from engine.scenes import Scene
from engine.stability.grid import Grid
from engine.stability.linear import amplification
from engine.stability.outcomes import BAND, CHAOTIC, FATES, UNKNOWN, Cells, is_lost
from engine.stability.study import Row, amplitude, early_steps, table
from tui.cli.files import whole_file
from tui.cli.output import console
from tui.cli.report import Column, Report, Table
from tui.drawing.palette import PALETTES
from tui.views.stability.picture import picture
from tui.views.stability.words import said

CELL_FIELDS = ("fate", "steps_survived", "max_energy_error")
LINEAR = """\
This scene is the linear oscillator itself: these limits hold at every amplitude.
Swings are lost at other steps by a pendulum only: pendu-tui stability drift"""


@dataclass(slots=True)
class Studied:
    """The grids of a table and of a map that were computed, with their cells."""

    scene: Scene
    steps: int
    ladder: Grid | None = None
    cells: Cells | None = None
    grid: Grid | None = None
    map: Cells | None = None
    interrupted: bool = False

    def rows(self) -> list[Row]:
        """Return the rows of the table; of cells that are not all known, those with a failure."""
        if self.ladder is None or self.cells is None:
            return []
        whole = bool((self.cells["fate"] != UNKNOWN).all())
        return [row for row in table(self.scene, self.ladder, self.cells) if whole or row.failure]


def report(studied: Studied) -> Report:
    """Return the report of what was computed."""
    scene = studied.scene
    linear = [_linear_fields(scene, method) for method in scene.cast]
    rows = studied.rows()
    pendulum = [_row_fields(row) for row in rows]
    map_fields = None
    notes: list[Any] = [LINEAR] if studied.ladder is None else _words(studied)
    if studied.ladder is not None:
        notes.append(Table(_columns(studied), rows))
    if studied.grid is not None and studied.map is not None:
        map_fields = _map_fields(studied.grid, studied.map)
        notes += ["", *_picture(studied.grid, studied.map)]
    return Report(
        name="stability",
        title="Linear oscillator: spectral radius of one step; stable up to z = h·w0",
        columns=(
            Column("method", "label"),
            Column("stable to z, measured", lambda row: _limit(row["limit_z"]), right=True),
            Column("theory", lambda row: _limit(row["theory_z"]), right=True),
            Column(f"spectral radius at z = {scene.z:.4g}", "amplification", ".9f"),
        ),
        rows=linear,
        notes=notes,
        fields={
            "scene": scene.fields(),
            "z": scene.z,
            "steps": studied.steps,
            "band": BAND,
            "linear": [{key: value for key, value in row.items() if key != "label"} for row in linear],
            "pendulum": [
                row | {"at_scene": None if here["fate"] == UNKNOWN else _cell_fields(here)}
                for row, here in zip(pendulum, (row.here for row in rows), strict=True)
            ],
            "map": map_fields,
            "interrupted": studied.interrupted,
        },
        records=pendulum if studied.map is None else _swings(studied),
    )


def _linear_fields(scene: Scene, method: Method) -> dict[str, Any]:
    return {
        "method": method.key,
        "label": method.label,
        "limit_z": linear_limit(method.phases),
        "theory_z": None if isinstance(method, OwnMethod) else method.linear_limit,
        "amplification": amplification(method, scene.z),
    }


def _limit(z: float | None) -> str | None:
    if z is None:
        return None
    return f"{z:.9f}" if z else "none"


def _row_fields(row: Row) -> dict[str, Any]:
    found = row.failure
    return {
        "method": row.method.key,
        "theta": row.theta,
        "first_failure_z": found.z if found else None,
        "reason": found.reason if found else None,
        "steps_survived": found.steps if found else None,
        "first_failure_z_early": row.early.z if row.early else None,
    }


def _cell_fields(cells: Any) -> dict[str, Any]:
    """Return CELL_FIELDS of cells, each in their shape, and None where they are unknown."""
    known = cells["fate"] != UNKNOWN
    fates = np.array(FATES, object)[np.where(known, cells["fate"], 0)]
    columns = (fates, cells["steps"], cells["error"])
    nothing = np.array(None)
    return {name: np.where(known, column, nothing).tolist() for name, column in zip(CELL_FIELDS, columns, strict=True)}


def _map_fields(grid: Grid, cells: Cells) -> dict[str, Any]:
    methods = [{"method": method.key, **_cell_fields(cells[:, m])} for m, method in enumerate(grid.methods)]
    return {"z": grid.z.tolist(), "theta": grid.theta.tolist(), "methods": methods}


def _swings(studied: Studied) -> Iterator[dict[str, Any]]:
    """Yield a record for each swing of the map that was computed."""
    grid, cells = studied.grid, studied.map
    assert grid is not None
    assert cells is not None
    theta = grid.theta.tolist()
    for m, method in enumerate(grid.methods):
        for z, row in zip(grid.z.tolist(), cells[:, m].tolist(), strict=True):
            for at, (steps, error, fate) in zip(theta, row, strict=True):
                if fate != UNKNOWN:
                    outcome = dict(zip(CELL_FIELDS, (FATES[fate], steps, error), strict=True))
                    yield {"method": method.key, "z": z, "theta": at, **outcome}


def _words(studied: Studied) -> list[str]:
    """Return what is to be known of the pendulum's table."""
    scene, steps = studied.scene, studied.steps
    lines = [
        "",
        f"Pendulum: a swing is lost if within {steps:,} steps it goes over the top or becomes chaotic. A method that",
        f"is not symplectic also fails if its energy leaves the linear oscillator's band by {100 * BAND:.0f} %.",
        "A limit moves down with more steps: compare the two columns, or use --steps.",
        f"Margin = limit / z, of the scene's z = {scene.z:.4g}. Below 1, the scene is beyond the limit.",
    ]
    swing = amplitude(scene)
    if swing is not None and not math.isclose(swing, scene.theta):
        speed = f" with {scene.omega:g} rad/s" if scene.omega else ""
        start = f"{math.degrees(scene.theta):.4g} deg{speed}"
        lines.append(f"The start at {start} swings as far as one from rest at {math.degrees(swing):.4g} deg.")
    return lines


def _columns(studied: Studied) -> list[Column]:
    scene, steps = studied.scene, studied.steps

    def of_failure(head: str, write: Callable[[Any], str]) -> Column:
        return Column(head, lambda row: write(row.failure) if row.failure else None, right=head != "failure")

    return [
        Column("method", lambda row: row.method.label),
        Column("amplitude", lambda row: f"{math.degrees(row.theta):.4g} deg", right=True),
        Column(
            f"lost from z, {early_steps(steps):,} steps", lambda row: row.early and f"{row.early.z:.4g}", right=True
        ),
        of_failure(f"{steps:,} steps", lambda failure: f"{failure.z:.4g}"),
        of_failure("h [s]", lambda failure: f"{failure.z / scene.w0:.3g}"),
        of_failure("failure", lambda failure: str(failure.reason)),
        of_failure("at step", lambda failure: "-" if failure.reason == FATES[CHAOTIC] else str(failure.steps + 1)),
        Column(f"at z = {scene.z:.4g}", lambda row: _here(row.here)),
        of_failure("margin", lambda failure: f"{failure.z / scene.z:.3g}"),
    ]


def _here(cell: Any) -> str | None:
    if cell["fate"] == UNKNOWN:
        return None
    if is_lost(cell) and cell["fate"] != CHAOTIC:
        return f"lost at step {cell['steps'] + 1}"
    return said(cell)


def _picture(grid: Grid, cells: Cells) -> list[Text]:
    """Return the lines of the map, in colour where the terminal has colours."""
    on = console()
    plain = on.color_system is None or on.no_color or "utf" not in on.encoding
    lines = picture(grid, cells, max(40, on.width), None if plain else PALETTES["dark"])
    return [Text.assemble(*((text, style or "") for text, style, _ in line)) for line in lines]


@contextmanager
def map_file(path: Path, force: bool) -> Iterator[Callable[[Grid, Cells], None]]:
    """Yield a function that writes a map to a file for numpy.load.

    Arrays `z`, `theta` [rad], `methods`, `steps`, `fates`, and `cells`, of axes (z, methods, theta) and fields
    steps (survived), error (the largest relative energy error) and fate (an index into `fates`, or 255: unknown).
    """
    with whole_file(path, force) as part:

        def write(grid: Grid, cells: Cells) -> None:
            keys = [method.key for method in grid.methods]
            with part.open("wb") as file:
                np.savez_compressed(
                    file, z=grid.z, theta=grid.theta, methods=keys, steps=grid.steps, fates=FATES, cells=cells
                )
            z, methods, theta = grid.shape
            print(f"{path}: {z} z, {methods} methods, {theta} amplitudes; open it with numpy.load.")

        yield write
