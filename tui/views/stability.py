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
from pendu_tui.tui.drawing.frame import Axis, Frame, number_ticks
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
LEFT = 6  # columns of the axis and its labels
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


def in_pairs(panels: Sequence[Sequence[Row]]) -> list[Row]:
    rows: list[Row] = []
    for first in range(0, len(panels), 2):
        for left, *others in zip(*panels[first : first + 2], strict=True):
            rows.append([*left, *(cell for row in others for cell in (("  ", NOBODY), *row))])
    return rows


def panel(
    frame: Frame,
    values: Scores,
    method: Method,
    ink: int,
    palette: Palette,
    *,
    title: str,
    here: tuple[float, float] | None = None,
) -> list[Row]:
    """Draw one method's panel: a title, the map of its scores (z, theta), and the axes.

    The frame's axes are z and theta [rad]; `here` is a (z, theta) to mark.
    """
    lines = _blocks(worst(values, frame.columns, 2 * frame.rows), ink, palette)
    signs = list(theory(method, frame.rows))
    if here:
        signs.append((*here, HERE))
    for z, theta, sign in signs:
        if z <= frame.x_axis.high:
            line = lines[frame.row(theta)]
            column = frame.column(z)
            _, ink_below = line[column]
            line[column] = sign, ink_below + Style(color=palette.text, reverse=sign == HERE)
    width = frame.left + frame.columns
    head = title[:width].ljust(width)
    return [[(head, Style(bold=True))], *frame.around([*map(_joined, lines)])]


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


def _joined(line: Sequence[Cell]) -> Row:
    return [(text * len(list(cells)), ink) for (text, ink), cells in groupby(line)]


def theory(method: Method, rows: int) -> Iterator[tuple[float, float, str]]:
    """Yield theory's (z, theta): the linear limit, Greene's threshold, the catching orbit.

    Greene's threshold belongs to the standard map: symplectic Euler, and velocity Verlet but for
    half a kick. Verlet's catching orbit jumps between q and -q, z² sin q = 4 q.
    """
    for row in range(rows):
        theta = (row + 0.5) / rows * math.pi
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


def legend(steps: int, palette: Palette) -> list[Row]:
    ink = ink_of(VELOCITY_VERLET, ())
    shades = [0.999 * part / 7 for part in range(8)]
    bright = [("▀", _style(*[colour(1 + each, ink, palette)] * 2)) for each in shades]
    dark = [(LOST, _style(palette.background, colour(each, ink, palette))) for each in shades]
    held: list[Cell] = [("held: error 1 ", NOBODY), *bright, (" 1e-12   ", NOBODY)]
    lost: list[Cell] = [("lost: step 1 ", NOBODY), *dark, (f" {steps}", NOBODY)]
    signs = f"{LIMIT} linear limit   {THRESHOLD} global chaos beyond   {CATCHING} stable 2-cycle"
    return [held + lost, [(signs, NOBODY)]]


PASSES = (300, 10_000)
"""Steps of each swing: first a quick map, then the final one."""


MAX_Z = 3.0


def outcome(cell: Any) -> str:
    """Write "held, error 2e-2" or "over the top, step 41"."""
    if cell["fate"] == UNKNOWN:
        return "not computed yet"
    fate = FATES[cell["fate"]].replace("holds", "held")
    if cell["fate"] == CHAOTIC:
        return fate
    if is_lost(cell):
        return f"{fate}, step {cell['steps'] + 1}"
    return f"{fate}, error {cell['error']:.0e}".replace("e-0", "e-").replace("e+0", "e")


def verdict(grid: Grid, cells: Cells, index: int, place: tuple[int, int], w0: float) -> str:
    """Return the outcome of a method at a place, and the nearest h with another outcome."""
    z, theta = place
    row = cells[:, index, theta]
    degrees = math.degrees(grid.theta[theta])
    where = f"{grid.methods[index].label} at h {grid.z[z] / w0:.3g} s, {degrees:.3g}°"
    text = f"{where}: {outcome(row[z])}"
    if row[z]["fate"] == UNKNOWN:
        return text
    words = ["held", "lost"]
    if is_lost(row[z]):
        words.reverse()
    here, there = words
    known = row["fate"] != UNKNOWN
    other = np.flatnonzero(known & (np.isin(row["fate"], HELD) != (here == "held")))
    if len(other):
        nearest = grid.z[other[np.abs(other - z).argmin()]]
        return f"{text}; {there} at h {nearest / w0:.3g} s"
    if known.all():
        return f"{text}; {here} at every h on this map"
    return f"{text}; not {there} at any h so far"


class StabilityPane(Chooser[tuple[int, int]]):
    """Draws the map while it is computed; another scene only moves the mark and the axis.

    Places on the map are indices of z and theta.
    """

    BINDING_GROUP_TITLE = "Stability"
    HELP = "A click starts a run with the h and amplitude there."

    def __init__(self) -> None:
        super().__init__()
        self._begin(())

    def _begin(self, cast: Cast) -> None:
        theta = (np.arange(48) + 0.5) * math.pi / 48
        self.grid = Grid(theta, (np.arange(80) + 0.5) * MAX_Z / 80, PASSES[-1], cast)
        self.cells: Cells = self.grid.unknown()
        self._latest: Piece | None = None

    def forget(self) -> None:
        self._begin(())

    def add(self, result: Piece) -> None:
        part = result.part
        self.cells[part.z, part.method] = result.cells
        self._latest = result

    def here(self, index: int) -> tuple[float, float] | None:
        """Return the (z, amplitude) of a method on screen, if it swings."""
        theta = amplitude(self.source.scene)
        if theta is None:
            return None
        return abs(self.source.stepping.own[index]) * self.source.scene.w0, theta

    def aim(self, index: int) -> tuple[int, int] | None:
        if chosen := self.cursor or self.pointer:
            return chosen
        if (here := self.here(index)) is None or here[0] > self.grid.z[-1]:
            return None
        z, theta = here
        return int(abs(self.grid.z - z).argmin()), int(abs(self.grid.theta - theta).argmin())

    def picture(self, source: Source, sample: Sample) -> Picture:
        title = "Stability (F5)"
        if why := source.scene.why_not_mapped:
            self.write_titles(title)
            return Picture(self.words(why))
        if self.cast != self.grid.methods:
            self._begin(self.cast)
            self.compute(pieces, self.grid, PASSES)
        words = ""
        if latest := self._latest:
            steps = latest.part.grid.steps
            title += f", {steps} steps: h [s], amplitude [°]"
            if latest.done < 1 or steps < PASSES[-1]:
                words = f"Computing {100 * latest.done:.0f} %. "  # a title would repaint the pane
        self.write_titles(title)
        frame = self._frame
        panels = [self._panel(index, frame) for index in self.places]
        if self.places and (aim := self.aim(self.index)):
            words += verdict(self.grid, self.cells, self.index, aim, source.scene.w0)
        blank: Row = [("", TEXT)]
        below = [*self.words(words, rows=2), blank, blank][:2]
        return Picture([*in_pairs(panels), *below, *self._legend])

    def _panel(self, index: int, frame: Frame) -> list[Row]:
        here = self.here(index)
        if self.cursor is not None:
            here = self.grid.z[self.cursor[0]], self.grid.theta[self.cursor[1]]
        method = self.cast[index]
        title = f"{mark(index, method)} "
        words = ""
        if aim := self.aim(index):
            words = outcome(self.cells[aim[0], index, aim[1]])
        width = frame.left + frame.columns
        if len(title + method.label + words) + 2 <= width:
            title += f"{method.label}: "
        elif len(title + words) > width:  # half of a number would be another one
            words = words.partition(",")[0]
        return panel(
            frame,
            scores(self.cells[:, index], self.grid.steps),
            method,
            inks(self.cast)[index],
            palette(self.app.theme),
            title=(title + words).rstrip(": "),
            here=here,
        )

    @property
    def _frame(self) -> Frame:
        """The axes of each panel; two panels are side by side."""
        lines = -(-len(self.places) // 2) or 1
        rows = max((self.room.height - 2 - len(self._legend)) // lines - 2, 1)
        columns = max((self.room.width - 2) // 2 - LEFT, 1)
        w0 = self.source.scene.w0
        ticks = number_ticks(0.0, MAX_Z / w0, max(columns // 9, 2))  # h [s]
        x_axis = Axis(0.0, MAX_Z, {h * w0: text for h, text in ticks.items()})
        step = 45 if rows >= 5 else 90
        degrees = {math.radians(each): str(each) for each in range(0, 180, step)}
        return Frame(x_axis, Axis(0.0, math.pi, degrees), columns, rows)

    @property
    def _legend(self) -> list[Row]:
        lines = legend(self.grid.steps, palette(self.app.theme))
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
        frame = self._frame
        x, y = event.get_content_offset_capture(self)
        across, right = divmod(x, frame.left + frame.columns + 2)
        below, down = divmod(y, frame.rows + 2)
        column = right - frame.left
        row = down - 1
        number = 2 * below + across
        is_inside = 0 <= column < frame.columns and 0 <= row < frame.rows
        is_mapped = is_inside and self.cast == self.grid.methods
        if not is_mapped or number not in range(len(self.places)):
            return None
        self.described = self.cast[self.places[number]].key
        z = int((column + 0.5) / frame.columns * len(self.grid.z))
        return z, int((frame.rows - row - 0.5) / frame.rows * len(self.grid.theta))


def view(name: str) -> StudyView:
    return StudyView(name, StabilityPane())
