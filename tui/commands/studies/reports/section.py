"""The report of `stability --section`: a method's portrait, and the orbits of the start."""

import argparse
import math
import os
from functools import partial
from operator import itemgetter
from typing import Any

from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual.color import Color

from engine.methods import Method
from engine.methods.verlet import VELOCITY_VERLET
from engine.models.model import State
from engine.phase_space.section import (
    OrbitKind,
    Points,
    batches,
    iterate,
    kind_of,
    least_lyapunov,
    orbit,
)
from engine.scenes import Scene
from tui.cli.errors import Exit, UserError
from tui.cli.files import whole_file
from tui.cli.output import console, progress, scene_line
from tui.cli.report import Column, Report, Table, publish
from tui.cli.workers import workers_of
from tui.commands.studies.reports import figures
from tui.drawing.palette import PALETTES, ink_of
from tui.terminal.character_sets import CharacterSetFilter
from tui.terminal.options import terminal_options_of
from tui.views.phase.picture import Section, starts
from tui.views.phase.viewport import Viewport
from tui.words.orbit import HEADS, cells, fraction, sentence

MAX_STARTS = 10_000
MAX_STEPS = 100_000  # of an orbit
FILE_SIZE = (120, 36)  # columns, rows


def run(scene: Scene, options: argparse.Namespace, steps: int) -> int:
    """Draw the portrait of the first method, and describe the start's orbit under each method."""
    for name, value, limit in (("starts", options.starts, MAX_STARTS), ("steps", steps, MAX_STEPS)):
        if value > limit:
            raise UserError(f"--{name} {value} is too many; use at most {limit}.")
    method = scene.cast[0]
    if options.methods is None:
        method = next((each for each in scene.cast if each is VELOCITY_VERLET), method)
    path = options.output
    is_picture = path is not None and path.suffix.lower() != ".json"
    lines: list[Text] = []
    if is_picture and figures.is_figure(path):
        figures.check(path, options.force)
        orbits, viewport = _orbits(scene, method, options, steps, FILE_SIZE)
        edges = (math.pi, viewport.omega_at(0.0))
        figures.draw_section(path, options.force, title_of(scene, method), orbits, edges)
        print(f"{path}: {title_of(scene, method)}")
        return Exit.FINE
    if is_picture:
        with whole_file(path, options.force) as part:
            size = options.size or FILE_SIZE
            lines = [Text(title_of(scene, method)), *portrait(scene, method, options, steps, size)]
            text = "\n".join(line.plain.rstrip() for line in lines) + "\n"
            part.write_text(text, encoding="utf-8")
        print(f"{path}: {title_of(scene, method)}")
        return Exit.FINE
    if path is None and not options.json:
        width = max(console().width, 40)
        lines = portrait(scene, method, options, steps, options.size or (width, width * 5 // 16))
    publish(report(scene, method, steps, lines), options)
    return Exit.FINE


def title_of(scene: Scene, method: Method) -> str:
    return f"{method.label}, h {scene.h:g} s (z = {scene.z:.4g}): its own phase portrait"


def _orbits(
    scene: Scene, method: Method, options: argparse.Namespace, steps: int, size: tuple[int, int]
) -> tuple[list[Points], Viewport]:
    """Return orbits from all over a portrait of so many columns and rows, and the portrait."""
    viewport = Viewport.portrait(*size, scene)
    orbits: list[Points] = []
    followed = partial(iterate, method, scene.equations, scene.h, steps=steps)
    done = 0
    with workers_of(options) as workers, progress("section") as show:
        for piece in workers.map(followed, batches(starts(viewport, options.starts))):
            orbits.append(piece)
            done += piece[0].shape[1]
            show(done, options.starts)
    return orbits, viewport


def portrait(
    scene: Scene, method: Method, options: argparse.Namespace, steps: int, size: tuple[int, int]
) -> list[Text]:
    """Return the lines of a method's portrait in the options' colours and characters."""
    model = scene.equations
    start = State(scene.theta, scene.omega)
    orbits, viewport = _orbits(scene, method, options, steps, size)
    section = Section(viewport, model, method, ink_of(method, scene.cast))
    for piece in orbits:
        section.add(piece)
    display = terminal_options_of(
        options, os.environ, "utf-8" if options.output else console().encoding
    )
    palette = PALETTES["dark" if options.output and options.theme == "auto" else display.theme]
    characters = CharacterSetFilter(display.character_set)
    lines = []
    for row in section.picture(orbit(method, model, scene.h, start, steps), start).rows:
        segments = [
            Segment(text, Style(color=palette.colour(ink)))
            for text, ink in row
            if isinstance(ink, int)
        ]
        if display.character_set != "braille":
            segments = characters.apply(segments, Color(0, 0, 0))
        lines.append(Text.assemble(*((segment.text, segment.style or "") for segment in segments)))
    return lines


def report(scene: Scene, method: Method, steps: int, picture: list[Text]) -> Report:
    """Return the report of the orbits of the scene's start, below the picture."""
    model = scene.equations
    h = scene.h
    start = State(scene.theta, scene.omega)
    kinds = [
        (each, kind_of(each, model, h, orbit(each, model, h, start, steps))) for each in scene.cast
    ]
    (words,) = (sentence(each, kind) for each, kind in kinds if each == method)
    columns = [
        Column(head, itemgetter(at), right=at > 1) for at, head in enumerate(("method", *HEADS))
    ]
    return Report(
        name="section",
        title=title_of(scene, method),
        notes=[
            *picture,
            f"\n{scene_line(scene, 'h', 'z')}, {steps} steps",
            Table(columns, [(each.label, *cells(each, kind)) for each, kind in kinds]),
            f"{steps} steps cannot tell a Lyapunov number below about {least_lyapunov(steps):.2g} "
            "from 0.",
            f"\n{method.label}: {words}",
        ],
        fields={
            "scene": scene.fields(),
            "z": scene.z,
            "steps": steps,
            "orbits": [_fields(each, kind) for each, kind in kinds],
        },
    )


def _fields(method: Method, kind: OrbitKind) -> dict[str, Any]:
    return {
        "method": method.key,
        "rotation": kind.rotation,
        "fraction": None if kind.fraction is None else fraction(kind),
        "island": kind.island,
        "lyapunov": _finite(kind.lyapunov),
        "chaotic": kind.chaotic,
        "over_the_top": kind.spins,
        "energy_error": _finite(kind.energy_error),
        "steps": kind.steps,
        "text": sentence(method, kind),
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
