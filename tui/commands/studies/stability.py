"""The stability command's limits, its map, and the portrait that --section draws."""

import math
import os
from argparse import Namespace
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
from rich.text import Text

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.measure import linear_limit
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.methods.verlet import VELOCITY_VERLET
from pendu_tui.engine.models.model import State
from pendu_tui.engine.phase_space.section import (
    OrbitKind,
    Points,
    batches,
    iterate,
    kind_of,
    least_lyapunov,
    orbit,
)
from pendu_tui.engine.scenes import Z_LIMITS, Scene
from pendu_tui.engine.stability import BAND, LOST
from pendu_tui.engine.stability.grid import Grid
from pendu_tui.engine.stability.linear import amplification
from pendu_tui.engine.stability.outcomes import FATES, UNKNOWN, Cells
from pendu_tui.engine.stability.study import Row, amplitude, early_steps, ladder_of, map_of, table
from pendu_tui.tui.cli.errors import UserError, explained
from pendu_tui.tui.cli.files import whole_file
from pendu_tui.tui.cli.report import (
    Column,
    Report,
    Table,
    console,
    finite,
    method_column,
    progress,
    publish,
    scene_line,
)
from pendu_tui.tui.cli.workers import workers_of
from pendu_tui.tui.commands.studies.figures import draw_section, lines_of
from pendu_tui.tui.drawing.palette import PALETTES, ink_of
from pendu_tui.tui.terminal.options import fitting_theme
from pendu_tui.tui.views.phase.picture import Section, starts
from pendu_tui.tui.views.phase.viewport import Viewport
from pendu_tui.tui.views.stability.picture import picture
from pendu_tui.tui.words.orbit import HEADS, fraction, sentence
from pendu_tui.tui.words.orbit import cells as orbit_cells

MAX_POINTS = 10**8  # of a section: 1.6 GB in memory
MAX_SWINGS = 20_000_000  # of a grid: 320 MB in memory
LINEAR = """\
This scene is the linear oscillator itself, and these limits hold at every amplitude.
A pendulum's depend on the amplitude: pendu-tui stability drift"""

Computed = tuple[Grid, Cells]


def grids_of(scene: Scene, options: Namespace, is_map: bool) -> list[Grid]:
    """Return the grids of the table and the map, as far as the options ask for them.

    Raises UserError for options that do not suit the scene or are out of range.
    """
    lists = options.theta_values or options.z_values
    if not scene.equations.turns and (options.map or options.csv or options.output or lists):
        raise UserError(
            "limits of the linear oscillator hold at every amplitude; leave out --map, --csv, -o, "
            "--theta-values and --z-values."
        )
    _check("amplitude", options.theta_values or (), (0, math.pi))
    _check("z", options.z_values or (), Z_LIMITS)
    _check("number of steps", [options.steps], (0, 2**31))
    grids = []
    if scene.equations.turns and not is_map:
        grids.append(ladder_of(scene, options.theta_values, options.z_values, options.steps))
    if options.map or is_map:
        grids.append(map_of(scene, options.theta_values, options.z_values, options.steps))
    swings = max((math.prod(grid.shape) for grid in grids), default=0)
    if swings > MAX_SWINGS:
        raise UserError(f"{swings} swings are too many; use at most {MAX_SWINGS}.")
    return grids


def _check(what: str, numbers: Sequence[float], limits: tuple[float, float]) -> None:
    low, high = limits
    for value in numbers:
        if not low < value < high:  # also refuses nan
            raise UserError(
                f"{what} {value:g} is out of range; it must lie between {low:g} and {high:g}."
            )


def compute(grids: Sequence[Grid], options: Namespace) -> tuple[list[Computed], UserError | None]:
    """Return the grids with their cells, and what interrupted the last of them, if anything.

    Raises the interruption if none of its cells were computed.
    """
    computed = []
    with workers_of(options) as workers:
        for grid in grids:
            cells = grid.unknown()
            computed.append((grid, cells))
            done = 0
            try:
                with progress("stability") as show:
                    for strip in workers.map(Grid.cells, grid.strips()):
                        cells[done : done + len(strip)] = strip
                        done += len(strip)
                        show(done, len(grid.z))
            except (KeyboardInterrupt, UserError) as error:
                if not done:
                    raise
                ended = explained(error)
                kept = f"{done} of {len(grid.z)} z are computed and kept"
                return computed, UserError(f"{str(ended).rstrip('.')}; {kept}.", ended.code)
    return computed, None


def report(scene: Scene, steps: int, computed: Sequence[Computed], *, is_whole: bool) -> Report:
    """Return the report on the grids of the table and the map, if there are any."""
    linear = [_linear(scene, method) for method in scene.cast]
    notes: list[Any] = [LINEAR]
    rows: list[Row] = []
    if computed:
        rows = table(scene, *computed[0])
    if not is_whole and len(computed) == 1:  # the others may fail at a z not yet computed
        rows = [row for row in rows if row.failure]
    pendulum = [_row_fields(row) for row in rows]
    records: Iterable[dict[str, Any]] = pendulum
    if computed:
        notes = [*_words(scene), Table(_columns(scene, steps), pendulum)]
    drawn = None
    for grid, cells in computed[1:]:
        notes += ["", *_picture(grid, cells)]
        records = _swings(grid, cells)
        drawn = _map_fields(grid, cells)
    return Report(
        name="stability",
        title="Linear oscillator: spectral radius of one step; stable up to z = h·w0",
        columns=(
            method_column(scene.cast),
            Column("measured", "limit_z", _limit),
            Column("theory", "theory_z", _limit),
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
            "pendulum": [_row_fields(row) | {"at_scene": _cell(row.here)} for row in rows],
            "map": drawn,
            "interrupted": not is_whole,
        },
        records=records,
    )


def _picture(grid: Grid, cells: Cells) -> list[Any]:
    on = console()
    palette = None
    if on.color_system is not None and not on.no_color and "utf" in on.encoding:
        palette = PALETTES["dark"]
    return lines_of(picture(grid, cells, max(40, on.width), palette), None)


def _linear(scene: Scene, method: Method) -> dict[str, Any]:
    theory = method.linear_limit
    if isinstance(method, OwnMethod):
        theory = None
    fields = {"method": method.key, "limit_z": linear_limit(method.phases), "theory_z": theory}
    return fields | {"amplification": amplification(method, scene.z)}


def _limit(z: float) -> str:
    return {math.inf: "any", 0.0: "none"}.get(z) or f"{z:.9f}"


def _row_fields(row: Row) -> dict[str, Any]:
    failure = row.failure
    return {
        "method": row.method.key,
        "theta": row.theta,
        "first_failure_z": failure and failure.z,
        "reason": failure and failure.reason,
        "steps_survived": failure and failure.steps,
        "first_failure_z_early": row.early and row.early.z,
    }


def _cell(cell: Any) -> dict[str, Any] | None:
    return None if cell["fate"] == UNKNOWN else _cell_fields(cell)


def _cell_fields(cells: Any) -> dict[str, Any]:
    """Return the fields of cells as lists of their shape, with None for unknown cells."""
    known = cells["fate"] != UNKNOWN
    fates = np.array(FATES, object)[np.where(known, cells["fate"], 0)]

    def listed(values: Any) -> Any:
        return np.where(known, values, np.array(None)).tolist()

    return {
        "fate": listed(fates),
        "steps_survived": listed(cells["steps"]),
        "max_energy_error": listed(cells["error"]),
    }


def _map_fields(grid: Grid, cells: Cells) -> dict[str, Any]:
    methods = [
        {"method": method.key, **_cell_fields(cells[:, index])}
        for index, method in enumerate(grid.methods)
    ]
    return {"z": grid.z.tolist(), "theta": grid.theta.tolist(), "methods": methods}


def _swings(grid: Grid, cells: Cells) -> Iterator[dict[str, Any]]:
    for m, z, t in np.ndindex(len(grid.methods), len(grid.z), len(grid.theta)):
        cell = cells[z, m, t]
        if cell["fate"] != UNKNOWN:
            place = {"z": float(grid.z[z]), "theta": float(grid.theta[t])}
            yield {"method": grid.methods[m].key, **place, **_cell_fields(cell)}


def _words(scene: Scene) -> Iterator[str]:
    yield "\nPendulum: the z from which a swing is lost within so many steps; more steps lower it."
    yield LOST.replace("\n", " ")
    yield f"Margin = limit / z; the scene has z = {scene.z:.4g}. Below 1, z is beyond the limit."
    swing = amplitude(scene)
    if swing is None:
        yield "The scene's own start does not swing, so it has no row."
    elif not math.isclose(swing, scene.theta):
        start = f"{math.degrees(scene.theta):.4g} deg"
        if scene.omega:
            start += f" with {scene.omega:g} rad/s"
        degrees = f"{math.degrees(swing):.4g} deg"
        yield f"The start at {start} swings as far as one from rest at {degrees}."


def _columns(scene: Scene, steps: int) -> list[Column]:
    return [
        method_column(scene.cast),
        Column("from", "theta", lambda theta: f"{math.degrees(theta):.4g}°"),
        Column(f"in {early_steps(steps):,}", "first_failure_z_early", ".4g"),
        Column(f"in {steps:,}", "first_failure_z", ".4g"),
        Column("h [s]", "first_failure_z", lambda z: f"{z / scene.w0:.3g}"),
        Column("failure", "reason"),
        Column("margin", "first_failure_z", lambda z: f"{z / scene.z:.3g}"),
    ]


def write_map(options: Namespace, grid: Grid, cells: Cells) -> None:
    """Write a map for numpy.load: arrays z, theta [rad], methods, steps, fates and cells.

    Cells have the axes (z, methods, theta) and the fields steps (survived), error (the largest
    relative energy error) and fate (an index into fates, or 255 if unknown).
    """
    keys = [method.key for method in grid.methods]
    arrays: Any = {"z": grid.z, "theta": grid.theta, "methods": keys}
    arrays |= {"steps": grid.steps, "fates": FATES, "cells": cells}
    with whole_file(options.output, options.force) as part, part.open("wb") as file:
        np.savez_compressed(file, **arrays)
    shape = f"{len(grid.z)} z, {len(grid.methods)} methods, {len(grid.theta)} amplitudes"
    print(f"{options.output}: {shape}.")


def show_section(scene: Scene, options: Namespace, is_figure: bool) -> None:
    """Draw the portrait of the first method, and describe the start's orbit under each method."""
    if options.starts * options.steps > MAX_POINTS:
        raise UserError(f"--starts times --steps is too large; use at most {MAX_POINTS:g} points.")
    method = scene.cast[0]
    if options.methods is None and VELOCITY_VERLET in scene.cast:
        method = VELOCITY_VERLET
    title = f"{method.label}, h {scene.h:g} s (z = {scene.z:.4g}): its own phase portrait"
    if is_figure:
        viewport = Viewport.portrait(120, 36, scene)
        edges = (math.pi, viewport.omega_at(0.0))
        draw_section(options, title, _orbits(scene, method, options, viewport), edges)
        print(f"{options.output}: {title}")
        return
    lines: list[Text] = []
    if options.output is None and not options.json:
        lines = _portrait(scene, method, options)
    publish(_section(scene, method, title, options.steps, lines), options)


def _orbits(scene: Scene, method: Method, options: Namespace, viewport: Viewport) -> list[Points]:
    orbits: list[Points] = []
    iterated = partial(iterate, method, scene.equations, scene.h, steps=options.steps)
    done = 0
    with workers_of(options) as workers, progress("section") as show:
        for batch in workers.map(iterated, batches(starts(viewport, options.starts))):
            orbits.append(batch)
            done += batch[0].shape[1]
            show(done, options.starts)
    return orbits


def _portrait(scene: Scene, method: Method, options: Namespace) -> list[Text]:
    """Return the lines of a method's portrait, as wide as the terminal and in its colours."""
    model = scene.equations
    start = State(scene.theta, scene.omega)
    width = max(console().width, 40)
    viewport = Viewport.portrait(width, width * 5 // 16, scene)
    section = Section(viewport, model, method, ink_of(method, scene.cast))
    for points in _orbits(scene, method, options, viewport):
        section.add(points)
    drawn = section.picture(orbit(method, model, scene.h, start, options.steps), start)
    return lines_of(drawn, PALETTES[fitting_theme(os.environ)])


def _section(scene: Scene, method: Method, title: str, steps: int, picture: list[Text]) -> Report:
    model = scene.equations
    start = State(scene.theta, scene.omega)
    kinds = {
        member: kind_of(member, model, scene.h, orbit(member, model, scene.h, start, steps))
        for member in scene.cast
    }
    columns = [Column(head, at, right=at > 1) for at, head in enumerate(("method", *HEADS))]
    rows = [(member.label, *orbit_cells(member, kind)) for member, kind in kinds.items()]
    return Report(
        name="section",
        title=title,
        notes=[
            *picture,
            f"\n{scene_line(scene, 'h', 'z')}, {steps} steps",
            Table(columns, rows),
            f"{steps} steps cannot tell a Lyapunov number below about {least_lyapunov(steps):.2g} "
            "from 0.",
            f"\n{method.label}: {sentence(method, kinds[method])}",
        ],
        fields={
            "scene": scene.fields(),
            "z": scene.z,
            "steps": steps,
            "orbits": [_orbit_fields(member, kind) for member, kind in kinds.items()],
        },
    )


def _orbit_fields(method: Method, kind: OrbitKind) -> dict[str, Any]:
    fields = {
        "method": method.key,
        "rotation": kind.rotation,
        "fraction": kind.fraction and fraction(kind),
        "island": kind.island,
        "lyapunov": kind.lyapunov,
        "chaotic": kind.chaotic,
        "over_the_top": kind.spins,
        "energy_error": kind.energy_error,
        "steps": kind.steps,
        "text": sentence(method, kind),
    }
    return finite(fields)
