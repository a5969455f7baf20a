"""The report of `stability --section`: a method's portrait, and the orbits of the start."""

import argparse
import math
import os
from functools import partial
from operator import itemgetter
from typing import Any

from rich.text import Text

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
from tui.cli.errors import UserError
from tui.cli.report import Column, Report, Table, console, finite, progress, publish, scene_line
from tui.cli.workers import workers_of
from tui.commands.studies import figures
from tui.drawing.palette import PALETTES, ink_of
from tui.terminal.options import fitting_theme
from tui.views.phase.picture import Section, starts
from tui.views.phase.viewport import Viewport
from tui.words.orbit import HEADS, cells, fraction, sentence

MAX_POINTS = 10**8  # 1.6 GB in memory


def run(scene: Scene, options: argparse.Namespace, is_figure: bool) -> None:
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
        figures.draw_section(options, title, _orbits(scene, method, options, viewport), edges)
        print(f"{options.output}: {title}")
        return
    lines: list[Text] = []
    if options.output is None and not options.json:
        lines = _portrait(scene, method, options)
    publish(_report(scene, method, title, options.steps, lines), options)


def _orbits(
    scene: Scene, method: Method, options: argparse.Namespace, viewport: Viewport
) -> list[Points]:
    orbits: list[Points] = []
    followed = partial(iterate, method, scene.equations, scene.h, steps=options.steps)
    done = 0
    with workers_of(options) as workers, progress("section") as show:
        for piece in workers.map(followed, batches(starts(viewport, options.starts))):
            orbits.append(piece)
            done += piece[0].shape[1]
            show(done, options.starts)
    return orbits


def _portrait(scene: Scene, method: Method, options: argparse.Namespace) -> list[Text]:
    """Return the lines of a method's portrait, as wide as the terminal and in its colours."""
    model = scene.equations
    start = State(scene.theta, scene.omega)
    width = max(console().width, 40)
    viewport = Viewport.portrait(width, width * 5 // 16, scene)
    section = Section(viewport, model, method, ink_of(method, scene.cast))
    for piece in _orbits(scene, method, options, viewport):
        section.add(piece)
    drawn = section.picture(orbit(method, model, scene.h, start, options.steps), start)
    return figures.lines_of(drawn, PALETTES[fitting_theme(os.environ)])


def _report(scene: Scene, method: Method, title: str, steps: int, picture: list[Text]) -> Report:
    model = scene.equations
    start = State(scene.theta, scene.omega)
    kinds = {
        each: kind_of(each, model, scene.h, orbit(each, model, scene.h, start, steps))
        for each in scene.cast
    }
    columns = [
        Column(head, itemgetter(at), right=at > 1) for at, head in enumerate(("method", *HEADS))
    ]
    return Report(
        name="section",
        title=title,
        notes=[
            *picture,
            f"\n{scene_line(scene, 'h', 'z')}, {steps} steps",
            Table(columns, [(each.label, *cells(each, kind)) for each, kind in kinds.items()]),
            f"{steps} steps cannot tell a Lyapunov number below about {least_lyapunov(steps):.2g} "
            "from 0.",
            f"\n{method.label}: {sentence(method, kinds[method])}",
        ],
        fields={
            "scene": scene.fields(),
            "z": scene.z,
            "steps": steps,
            "orbits": [_fields(each, kind) for each, kind in kinds.items()],
        },
    )


def _fields(method: Method, kind: OrbitKind) -> dict[str, Any]:
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
