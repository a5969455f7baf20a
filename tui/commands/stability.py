"""Find the step size at which each method becomes unstable, in theory and as measured."""

import argparse
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.measure import linear_limit
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.quantities import LARGEST
from pendu_tui.engine.scenes import Scene
from pendu_tui.engine.studies import BAND, LOST
from pendu_tui.engine.studies.stability import (
    FATES,
    UNKNOWN,
    Cells,
    Grid,
    Part,
    Row,
    amplification,
    ladder_of,
    map_of,
    table,
)
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.scene import general_scene_of
from pendu_tui.tui.cli.workers import work_of
from pendu_tui.tui.commands.report import (
    Column,
    Figure,
    Line,
    Report,
    Table,
    check_output,
    finite,
    limit_text,
    method_column,
    publish,
)


def run(options: argparse.Namespace) -> int:
    scene = general_scene_of(options)
    if scene.equations.is_linear:
        raise UserError("the limits of the linear oscillator are those in pendu-tui methods.")
    form = check_output(options)
    axes = map_of if form == "csv" else ladder_of
    grid = axes(scene, options.theta_values, options.z_values, options.steps)
    cells = grid.unknown()
    parts = grid.parts()
    with work_of(options, "runs", len(parts)) as work:
        for part, computed in zip(parts, work.run(Part.cells, parts), strict=True):
            cells[part.z, part.method] = computed
            work.step()
    if form == "csv":
        publish(Report(name="map", fields={}, records=_swings(grid, cells)), options)
        return work.conclude()
    rows = table(scene, grid, cells)
    if work.ended:  # the others may fail at a z not yet computed
        rows = [row for row in rows if row.z]
    publish(report(scene, options.steps, rows, is_whole=work.ended is None), options)
    return work.conclude()


def report(scene: Scene, steps: int, rows: Sequence[Row], is_whole: bool = True) -> Report:
    """Return the report on the linear limits and, with rows, on the pendulum's."""
    linear = [_linear(scene, method) for method in scene.cast]
    pendulum = [_row_fields(row) for row in rows]
    return Report(
        name="stability",
        title="Linear oscillator: the largest stable z = h·w0, and the spectral radius of one step",
        columns=(
            method_column(scene.cast),
            Column("measured", "limit_z", limit_text),
            Column("theory", "theory_z", limit_text),
            Column(f"radius at z = {scene.z:.4g}", "amplification", ".9f"),
        ),
        rows=linear,
        notes=[*_words(scene), Table(_columns(scene, steps), pendulum)],
        fields={
            "scene": scene.fields(),
            "z": scene.z,
            "steps": steps,
            "band": BAND,
            "linear": [finite(row) for row in linear],
            "pendulum": [_row_fields(row) | {"at_scene": _cell_fields(row.here)} for row in rows],
            "interrupted": not is_whole,
        },
        figure=Figure(
            scene.cast,
            _lines(scene, rows),
            x_label="amplitude / °",
            y_label="smallest z = h ω₀ at which a swing is lost",
            log="y",
        ),
    )


def _lines(scene: Scene, rows: Sequence[Row]) -> Iterator[Line]:
    """Yield each method's letter, amplitudes [°] and limits."""
    for method in scene.cast:
        lost = [row for row in rows if row.method == method and row.z]
        yield method.letter, [math.degrees(row.theta) for row in lost], [row.z for row in lost]


def _linear(scene: Scene, method: Method) -> dict[str, Any]:
    theory = method.linear_limit
    if isinstance(method, OwnMethod):
        theory = None
    return {
        "method": method.key,
        "limit_z": linear_limit(method.phases),
        "theory_z": theory,
        "amplification": amplification(method, scene.z),
    }


def _row_fields(row: Row) -> dict[str, Any]:
    return {
        "method": row.method.key,
        "theta": row.theta,
        "first_failure_z": row.z,
        "reason": row.reason,
        "steps_survived": row.steps,
    }


def _cell_fields(cell: Any) -> dict[str, Any] | None:
    """Return the fields of a swing, None if it is unknown."""
    if cell["fate"] == UNKNOWN:
        return None
    return {
        "fate": FATES[cell["fate"]],
        "steps_survived": int(cell["steps"]),
        LARGEST.name: cell["error"],
    }


def _swings(grid: Grid, cells: Cells) -> Iterator[dict[str, Any]]:
    for m, z, t in np.ndindex(len(grid.methods), len(grid.z), len(grid.theta)):
        if fields := _cell_fields(cells[z, m, t]):
            place = {"z": grid.z[z], "theta": grid.theta[t]}
            yield {"method": grid.methods[m].key, **place, **fields}


def _words(scene: Scene) -> Iterator[str]:
    yield "\nPendulum: the first z tried at which a swing is lost; more steps lower it."
    yield LOST.replace("\n", " ")
    yield f"Margin = limit / z, here z = {scene.z:.4g}: below 1, the scene is beyond the limit."
    yield "The amplitudes include the scene's own, if it swings."


def _columns(scene: Scene, steps: int) -> list[Column]:
    return [
        method_column(scene.cast),
        Column("from", "theta", lambda theta: f"{math.degrees(theta):.4g}°"),
        Column(f"z, {steps:,} steps", "first_failure_z", ".4g"),
        Column("h [s]", "first_failure_z", lambda z: f"{z / scene.w0:.3g}"),
        Column("failure", "reason"),
        Column("margin", "first_failure_z", lambda z: f"{z / scene.z:.3g}"),
    ]
