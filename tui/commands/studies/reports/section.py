"""The report of `stability --section`: the portrait of a method's map, and the orbits of the scene's start."""

import argparse
import io
import math
import os
from operator import itemgetter
from typing import Any

from rich.console import Console
from rich.segment import Segment
from rich.terminal_theme import DEFAULT_TERMINAL_THEME, TerminalTheme
from rich.text import Text

from engine.methods import Method
from engine.models.model import State
from engine.phase_space.section import OrbitKind, kind_of, least_lyapunov, orbit, pieces
from engine.scenes import Scene
from tui.cli.errors import Exit, UserError
from tui.cli.files import whole_file
from tui.cli.output import console, progress, scene_line
from tui.cli.report import Column, Report, Table, publish
from tui.drawing.palette import PALETTES, ink_of
from tui.drawing.picture import Picture
from tui.terminal.options import CharacterSet, TerminalOptions, terminal_options_of
from tui.views.phase.section import Section, starts
from tui.views.phase.viewport import Viewport
from tui.views.view import DESCRIBED_FIRST
from tui.words.orbit import HEADS, cells, fraction, sentence

MAX_STARTS = 10_000
MAX_STEPS = 100_000  # of an orbit
FILE_SIZE = (120, 36)  # columns, rows


def run(scene: Scene, options: argparse.Namespace, steps: int) -> int:
    """Draw the portrait of the first of --methods, and describe the orbit of the start under each method."""
    for name, value, limit in (("starts", options.starts, MAX_STARTS), ("steps", steps, MAX_STEPS)):
        if value > limit:
            raise UserError(f"--{name} {value} is too many; use at most {limit}.")
    method = drawn(scene, options)
    title = f"{method.label}, h {scene.h:g} s (z = {scene.z:.4g}): its own phase portrait"
    display = terminal_options_of(options, os.environ, "utf-8")
    path = options.output
    if path is not None and path.suffix.lower() != ".json":
        theme = "dark" if options.theme == "auto" else options.theme  # of a file, not of the terminal
        size = options.size or FILE_SIZE
        with whole_file(path, options.force) as part:
            lines = [Text(title), *portrait(scene, method, options.starts, steps, size, display._replace(theme=theme))]
            part.write_text(_svg(lines, size, theme) if path.suffix.lower() == ".svg" else _plain(lines), "utf-8")
        print(f"{path}: {title}")
        return Exit.FINE
    lines = []
    if path is None and not options.json:
        on = console()
        characters = display.character_set if "utf" in on.encoding else "ascii"
        width = max(on.width, 40)
        size = options.size or (width, width * 5 // 16)
        lines = portrait(scene, method, options.starts, steps, size, display._replace(character_set=characters))
    publish(report(scene, method, steps, title, lines), options)
    return Exit.FINE


def drawn(scene: Scene, options: argparse.Namespace) -> Method:
    """Return the method whose map is drawn: the first that --methods names, else velocity Verlet."""
    if options.methods is None:
        for method in scene.cast:
            if method.key == DESCRIBED_FIRST:
                return method
    return scene.cast[0]


def portrait(
    scene: Scene, method: Method, count: int, steps: int, size: tuple[int, int], display: TerminalOptions
) -> list[Text]:
    """Return the lines of the phase portrait of a method's map, of so many starts."""
    model = scene.equations
    start = State(scene.theta, scene.omega)
    viewport = Viewport.portrait(*size, scene, wrap=model.turns)
    section = Section(viewport, model, method, ink_of(method, scene.cast))
    done = 0
    with progress("section") as show:
        for piece in pieces(method, model, scene.h, starts(viewport, count), steps):
            section.add(piece)
            done += piece[0].shape[1]
            show(done, count)
    return _lines(section.picture(orbit(method, model, scene.h, start, steps), start), display)


def report(scene: Scene, method: Method, steps: int, title: str, picture: list[Text]) -> Report:
    """Return the report of the orbits of the scene's start, below the picture."""
    model, h, start = scene.equations, scene.h, State(scene.theta, scene.omega)
    kinds = [(each, kind_of(each, model, h, orbit(each, model, h, start, steps))) for each in scene.cast]
    (words,) = (sentence(each, kind) for each, kind in kinds if each == method)
    heads = [Column("method", lambda row: row[0]), Column(HEADS[0], lambda row: row[1])]
    heads += [Column(head, itemgetter(at), right=True) for at, head in enumerate(HEADS[1:], 2)]
    return Report(
        name="section",
        title=title,
        notes=[
            *picture,
            f"\n{scene_line(scene, 'h', 'z')}, {steps} steps",
            Table(heads, [(each.label, *cells(each, kind)) for each, kind in kinds]),
            f"{steps} steps cannot tell a Lyapunov number below about {least_lyapunov(steps):.2g} from 0.",
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


def _lines(picture: Picture, display: TerminalOptions) -> list[Text]:
    """Return the rows of a picture in the colours and characters of a display."""
    palette = PALETTES[display.theme]
    lines = []
    for spans in picture.rows:
        segments = [Segment(text, None) for text, _ in spans]
        if display.character_set != "braille":
            segments = _in_characters(segments, display.character_set)
        colours = [palette.colour(ink) for _, ink in spans if isinstance(ink, int)]
        coloured = zip((segment.text for segment in segments), colours, strict=True)
        lines.append(Text.assemble(*coloured))
    return lines


def _in_characters(row: list[Segment], character_set: CharacterSet) -> list[Segment]:
    from textual.color import Color

    from tui.terminal.character_sets import CharacterSetFilter

    return CharacterSetFilter(character_set).apply(row, Color(0, 0, 0))


def _plain(lines: list[Text]) -> str:
    return "\n".join(line.plain.rstrip() for line in lines) + "\n"


def _svg(lines: list[Text], size: tuple[int, int], theme: str) -> str:
    """Return an SVG of the lines, byte-identical every time."""
    on = Console(file=io.StringIO(), record=True, width=size[0], height=size[1] + 1, color_system="truecolor")
    on.print(*lines, sep="\n", no_wrap=True, overflow="crop")
    return on.export_svg(title="pendu-tui stability --section", theme=_theme(theme), unique_id="terminal")


def _theme(name: str) -> TerminalTheme:
    """Return the theme's background and text for an SVG; the 16 colours are Rich's."""
    palette = PALETTES[name]
    if not palette.background.startswith("#"):
        return DEFAULT_TERMINAL_THEME
    background, text = (tuple(bytes.fromhex(colour[1:])) for colour in (palette.background, palette.text))
    colours = [tuple(DEFAULT_TERMINAL_THEME.ansi_colors[number]) for number in range(16)]
    return TerminalTheme(background, text, colours[:8], colours[8:])  # type: ignore[arg-type]
