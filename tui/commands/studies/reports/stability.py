"""The report of the stability command: theory next to measurement, and the map, also as a file."""

import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rich.style import Style
from rich.text import Text

from engine.methods import Method
from engine.methods.measure import linear_limit
from engine.methods.own import OwnMethod
from engine.scenes import Scene
from engine.stability.grid import Grid
from engine.stability.linear import amplification
from engine.stability.outcomes import BAND, FATES, UNKNOWN, Cells
from engine.stability.study import Row, amplitude, early_steps, table
from tui.cli.files import whole_file
from tui.cli.output import console
from tui.cli.report import Column, Report, Table, finite
from tui.drawing.palette import PALETTES
from tui.views.stability.picture import picture

CELL_FIELDS = ("fate", "steps_survived", "max_energy_error")
LINEAR = """\
This scene is the linear oscillator itself: these limits hold at every amplitude.
Swings are lost at other steps by a pendulum only: pendu-tui stability drift"""


Computed = tuple[Grid, Cells]


def report(scene: Scene, steps: int, computed: Sequence[Computed], *, is_whole: bool) -> Report:
    """Return the report of a table's grid and a map's: neither for the linear oscillator."""
    rows: list[Row] = []
    notes: list[Any] = [LINEAR]
    if computed:
        complete = is_whole or len(computed) > 1
        rows = [row for row in table(scene, *computed[0]) if row.failure or complete]
        notes = [*_words(scene), Table(_columns(scene, steps), rows)]
    pendulum = [_row_fields(row) for row in rows]
    maps = computed[1:]
    for grid, cells in maps:
        notes += ["", *_picture(grid, cells)]
    linear = [_linear_fields(scene, method) for method in scene.cast]
    labels = {method.key: method.label for method in scene.cast}
    return Report(
        name="stability",
        title="Linear oscillator: spectral radius of one step; stable up to z = h·w0",
        columns=(
            Column("method", lambda row: labels[row["method"]]),
            Column("measured", lambda row: _limit(row["limit_z"]), right=True),
            Column("theory", lambda row: _limit(row["theory_z"]), right=True),
            Column(f"radius at z = {scene.z:.4g}", "amplification", ".9f"),
        ),
        rows=linear,
        notes=notes,
        fields={
            "scene": scene.fields(),
            "z": scene.z,
            "steps": steps,
            "band": BAND,
            "linear": [finite(row) for row in linear],
            "pendulum": [_row_fields(row) | {"at_scene": _at_scene(row)} for row in rows],
            "map": _map_fields(*maps[0]) if maps else None,
            "interrupted": not is_whole,
        },
        records=_swings(*maps[0]) if maps else pendulum,
    )


def _at_scene(row: Row) -> dict[str, Any] | None:
    return None if row.here["fate"] == UNKNOWN else _cell_fields(row.here)


def _linear_fields(scene: Scene, method: Method) -> dict[str, Any]:
    return {
        "method": method.key,
        "limit_z": linear_limit(method.phases),
        "theory_z": None if isinstance(method, OwnMethod) else method.linear_limit,
        "amplification": amplification(method, scene.z),
    }


def _limit(z: float | None) -> str | None:
    if z is None:
        return None
    if z == math.inf:
        return "any"
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
    return {
        name: np.where(known, column, nothing).tolist()
        for name, column in zip(CELL_FIELDS, columns, strict=True)
    }


def _map_fields(grid: Grid, cells: Cells) -> dict[str, Any]:
    methods = [
        {"method": method.key, **_cell_fields(cells[:, m])} for m, method in enumerate(grid.methods)
    ]
    return {"z": grid.z.tolist(), "theta": grid.theta.tolist(), "methods": methods}


def _swings(grid: Grid, cells: Cells) -> Iterator[dict[str, Any]]:
    """Yield a record for each swing that was computed."""
    for m, z, t in np.ndindex(len(grid.methods), len(grid.z), len(grid.theta)):
        cell = cells[z, m, t]
        if cell["fate"] != UNKNOWN:
            place = {
                "method": grid.methods[m].key,
                "z": float(grid.z[z]),
                "theta": float(grid.theta[t]),
            }
            steps, error, fate = cell.item()
            yield place | dict(zip(CELL_FIELDS, (FATES[fate], steps, error), strict=True))


def _words(scene: Scene) -> Iterator[str]:
    """Yield what is to be known of the pendulum's table."""
    yield "\nPendulum: the z from which a swing is lost in so many steps; with more steps, it is lower."
    yield (
        "Lost: it goes over the top, or is chaotic and 10 % wider than on the linear oscillator; "
        "without a symplectic method also if its energy leaves the linear oscillator's band by "
        f"{100 * BAND:.0f} %."
    )
    yield f"Margin = limit / z; the scene has z = {scene.z:.4g}. Below 1, it is beyond the limit."
    swing = amplitude(scene)
    if swing is not None and not math.isclose(swing, scene.theta):
        speed = f" with {scene.omega:g} rad/s" if scene.omega else ""
        start = f"{math.degrees(scene.theta):.4g} deg{speed}"
        degrees = f"{math.degrees(swing):.4g} deg"
        yield f"The start at {start} swings as far as one from rest at {degrees}."


def _columns(scene: Scene, steps: int) -> list[Column]:
    def of_failure(head: str, write: Callable[[Any], str]) -> Column:
        return Column(head, lambda row: row.failure and write(row.failure), right=head != "failure")

    return [
        Column("method", lambda row: row.method.label),
        Column("from", lambda row: f"{math.degrees(row.theta):.4g}°", right=True),
        Column(
            f"in {early_steps(steps):,}", lambda row: row.early and f"{row.early.z:.4g}", right=True
        ),
        of_failure(f"in {steps:,}", lambda failure: f"{failure.z:.4g}"),
        of_failure("h [s]", lambda failure: f"{failure.z / scene.w0:.3g}"),
        of_failure("failure", lambda failure: failure.reason),
        of_failure("margin", lambda failure: f"{failure.z / scene.z:.3g}"),
    ]


def _picture(grid: Grid, cells: Cells) -> list[Text]:
    """Return the lines of the map, in colour where the terminal has colours."""
    on = console()
    plain = on.color_system is None or on.no_color or "utf" not in on.encoding
    drawn = picture(grid, cells, max(40, on.width), None if plain else PALETTES["dark"])
    return [
        Text.assemble(*((text, ink if isinstance(ink, Style) else "") for text, ink in row))
        for row in drawn.rows
    ]


def write_map(path: Path, force: bool, grid: Grid, cells: Cells) -> None:
    """Write a map to a file for numpy.load.

    Arrays `z`, `theta` [rad], `methods`, `steps`, `fates`, and `cells`, of axes (z, methods, theta)
    and fields steps (survived), error (the largest relative energy error) and fate (an index into
    `fates`, or 255: unknown).
    """
    keys = [method.key for method in grid.methods]
    with whole_file(path, force) as part, part.open("wb") as file:
        np.savez_compressed(
            file,
            z=grid.z,
            theta=grid.theta,
            methods=keys,
            steps=grid.steps,
            fates=FATES,
            cells=cells,
        )
    print(f"{path}: {len(grid.z)} z, {len(grid.methods)} methods, {len(grid.theta)} amplitudes.")
