"""What the section command prints: the portrait of a method's map, and the orbits of the scene's start in words."""

import io
import math
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.segment import Segment
from rich.terminal_theme import DEFAULT_TERMINAL_THEME, TerminalTheme
from rich.text import Text

from engine.methods import Method
from engine.models.model import State
from engine.phase_space.section import OrbitKind, kind_of, least_lyapunov, orbit, pieces
from engine.scenes import Scene
from tui.cli.errors import Exit
from tui.cli.files import whole_file
from tui.cli.output import console, print_lines, print_picture, progress, scene_line, write_json
from tui.cli.report import print_table
from tui.drawing.canvas import Picture
from tui.drawing.palette import PALETTES
from tui.terminal.options import TerminalOptions
from tui.views.phase.section import Section, starts
from tui.views.phase.viewport import Viewport
from tui.words.orbit import HEADS, cells, fraction, sentence


@dataclass(frozen=True, slots=True)
class Study:
    """What was asked for."""

    scene: Scene
    method: Method  # whose map is drawn
    starts: int
    steps: int

    def kind(self, method: Method) -> OrbitKind:
        """The orbit of the scene's start."""
        model, h, start = self.scene.equations, self.scene.h, State(self.scene.theta, self.scene.omega)
        return kind_of(method, model, h, orbit(method, model, h, start, self.steps))

    def picture(self, columns: int, rows: int) -> Picture:
        model, h, start = self.scene.equations, self.scene.h, State(self.scene.theta, self.scene.omega)
        viewport = Viewport.portrait(columns, rows, self.scene, wrap=model.turns)
        section, done = Section(viewport, model, self.method), 0
        with progress("section") as show:
            for piece in pieces(self.method, model, h, starts(viewport, self.starts), self.steps):
                section.add(piece)
                done += piece[0].shape[1]
                show(done, self.starts)
        return section.picture(orbit(self.method, model, h, start, self.steps), start)


def print_text(study: Study, size: tuple[int, int] | None, display: TerminalOptions) -> int:
    """Print the picture, as wide as the terminal, and below it the words."""
    on = console()
    columns, rows = size or (max(on.width, 40), max(on.width, 40) * 5 // 16)
    picture = study.picture(columns, rows)
    print(_title(study))
    characters = display.character_set if "utf" in on.encoding else "ascii"
    print_picture(on, _lines(picture, TerminalOptions(display.theme, characters)))
    _print_words(study)
    return Exit.FINE


def print_json(study: Study) -> int:
    """Print one object: the orbit of the scene's start under each method's map."""
    orbits = [
        {
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
        for method, kind in ((method, study.kind(method)) for method in study.scene.cast)
    ]
    write_json("section", {"scene": study.scene.fields(), "z": study.scene.z, "steps": study.steps, "orbits": orbits})
    return Exit.FINE


def write_file(study: Study, path: Path, force: bool, size: tuple[int, int], display: TerminalOptions) -> int:
    """Write the picture, with its title, as SVG or as text; the same bytes every time."""
    with whole_file(path, force) as part:
        picture = study.picture(*size)
        lines = [Text(_title(study)), *_lines(picture, display)]
        if path.suffix.lower() == ".svg":
            on = Console(file=io.StringIO(), record=True, width=size[0], height=size[1] + 1, color_system="truecolor")
            on.print(*lines, sep="\n", no_wrap=True, overflow="crop")
            text = on.export_svg(title="pendu-tui section", theme=_theme(display.theme), unique_id="terminal")
        else:
            text = "\n".join(line.plain.rstrip() for line in lines) + "\n"
        part.write_text(text, encoding="utf-8")
    print(f"{path}: {_title(study)}")
    return Exit.FINE


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _title(study: Study) -> str:
    return f"{study.method.label}, h {study.scene.h:g} s (z = {study.scene.z:.4g}): its own phase portrait"


def _print_words(study: Study) -> None:
    """Print the orbits of the start as a table, and a sentence on that of the method that is drawn."""
    kinds = [(method, study.kind(method)) for method in study.scene.cast]
    print_lines("", f"{scene_line(study.scene, 'h', 'z')}, {study.steps} steps")
    rows = [(method.label, *cells(method, kind)) for method, kind in kinds]
    print_table("llrrrr", ("method", *HEADS), rows)
    print_lines(
        f"{study.steps} steps cannot tell a Lyapunov number below about {least_lyapunov(study.steps):.2g} from 0."
    )
    kind = next((kind for method, kind in kinds if method == study.method), None) or study.kind(study.method)
    print_lines("", f"{study.method.label}: {sentence(study.method, kind)}")


def _lines(picture: Picture, display: TerminalOptions) -> list[Text]:
    """The rows of a picture in the colours and characters of a display."""
    palette = PALETTES[display.theme]
    rows = [[Segment(text, None) for text, _ in picture.row(y)] for y in range(len(picture.characters))]
    if display.character_set != "braille":
        from textual.color import Color

        from tui.terminal.character_sets import CharacterSetFilter

        characters = CharacterSetFilter(display.character_set)
        rows = [characters.apply(row, Color(0, 0, 0)) for row in rows]
    owners = [[palette.colour(owner) for _, owner in picture.row(y)] for y in range(len(rows))]
    return [
        Text.assemble(*((segment.text, colour) for segment, colour in zip(row, colours, strict=True)))
        for row, colours in zip(rows, owners, strict=True)
    ]


def _theme(name: str) -> TerminalTheme:
    """The theme's background and text for an SVG; the 16 colours are Rich's."""
    palette = PALETTES[name]
    if not palette.background.startswith("#"):
        return DEFAULT_TERMINAL_THEME
    background, text = (tuple(bytes.fromhex(colour[1:])) for colour in (palette.background, palette.text))
    colours = [tuple(DEFAULT_TERMINAL_THEME.ansi_colors[number]) for number in range(16)]
    return TerminalTheme(background, text, colours[:8], colours[8:])  # type: ignore[arg-type]
