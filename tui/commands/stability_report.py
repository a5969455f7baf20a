"""What the stability command says: theory beside measurement, as tables, picture, JSON and CSV."""

import csv
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.segment import Segment, Segments

from engine.methods import METHODS
from engine.scenes import Scene
from engine.stability.grid import Grid
from engine.stability.linear import amplification, linear_limit
from engine.stability.outcomes import BAND, FATES, HOLDS, UNKNOWN, Cells
from engine.stability.study import Row, Study
from tui.cli.errors import Exit
from tui.cli.files import whole_file
from tui.cli.output import print_table, scene_fields, write_json
from tui.commands.stability_file import write_map
from tui.drawing.palette import PALETTES
from tui.views.stability.picture import picture

_CELL_FIELDS = ("fate", "steps_survived", "max_energy_error")


def print_text(study: Study, with_map: bool) -> int:
    """Print the tables and, if asked for, the map."""
    print_linear(study.scene.z)
    rows, whole = study.table()
    print_pendulum(rows, study)
    if not with_map or not whole:
        return _ended(whole)
    grid, cells, done = study.map()
    print()
    print_picture(grid, cells)
    return _map_ended(done, grid)


def write_file(study: Study, path: Path, force: bool) -> int:
    """Write the map, and nothing else, to a file."""
    with whole_file(path, force) as meanwhile:
        done = write_map(meanwhile, grid := study.grid(), study.computed(grid))
        if not done:
            raise KeyboardInterrupt
    print(
        f"{path}: {len(grid.z)} z, {len(grid.methods)} methods, {len(grid.theta)} amplitudes; open it with numpy.load."
    )
    return _map_ended(done, grid)


def print_json(study: Study, with_map: bool) -> int:
    """Print one object: linear, pendulum and, if asked for, map."""
    rows, whole = study.table()
    fields = {
        "scene": scene_fields(study.scene),
        "z": study.scene.z,
        "steps": study.steps,
        "band": BAND,
        "linear": _linear_fields(study.scene.z),
        "pendulum": [_row_fields(row) for row in rows],
    }
    if not with_map or not whole:
        write_json("stability", {**fields, "map": None, "interrupted": not whole})
        return _ended(whole)
    grid, cells, done = study.map()
    write_json("stability", {**fields, "map": _map_fields(grid, cells), "interrupted": done < len(grid.z)})
    return _map_ended(done, grid)


def print_csv(study: Study, with_map: bool) -> int:
    """Print a line for every amplitude or, if the map is asked for, for every swing that was computed."""
    writer = csv.writer(sys.stdout, lineterminator="\n")
    if not with_map:
        writer.writerow(("method", "theta", "first_failure_z", "reason", "steps_survived"))
        rows, whole = study.table()
        for row in rows:
            found = row.failure
            writer.writerow(
                (row.method.key, row.theta, *((found.z, found.reason, found.steps) if found else ("",) * 3))
            )
        return _ended(whole)
    grid, cells, done = study.map()
    writer.writerow(("method", "z", "theta", "fate", "steps_survived", "max_energy_error"))
    for m, method in enumerate(grid.methods):
        for at, z in enumerate(grid.z[:done].tolist()):
            for theta, cell in zip(grid.theta.tolist(), cells[at, m].tolist(), strict=True):
                steps, error, fate = cell
                writer.writerow((method.key, z, theta, FATES[fate], steps, error))
    return _map_ended(done, grid)


def _map_ended(done: int, grid: Grid) -> int:
    return _ended(done == len(grid.z), f"{done} of the map's {len(grid.z)} z were computed and are kept")


def _ended(whole: bool, kept: str = "the swings known by then to be lost are kept") -> int:
    if whole:
        return Exit.FINE
    print(f"pendu-tui: interrupted; {kept}.", file=sys.stderr)
    return Exit.INTERRUPTED


def print_picture(grid: Grid, cells: Cells) -> None:
    """Print the map, in colour where the terminal has colours."""
    console = Console(highlight=False)
    plain = console.color_system is None or console.no_color or "utf" not in console.encoding
    with console.capture() as drawn:
        for line in picture(grid, cells, max(40, console.width), None if plain else PALETTES["dark"]):
            console.print(Segments([*line, Segment.line()]), no_wrap=True, overflow="crop", end="")
    print(drawn.get(), end="")


def print_linear(z: float) -> None:
    """Print where the linear oscillator's limits lie."""
    print("Linear oscillator: largest multiplier of one step, from its Jacobian; stable up to z = h·w0")
    print_table(
        "lrrr",
        ("method", "stable to z, measured", "theory", f"|multiplier| at z = {z:.4g}"),
        (
            (m.label, _limit(linear_limit(m.step)), _limit(m.linear_limit), f"{amplification(m.step, z):.9f}")
            for m in METHODS
        ),
    )


def print_pendulum(table: Sequence[Row], study: Study) -> None:
    """Print where swings are lost, and how far from there the scene is."""
    scene = study.scene
    print(f"\nPendulum: a swing is lost if within {study.steps} steps it goes over the top, or its energy comes to lie")
    print(f"{100 * BAND:.0f} % outside the wobble that the method has on the linear oscillator")
    print_table(
        "lrrrlrlr",
        ("method", "amplitude", "lost from z", "h, s", "how", "at step", f"at z = {scene.z:.4g}", "cliff / z"),
        (_cells(row, scene) for row in table),
    )


def _cells(row: Row, scene: Scene) -> tuple[str, ...]:
    found, fate = row.failure, row.here["fate"]
    here = {HOLDS: "holds", UNKNOWN: "-"}.get(int(fate), f"lost at step {row.here['steps'] + 1}")
    if found is None:
        return (row.method.label, f"{math.degrees(row.theta):.4g} deg", *"----", here, "-")
    where = (f"{found.z:.4g}", f"{found.z / scene.w0:.3g}", found.reason, str(found.steps + 1))
    return (row.method.label, f"{math.degrees(row.theta):.4g} deg", *where, here, f"{found.z / scene.z:.3g}")


def _linear_fields(z: float) -> list[dict[str, Any]]:
    return [
        {
            "method": method.key,
            "limit_z": linear_limit(method.step),
            "theory_z": method.linear_limit,
            "amplification": amplification(method.step, z),
        }
        for method in METHODS
    ]


def _row_fields(row: Row) -> dict[str, Any]:
    return {
        "method": row.method.key,
        "theta": row.theta,
        "first_failure_z": row.failure and row.failure.z,
        "reason": row.failure and row.failure.reason,
        "steps_survived": row.failure and row.failure.steps,
        "at_scene": _cell_fields(row.here.item()),
    }


def _map_fields(grid: Grid, cells: Cells) -> dict[str, Any]:
    return {
        "z": grid.z.tolist(),
        "theta": grid.theta.tolist(),
        "methods": [{"method": method.key, **_columns(cells[:, m].tolist())} for m, method in enumerate(grid.methods)],
    }


def _columns(cells: list[list[tuple[int, float, int]]]) -> dict[str, list[list[Any]]]:
    """The fields of cells, apart; rows by z of values by theta, null where not computed."""
    fields = [[_cell_fields(cell) for cell in row] for row in cells]
    return {name: [[field and field[name] for field in row] for row in fields] for name in _CELL_FIELDS}


def _cell_fields(cell: tuple[int, float, int]) -> dict[str, Any] | None:
    steps, error, fate = cell
    return None if fate == UNKNOWN else dict(zip(_CELL_FIELDS, (FATES[fate], steps, error), strict=True))


def _limit(z: float) -> str:
    return f"{z:.9f}" if z else "none"
