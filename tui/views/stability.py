"""Stability (F5): a map of each method in half-blocks, z across, amplitude up.

Without colours its characters still tell held swings, lost ones, and unknown ones apart.
"""

import math
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.style import Style
from textual import events

from pendu_tui.engine.methods import Cast, Method
from pendu_tui.engine.methods.verlet import SYMPLECTIC_EULER, VELOCITY_VERLET
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.studies.stability import (
    CHAOTIC,
    FATES,
    GREENE_Z,
    HELD,
    UNKNOWN,
    Cells,
    Grid,
    Piece,
    amplitude,
    is_lost,
    pieces,
)
from pendu_tui.tui.drawing.frame import number_ticks
from pendu_tui.tui.drawing.picture import (
    NOBODY,
    TEXT,
    Ink,
    Palette,
    Picture,
    Row,
    ink_of,
    inks,
    mark,
    mixed,
    palette,
)
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.view import Chooser, StudyView

LIMIT, THRESHOLD, CATCHING, HERE, LOST = "│", "┊", "•", "@", "╱"
MARGIN = 4  # for the labels of the amplitudes
SHADES = 16  # of lost swings, by when; and as many of held ones, by error

Scores = NDArray[np.float64]
Cell = tuple[str, Ink]


def scores(cells: Cells, steps: int) -> Scores:
    """Return a score per swing: -1 unknown, 0 to 1 lost, later; 1 to 2 held, better.

    Both parts are logarithmic, in steps survived and in the largest energy error, down to 1e-12.
    """
    survived = np.log1p(cells["steps"]) / math.log1p(steps)
    digits = -np.log10(np.clip(cells["error"], 1e-12, 1)) / 12
    is_held = np.isin(cells["fate"], HELD)
    return np.select([cells["fate"] == UNKNOWN, is_held], [-1.0, 1 + digits], survived)


def side_by_side(panels: Sequence[Sequence[Row]], across: int) -> list[Row]:
    rows: list[Row] = []
    for first in range(0, len(panels), across):
        for left, *others in zip(*panels[first : first + across], strict=True):
            rows.append([*left, *(cell for row in others for cell in (("  ", NOBODY), *row))])
    return rows


def panel(
    grid: Grid,
    cells: Cells,
    index: int,
    columns: int,
    rows: int,
    palette: Palette,
    *,
    here: tuple[float, float] | None = None,
    w0: float | None = None,
    note: str = "",
) -> list[Row]:
    """Draw one method's panel: its title, `rows` of the map, and the axis.

    `here` is a (z, theta) to mark.  With w0 [1/s] the axis shows h instead of z.
    """
    method = grid.methods[index]
    width = columns - MARGIN
    values = scores(cells[:, index], grid.steps)
    lines = _blocks(worst(values, width, 2 * rows), inks(grid.methods)[index], palette)
    signs = list(theory(method, grid, rows))
    if here:
        signs.append((*here, HERE))
    for z, theta, sign in signs:
        if place := _place(grid, z, theta, width, rows):
            row, column = place
            _, ink = lines[row][column]
            lines[row][column] = sign, ink + Style(color=palette.text, reverse=sign == HERE)
    degrees = _degrees(grid, width, rows)
    map_rows = [
        [(f"{degrees.get(row, ''):>3} ", NOBODY), *_joined(line)] for row, line in enumerate(lines)
    ]
    axis = " " * MARGIN + _axis(grid, width, w0)
    name = f"{'':{MARGIN}}{mark(index, method)} "
    title = f"{name}{method.label}: {note}".rstrip(": ")
    if len(title) > columns:
        title = name + note
    head = (title[:columns].ljust(columns), Style(bold=True))
    return [[head], *map_rows, [(axis, NOBODY)]]


def _blocks(values: Scores, ink: int, palette: Palette) -> list[list[tuple[str, Style]]]:
    """Return half-blocks, two rows of pixels each, hatched with LOST where both are lost."""
    shades = [colour(level / SHADES, ink, palette) for level in range(-SHADES, 2 * SHADES + 1)]
    levels = np.rint((values + 1) * SHADES).astype(int).tolist()

    def cell(up: int, low: int) -> tuple[str, Style]:
        if max(up, low) < SHADES:
            return " ", _style(shades[up], shades[low])
        if max(up, low) < 2 * SHADES:
            return LOST, _style(palette.background, shades[min(up, low)])
        if up < low:
            return "▄", _style(shades[low], shades[up])
        return "▀", _style(shades[up], shades[low])

    pairs = zip(levels[::2], levels[1::2], strict=True)
    return [[cell(up, low) for up, low in zip(*pair, strict=True)] for pair in pairs]


@lru_cache(maxsize=10_000)
def _style(front: str, back: str) -> Style:
    return Style(color=front, bgcolor=back)


def _joined(line: Sequence[tuple[str, Style]]) -> Iterator[Cell]:
    for (text, ink), cells in groupby(line):
        yield text * len(list(cells)), ink


def _degrees(grid: Grid, width: int, rows: int) -> dict[int, int]:
    degrees = {}
    for each in range(0, 180, 45 if rows >= 5 else 90):
        if place := _place(grid, grid.z[0], math.radians(each), width, rows):
            degrees[place[0]] = each
    return degrees


def _axis(grid: Grid, width: int, w0: float | None) -> str:
    symbol = "h"
    if w0 is None:
        symbol, w0 = "z", 1.0
    line = ""
    for value, text in number_ticks(grid.z[0] / w0, grid.z[-1] / w0, max(width // 6, 2)):
        place = _place(grid, value * w0, float(grid.theta[0]), width, 1)
        if place is not None and len(line) <= place[1] <= width - len(text) - 2:
            line = line.ljust(place[1]) + text
    return f"{line} {symbol}".ljust(width)


def theory(method: Method, grid: Grid, rows: int) -> Iterator[tuple[float, float, str]]:
    """Yield theory's (z, theta): the linear limit, Greene's threshold, the catching orbit.

    Greene's threshold belongs to the standard map: symplectic Euler, and velocity Verlet but for
    half a kick. Verlet's catching orbit jumps between q and -q, z² sin q = 4 q.
    """
    count = len(grid.theta)
    middles = (np.arange(rows)[::-1] + 0.5) / rows * count - 0.5
    for theta in np.interp(middles, np.arange(count), grid.theta).tolist():
        if method in (SYMPLECTIC_EULER, VELOCITY_VERLET):
            yield GREENE_Z, theta, THRESHOLD
        if method == VELOCITY_VERLET and theta < math.pi / 2:
            yield math.sqrt(4 * theta / math.sin(theta)), theta, CATCHING
        if method.linear_limit:
            yield method.linear_limit, theta, LIMIT


def worst(values: Scores, columns: int, rows: int) -> Scores:
    """Return the lowest value under each pixel (row, column), so that no failure vanishes."""
    lefts = np.arange(columns) * len(values) // columns
    bottoms = np.arange(rows) * values.shape[1] // rows
    across = np.minimum.reduceat(values, lefts, axis=0)
    return np.minimum.reduceat(across, bottoms, axis=1).T[::-1]


def colour(score: float, ink: int, palette: Palette) -> str:
    """Return the method's colour where held, brighter for smaller errors; else the warning's."""
    if score < 0:
        return palette.background
    if score < 1:
        return mixed(palette.warn, palette.background, 0.9 - 0.5 * score)
    return mixed(palette.colour(ink), palette.background, 0.6 * (2 - score))


def legend(steps: int, palette: Palette, columns: int = 80) -> list[Row]:
    ink = ink_of(VELOCITY_VERLET, ())
    shades = [0.999 * part / 7 for part in range(8)]
    bright = [("▀", _style(*[colour(1 + each, ink, palette)] * 2)) for each in shades]
    dark = [(LOST, _style(palette.background, colour(each, ink, palette))) for each in shades]
    held: list[Cell] = [("held, energy error 1 ", NOBODY), *bright, (" 1e-12   ", NOBODY)]
    lost: list[Cell] = [("lost at step 1 ", NOBODY), *dark, (f" {steps}", NOBODY)]
    lines: list[Cell] = [(f"{LIMIT} linear limit   {THRESHOLD} global chaos above   ", NOBODY)]
    orbit: list[Cell] = [(f"{CATCHING} stable 2-cycle   y: amplitude [°]", NOBODY)]
    if columns >= 80:
        return [held + lost, lines + orbit]
    return [held, lost, lines, orbit]


def place_at(grid: Grid, row: int, column: int, rows: int, columns: int) -> tuple[int, int]:
    """Return the indices (z, theta) of the map's cell nearest to a character's middle."""
    z = int((column + 0.5) / columns * len(grid.z))
    theta = int((rows - row - 0.5) / rows * len(grid.theta))
    return z, theta


def _place(grid: Grid, z: float, theta: float, columns: int, rows: int) -> tuple[int, int] | None:
    """Return (row, column) of the character over (z, theta); None outside the map."""
    if not (grid.z[0] <= z <= grid.z[-1] and grid.theta[0] <= theta <= grid.theta[-1]):
        return None
    across = (np.interp(z, grid.z, np.arange(len(grid.z))) + 0.5) / len(grid.z)
    up = (np.interp(theta, grid.theta, np.arange(len(grid.theta))) + 0.5) / len(grid.theta)
    return min(rows - 1, int((1 - up) * rows)), min(columns - 1, int(across * columns))


PASSES = (300, 10_000)
"""Steps of each swing: first a quick map, then the final one."""


def _grid(cast: Cast) -> Grid:
    theta = (np.arange(48) + 0.5) * math.pi / 48
    return Grid(theta, (np.arange(80) + 0.5) * 3 / 80, PASSES[-1], cast)


def _outcome(cell: Any) -> str:
    fate = FATES[cell["fate"]]
    return fate.replace("holds, wobbling", "held, larger wobble").replace("holds", "held")


def note(cell: Any) -> str:
    if cell["fate"] == UNKNOWN:
        return "…"
    if cell["fate"] == CHAOTIC:
        return _outcome(cell)
    if is_lost(cell):
        return f"{_outcome(cell)}, step {cell['steps'] + 1}"
    return f"{_outcome(cell)}, {cell['error']:.0e}"


def verdict(grid: Grid, cells: Cells, index: int, place: tuple[int, int], w0: float) -> str:
    """Return the outcome of a method at a place, and the nearest h with another outcome."""
    z, theta = place
    row = cells[:, index, theta]
    cell = row[z]
    degrees = math.degrees(grid.theta[theta])
    where = f"{grid.methods[index].label} at h {grid.z[z] / w0:.3g} s, {degrees:.3g}°:"
    if cell["fate"] == UNKNOWN:
        return f"{where} not computed yet"
    outcome = _outcome(cell)
    here = "held"
    there = "lost"
    if is_lost(cell):
        here, there = there, here
        if cell["fate"] != CHAOTIC:
            outcome = f"lost at step {cell['steps'] + 1}, {outcome}"
    else:
        outcome += f", energy error {cell['error']:.1e}"
    known = row["fate"] != UNKNOWN
    other = np.flatnonzero(known & (np.isin(row["fate"], HELD) != (here == "held")))
    if not len(other) and not known.all():
        missing = {"lost": "loss", "held": "h that holds"}[there]
        return f"{where} {outcome}; no {missing} found yet"
    if not len(other):
        return f"{where} {outcome}; {here} at every h on this map"
    nearest = grid.z[other[np.abs(other - z).argmin()]]
    return f"{where} {outcome}; {there} at h {nearest / w0:.3g} s"


class StabilityPane(Chooser[tuple[int, int]]):
    """Draws the map while it is computed; another scene only moves the mark and the axis.

    Places on the map are indices of z and theta.
    """

    BINDING_GROUP_TITLE = "Stability"
    HELP = "A click starts with that h and amplitude."

    def __init__(self) -> None:
        super().__init__()
        self._begin(())

    def _begin(self, cast: Cast) -> None:
        self.grid = _grid(cast)
        self.cells: Cells = self.grid.unknown()
        self._is_begun = False
        self._title = ""
        self._state = ""
        self.cursor = self.pointer = None

    @property
    def settled(self) -> bool:
        if self.source.scene.why_not_mapped:
            return True
        return self._is_begun and not self.is_computing

    def forget(self) -> None:
        self._begin(())

    def add(self, result: Piece) -> None:
        part = result.part
        self.cells[part.z, part.method] = result.cells
        self._is_begun = True
        self._title = f"Stability (F5), {part.grid.steps} steps: h [s], amplitude [°]"
        self._state = (
            f"Computing {100 * result.done:.0f} %. "  # as a title it would repaint the pane
        )
        if result.done == 1 and part.grid.steps == PASSES[-1]:
            self._state = ""

    def here(self, index: int) -> tuple[float, float] | None:
        """Return the (z, amplitude) of a method on screen, if it swings."""
        theta = amplitude(self.source.scene)
        if theta is None:
            return None
        return abs(self.source.stepping.own[index]) * self.source.scene.w0, theta

    def aim(self, index: int) -> tuple[int, int] | None:
        if self.cursor or self.pointer:
            return self.cursor or self.pointer
        if (here := self.here(index)) is None or here[0] > self.grid.z[-1]:
            return None
        z, theta = here
        return int(abs(self.grid.z - z).argmin()), int(abs(self.grid.theta - theta).argmin())

    def picture(self, source: Source, sample: Sample) -> Picture:
        if why := source.scene.why_not_mapped:
            self.write_titles("Stability (F5)")
            return Picture(self.words(why))
        if self.cast != self.grid.methods:
            self._begin(self.cast)
            self.compute(pieces, self.grid, PASSES)
        self.write_titles(self._title)
        columns, rows = self._panel_size
        if columns <= 2 * MARGIN:
            return Picture()
        panels = [self._panel(index, columns, rows) for index in self.places]
        words = ""
        if self.places and (aim := self.aim(self.index)):
            words = verdict(self.grid, self.cells, self.index, aim, source.scene.w0)
        blank: Row = [("", TEXT)]
        below = [*self.words(f"{self._state}{words}"), blank, blank][:2]
        return Picture([*side_by_side(panels, 2), *below, *self._legend])

    def _panel(self, index: int, columns: int, rows: int) -> list[Row]:
        here = self.here(index)
        if self.cursor is not None:
            here = self.grid.z[self.cursor[0]], self.grid.theta[self.cursor[1]]
        words = ""
        if aim := self.aim(index):
            words = note(self.cells[aim[0], index, aim[1]])
        return panel(
            self.grid,
            self.cells,
            index,
            columns,
            rows,
            palette(self.app.theme),
            here=here,
            w0=self.source.scene.w0,
            note=words,
        )

    @property
    def _panel_size(self) -> tuple[int, int]:
        """Columns of a panel and rows of its map; two panels are side by side."""
        lines = -(-len(self.places) // 2) or 1
        rows = (self.room.height - 2 - len(self._legend)) // lines - 2
        return (self.room.width - 2) // 2, max(1, rows)

    @property
    def _legend(self) -> list[Row]:
        # it may use the columns of the frame, too
        lines = legend(self.grid.steps, palette(self.app.theme), self.room.width + 2)
        return lines[: max(self.room.height // 7, 1)]

    def action_move(self, right: int, up: int) -> None:
        if self.cast != self.grid.methods:
            return
        z, theta = self.aim(self.index) or (0, 0)
        z = min(max(z + right, 0), len(self.grid.z) - 1)
        self.cursor = z, min(max(theta + up, 0), len(self.grid.theta) - 1)
        self.draw()

    def choose(self, place: tuple[int, int]) -> None:
        z, theta = place
        h = float(self.grid.z[z]) / self.source.scene.w0
        self.start_at(float(self.grid.theta[theta]), 0.0, h)

    def place_under(self, event: events.MouseEvent) -> tuple[int, int] | None:
        columns, rows = self._panel_size
        x, y = event.get_content_offset_capture(self)
        across, column = divmod(x, columns + 2)
        down, row = divmod(y, rows + 2)
        inside = across in (0, 1) and MARGIN <= column < columns and 1 <= row <= rows
        number = 2 * down + across
        is_mapped = inside and self.cast == self.grid.methods
        if not is_mapped or number not in range(len(self.places)):
            return None
        self.described = self.cast[self.places[number]].key
        return place_at(self.grid, row - 1, column - MARGIN, rows, columns - MARGIN)


class StabilityView(StudyView):
    PANE = StabilityPane
