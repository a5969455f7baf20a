"""Canvas: points, lines and words as characters.

A canvas has 2×4 dots in every cell.  Coordinates are in dots, x to the right and y downwards from
the upper left corner; dot (i, j) covers [i, i+1) × [j, j+1).  Points outside or not finite are not
drawn.  Pendulums have few dots: drawing them without NumPy is faster, and does not import it.

A cell of a terminal has one colour, so it shows the dots of one ink only, and each dot in the ink
it was set in.  Methods come before their faint inks, and these before all others, whatever the
order of drawing.  Equals of the upper two ranks take turns, so that none vanishes.  Of the others
the one drawn first lies below.
"""

import codecs
import copy
import re
from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import product
from math import floor, isfinite
from typing import TYPE_CHECKING, Self

from pendu_tui.tui.drawing.picture import FAINT, NOBODY, Picture, Row

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Numbers = NDArray[np.float64] | NDArray[np.intp]

Dot = tuple[int, int]
"""A cell of a canvas of one size, and the bit of a dot in it."""

_BITS = bytes(1 << place for place in (0, 3, 1, 4, 2, 5, 6, 7))
"""The bits of Unicode's braille for a cell's dots, row by row."""
_BRAILLE = " " + "".join(map(chr, range(0x2801, 0x2900)))
_FLAT = {0x09: 0x01, 0x12: 0x02, 0x24: 0x04, 0xC0: 0x40}
"""Both dots of a row of dots, and the left one of them."""
_DOTTED = bytes(_FLAT.get(dots, dots) for dots in range(256))
CELL = 60
"""What a cell costs its methods together: it is divisible by their number, up to six."""
_SPANS = re.compile(rb"\0*([^\0])(?:\1|\0)*|\0+", re.DOTALL)
"""Cells of one ink and the blanks behind them, which look the same in any ink."""


class Canvas:
    """A drawing area of `columns` × `rows` cells."""

    def __init__(self, columns: int, rows: int) -> None:
        self.columns = columns
        self.rows = rows
        self.width = 2 * columns  # dots
        self.height = 4 * rows
        self._layers: dict[int, bytearray] = {}  # the dots of each cell, by ink
        self._letters: dict[int, tuple[str, int]] = {}  # by row * columns + column

    def copy(self) -> Self:
        copied = copy.copy(self)
        copied._layers = {ink: layer[:] for ink, layer in self._layers.items()}
        copied._letters = self._letters.copy()
        return copied

    def _layer(self, ink: int) -> bytearray:
        if ink not in self._layers:
            self._layers[ink] = bytearray(self.columns * self.rows)
        return self._layers[ink]

    def points(self, points: Iterable[tuple[float, float]], ink: int) -> None:
        self.dots(self.dots_of(points), ink)

    def dots_of(self, points: Iterable[tuple[float, float]]) -> list[Dot]:
        """Return the dots of points, for `dots`; those that would not be drawn have no bit."""
        dots = []
        for x, y in points:
            dot = (0, 0)
            if 0 <= x < self.width and 0 <= y < self.height:
                i = int(x)
                j = int(y)
                dot = ((j >> 2) * self.columns + (i >> 1), _BITS[(j & 3) << 1 | i & 1])
            dots.append(dot)
        return dots

    def dots(self, dots: Iterable[Dot], ink: int) -> None:
        """Set dots that are known: seven times as fast as `points`."""
        layer = self._layer(ink)
        for cell, bit in dots:
            layer[cell] |= bit

    def scatter(self, x: "Numbers", y: "Numbers", ink: int) -> None:
        """Set the dots of arrays x and y: for many dots it is faster than `points`."""
        import numpy as np

        inside = (x >= 0) & (x < self.width) & (y >= 0) & (y < self.height)
        i = np.where(inside, x, 0).astype(np.intp)
        j = np.where(inside, y, 0).astype(np.intp)
        bits = np.frombuffer(_BITS, np.uint8)[(j & 3) << 1 | i & 1]
        layer = np.frombuffer(self._layer(ink), np.uint8)
        np.bitwise_or.at(layer, (j >> 2) * self.columns + (i >> 1), np.where(inside, bits, 0))

    def line(
        self, x0: float, y0: float, x1: float, y1: float, ink: int, dotted: bool = False
    ) -> None:
        """Draw a straight line, one dot per column or row; dotted: every third dot."""
        dx = x1 - x0
        dy = y1 - y0
        if not (isfinite(dx) and isfinite(dy)):
            return
        steep = abs(dy) > abs(dx)
        start, step, size = (y0, dy, self.height) if steep else (x0, dx, self.width)
        low = max(floor(min(start, start + step)), 0)
        high = min(floor(max(start, start + step)), size - 1)
        stride = 3 if dotted else 1
        dots = range(low, high + 1, stride) if step >= 0 else range(high, low - 1, -stride)
        shares = [(at + 0.5 - start) / (step or 1.0) for at in dots]
        if shares:  # the ends need not be in the middle of a dot
            shares[0] = max(shares[0], 0.0)
            shares[-1] = min(shares[-1], 1.0)
        if steep:
            self.points(zip([x0 + share * dx for share in shares], dots, strict=True), ink)
        else:
            self.points(zip(dots, [y0 + share * dy for share in shares], strict=True), ink)

    def path(self, x: "Numbers", y: "Numbers", ink: int) -> None:
        """Join points with lines, but for points that are not finite."""
        import numpy as np

        with np.errstate(all="ignore"):
            dx = np.diff(x)
            dy = np.diff(y)
            steep = abs(dy) > abs(dx)  # these lines have a dot in each row, others in each column
            start = np.where(steep, y[:-1], x[:-1])
            length = np.where(steep, dy, dx)
            first = np.floor(np.minimum(start, start + length)).clip(0)
            last = np.floor(np.maximum(start, start + length))
            last = last.clip(max=np.where(steep, self.height, self.width))
            counts = (
                np.where(np.isfinite(dx) & np.isfinite(dy), last - first + 1, 0)
                .clip(0)
                .astype(np.intp)
            )
            line = np.repeat(np.arange(len(counts)), counts)  # the line of each dot
            nth = np.arange(len(line)) - np.repeat(np.cumsum(counts) - counts, counts)
            at = first[line] + nth
            share = np.nan_to_num((at + 0.5 - start[line]) / length[line]).clip(0, 1)
            right = np.where(steep[line], x[line] + share * dx[line], at)
            down = np.where(steep[line], at, y[line] + share * dy[line])
            self.scatter(right, down, ink)

    def disc(self, x: float, y: float, radius: float, ink: int, hollow: bool = False) -> None:
        """Set the dots within `radius` of the one at (x, y); `hollow`: only the rim."""
        if isfinite(x + y):
            layer = self._layer(ink)
            column, right = divmod(floor(x), 2)
            row, down = divmod(floor(y), 4)
            for across, below, bits in _disc(radius, hollow, right, down):
                if 0 <= column + across < self.columns and 0 <= row + below < self.rows:
                    layer[(row + below) * self.columns + column + across] |= bits

    def braille(self, lines: Iterable[str], ink: int) -> None:
        """Set the dots of braille characters, drawn elsewhere."""
        layer = self._layer(ink)
        for row, line in enumerate(lines):
            for column, character in enumerate(line):
                if "⠀" < character <= "⣿":
                    layer[row * self.columns + column] |= ord(character) & 0xFF

    def label(self, column: int, row: int, text: str, ink: int) -> None:
        """Write text over the dots from a cell on, cut off at the edges."""
        if 0 <= row < self.rows:
            for at, character in enumerate(text, column):
                if 0 <= at < self.columns:
                    self._letters[row * self.columns + at] = character, ink

    def is_free(self, column: int, row: int, columns: int = 1) -> bool:
        """Return whether some cells of a row are on the canvas and have no letter yet."""
        first = row * self.columns + column
        inside = 0 <= column <= self.columns - columns and 0 <= row < self.rows
        return inside and self._letters.keys().isdisjoint(range(first, first + columns))

    def label_where_blank(self, places: Iterable[tuple[int, int]], text: str, ink: int) -> bool:
        """Write text at the first of these cells where it covers nothing, if any."""
        for column, row in places:
            where = column, row, len(text)
            if self.is_free(*where) and not self.inks_at(*where):
                self.label(column, row, text, ink)
                return True
        return False

    def label_near(self, places: Iterable[tuple[int, int]], text: str, ink: int) -> None:
        """Write a letter at the first of these cells that is free, but not on other methods."""
        others = {each for each in self._layers if 0 <= each < FAINT and each != ink}
        second: tuple[int, int] | None = None
        for place in places:
            if self.is_free(*place):
                if others.isdisjoint(self.inks_at(*place)):
                    self.label(*place, text, ink)
                    return
                second = second or place
        if second is not None:
            self.label(*second, text, ink)

    def inks_at(self, column: int, row: int, columns: int = 1) -> set[int]:
        """Return the inks that have dots in some cells of a row, shown or not."""
        cell = row * self.columns + column
        return {ink for ink, layer in self._layers.items() if any(layer[cell : cell + columns])}

    def picture(self) -> Picture:
        dots, inks = self._shown()
        text, _ = codecs.charmap_decode(dots, "strict", _BRAILLE)
        pieces: list[str] = []
        end = 0
        for cell, (letter, ink) in sorted(self._letters.items()):
            pieces += text[end:cell], letter
            end = cell + 1
            inks[cell] = 0 if letter == " " else ink - NOBODY
        text = "".join([*pieces, text[end:]])
        colours = bytes(inks)
        width = self.columns
        begins = [width * row for row in range(self.rows)]
        return Picture(
            tuple([_row(text[at : at + width], colours[at : at + width]) for at in begins])
        )

    def _shown(self) -> tuple[bytearray, bytearray]:
        """Return the dots that are shown and their ink above NOBODY, by cell."""
        inks = sorted(ink for ink in self._layers if ink >= 0)
        methods = [ink for ink in inks if ink < FAINT]
        ranks = [methods, inks[len(methods) :]]
        ranks += [[ink] for ink in reversed(self._layers) if ink < 0]
        dots = 0
        colours = 0
        taken = 0
        disputed = 0
        for rank in ranks:
            owned, shared = self._turns(rank, ~taken)
            taken |= sum(owned.values())
            if rank is methods:
                disputed = shared
                owned = alone = {ink: cells & ~shared for ink, cells in owned.items()}
            for ink, cells in owned.items():
                layer = self._layers[ink]
                dots |= cells & ~shared & _number(layer)
                colours |= cells & _filled(len(layer), ink)
                if shared:
                    dots |= cells & shared & _number(layer.translate(_DOTTED))
        size = self.columns * self.rows
        all_dots = bytearray(dots.to_bytes(size, "little"))
        all_colours = bytearray(colours.to_bytes(size, "little"))
        if disputed:
            self._share(alone, disputed.to_bytes(size, "little"), all_dots, all_colours)
        return all_dots, all_colours

    def _turns(self, inks: Sequence[int], free: int) -> tuple[dict[int, int], int]:
        """Return the free cells that each ink gets, and those for which there are several.

        They are numbers with a full byte for a cell.  Inks of one cell take turns along the row.
        """
        owned: dict[int, int] = {}
        once = 0
        shared = 0
        for ink in inks:
            cells = _number(self._layers[ink].translate(_FULL)) & free
            won = cells
            if common := cells & once:
                half = _every(2, self.columns, self.rows) & ~shared
                third = _every(3, self.columns, self.rows) & shared
                won &= ~common | half | third
                owned = {other: its & ~won for other, its in owned.items()}
                shared |= common
            owned[ink] = won
            once |= cells
        return owned, shared

    def _share(
        self, alone: dict[int, int], shared: bytes, dots: bytearray, colours: bytearray
    ) -> None:
        """Give each shared cell to one of its methods, column by column from the left.

        One cell is enough to show a method in a column.  So a cell goes to a method that its
        column does not show yet, and if there are several, to the one that is shown in the
        smallest share of its columns.  A column still to come counts as 1/n of a column for each
        of the n methods that wait there for a cell.  So the shares end equal, but for a column,
        wherever methods share all their cells.  If the column shows all of them, they take turns.

        Lines at different heights of a shared cell become dotted: dashes that meet at their ends
        would look like the steps of one line.
        """
        columns = self.columns
        layers = {ink: self._layers[ink] for ink in alone}
        seen = {ink: self._columns_of(cells) for ink, cells in alone.items()}
        room = {ink: CELL * (columns - each.count(0)) for ink, each in seen.items()}
        parts = room.copy()
        disputes: list[tuple[int, list[int], list[int]]] = []
        for column, row in sorted(
            divmod(found.start(), columns)[::-1] for found in _FULL_CELLS.finditer(shared)
        ):
            cell = row * columns + column
            present = [ink for ink, layer in layers.items() if layer[cell]]
            waiting = [ink for ink in present if not seen[ink][column]]
            disputes.append((cell, present, waiting))
            for ink in waiting:
                room[ink] += CELL
                parts[ink] += CELL // len(waiting)
        for cell, present, waiting in disputes:
            row, column = divmod(cell, columns)
            ink = present[(column + 3 * row // 5) % len(present)]
            if unseen := [each for each in waiting if not seen[each][column]]:
                ink = min(unseen, key=lambda each: parts[each] / room[each])
                for each in waiting:
                    parts[each] -= CELL // len(waiting)
                parts[ink] += CELL
            seen[ink][column] = True
            colours[cell] = ink - NOBODY
            dots[cell] = layers[ink][cell]
            if len({layers[each][cell] for each in present}) > 1:
                dots[cell] = _DOTTED[dots[cell]]

    def _columns_of(self, number: int) -> bytearray:
        """Return a byte for each column of a layer, 0 where all its cells are."""
        rows = 1
        while rows < self.rows:  # the first row takes in twice as many below it
            number |= number >> (8 * self.columns * rows)
            rows *= 2
        return bytearray((number & (1 << 8 * self.columns) - 1).to_bytes(self.columns, "little"))


@lru_cache(maxsize=128)
def _disc(radius: float, hollow: bool, right: int, down: int) -> list[tuple[int, int, int]]:
    """Return the cells of a disc and its dots in each, from the cell that has its centre.

    The centre is so many dots to the right in its cell and down.
    """
    cells: dict[tuple[int, int], int] = {}
    least = 0.0
    if hollow:
        least = (radius - 1) ** 2
    for i, j in product(range(-floor(radius), floor(radius) + 1), repeat=2):
        if least <= i * i + j * j < radius * radius:
            across, x = divmod(right + i, 2)
            below, y = divmod(down + j, 4)
            cells[across, below] = cells.get((across, below), 0) | _BITS[2 * y + x]
    return [(*cell, bits) for cell, bits in cells.items()]


_FULL = bytes([0, *[255] * 255])
_FULL_CELLS = re.compile(rb"[^\0]")


@lru_cache(maxsize=16)
def _every(number: int, columns: int, rows: int) -> int:
    """Return a layer of each second or third cell of a row, at other columns in the next ones."""
    turns = ((column + 3 * row // 5) % number for row in range(rows) for column in range(columns))
    return _number(bytes([255 * (not turn) for turn in turns]))


@lru_cache(maxsize=256)
def _filled(size: int, ink: int) -> int:
    """Return a layer as one number, with this ink's number above NOBODY in each cell."""
    return _number(bytes([ink - NOBODY]) * size)


def _number(layer: bytes | bytearray) -> int:
    """Return a layer as one number, whose bits are combined much faster than bytes."""
    return int.from_bytes(layer, "little")


@lru_cache(maxsize=512)  # most rows are the same in the next frame
def _row(text: str, inks: bytes) -> Row:
    """Return a row in pieces of one ink."""
    return tuple(
        [
            (text[span.start() : span.end()], (span[1] or b"\0")[0] + NOBODY)
            for span in _SPANS.finditer(inks)
        ]
    )
