"""Canvas: points, lines and words as characters.

A canvas has 2×4 dots in every cell.  Coordinates are in dots, x to the right and y downwards from
the upper left corner; dot (i, j) covers [i, i+1) × [j, j+1).  Dots of several inks can share a
cell, which takes the ink drawn last.  Points outside or not finite are not drawn.
Pendulums have few dots: drawing them without NumPy is faster, and does not import it.
"""

import codecs
import copy
import re
from collections.abc import Iterable
from functools import lru_cache
from math import floor, isfinite
from typing import TYPE_CHECKING, Self

from pendu_tui.tui.drawing.palette import NOBODY
from pendu_tui.tui.drawing.picture import Picture, Row

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Numbers = NDArray[np.float64] | NDArray[np.intp]

_BITS = bytes(1 << place for place in (0, 3, 1, 4, 2, 5, 6, 7))
"""The bits of Unicode's braille for a cell's dots, row by row."""
_BRAILLE = " " + "".join(map(chr, range(0x2801, 0x2900)))
_SPANS = re.compile(rb"\0*([^\0])(?:\1|\0)*|\0+", re.DOTALL)
"""Cells of one ink and the blanks behind them, which look the same in any ink."""


class Canvas:
    """A drawing area of `columns` × `rows` cells."""

    def __init__(self, columns: int, rows: int) -> None:
        self.columns = columns
        self.rows = rows
        self.width = 2 * columns  # dots
        self.height = 4 * rows
        self._bits = bytearray(columns * rows)  # the dots of each cell
        self._inks = bytearray(columns * rows)  # above NOBODY
        self._letters: dict[int, tuple[str, int]] = {}  # by row * columns + column

    def copy(self) -> Self:
        copied = copy.copy(self)
        copied._bits = self._bits[:]
        copied._inks = self._inks[:]
        copied._letters = self._letters.copy()
        return copied

    def points(self, points: Iterable[tuple[float, float]], ink: int) -> None:
        columns = self.columns
        width = self.width
        height = self.height
        bits = self._bits
        inks = self._inks
        colour = ink - NOBODY
        for x, y in points:
            if 0 <= x < width and 0 <= y < height:
                i = int(x)
                j = int(y)
                cell = (j >> 2) * columns + (i >> 1)
                bits[cell] |= _BITS[(j & 3) << 1 | i & 1]
                inks[cell] = colour

    def scatter(self, x: "Numbers", y: "Numbers", ink: "int | NDArray[np.intp]") -> None:
        """Set the dots of arrays x and y; for many dots faster than `points`."""
        import numpy as np

        inside = (x >= 0) & (x < self.width) & (y >= 0) & (y < self.height)
        i = x[inside].astype(np.intp)
        j = y[inside].astype(np.intp)
        cells = (j >> 2) * self.columns + (i >> 1)
        dots = np.frombuffer(_BITS, np.uint8)[(j & 3) << 1 | i & 1]
        np.bitwise_or.at(np.frombuffer(self._bits, np.uint8), cells, dots)
        colours = np.broadcast_to(ink, x.shape)[inside] - NOBODY
        np.frombuffer(self._inks, np.uint8)[cells] = colours

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
        # the ends need not be in the middle of a dot
        shares = [(at + 0.5 - start) / (step or 1.0) for at in dots]
        if shares:
            shares[0] = min(max(shares[0], 0.0), 1.0)
            shares[-1] = min(max(shares[-1], 0.0), 1.0)
        along = zip(dots, shares, strict=True)
        if steep:
            self.points([(x0 + share * dx, at) for at, share in along], ink)
        else:
            self.points([(at, y0 + share * dy) for at, share in along], ink)

    def path(self, x: "Numbers", y: "Numbers", ink: int) -> None:
        """Join points with lines, but for points that are not finite."""
        import numpy as np

        with np.errstate(all="ignore"):
            if len(x) == 1:
                self.scatter(x, y, ink)
            dx = np.diff(x)
            dy = np.diff(y)
            steep = abs(dy) > abs(dx)  # these lines have a dot in each row, others in each column
            start = np.where(steep, y[:-1], x[:-1])
            length = np.where(steep, dy, dx)
            first = np.floor(np.minimum(start, start + length)).clip(0)
            last = np.floor(np.maximum(start, start + length))
            last = last.clip(max=np.where(steep, self.height, self.width) - 1)
            counts = np.where(np.isfinite(dx + dy), last - first + 1, 0).clip(0).astype(np.intp)
            line = np.repeat(np.arange(len(counts)), counts)  # the line of each dot
            nth = np.arange(len(line)) - np.repeat(np.cumsum(counts) - counts, counts)
            at = first[line] + nth
            share = np.nan_to_num((at + 0.5 - start[line]) / length[line]).clip(0, 1)
            right = np.where(steep[line], x[line] + share * dx[line], at)
            down = np.where(steep[line], at, y[line] + share * dy[line])
            self.scatter(right, down, ink)

    def disc(self, x: float, y: float, radius: float, ink: int, hollow: bool = False) -> None:
        """Set the dots within `radius` of (x, y); `hollow`: only the rim."""
        if not (-radius < x < self.width + radius and -radius < y < self.height + radius):
            return
        most = radius * radius
        least = -1.0
        if hollow and radius > 1:
            least = (radius - 1) ** 2
        columns = range(floor(x - radius), floor(x + radius) + 1)
        rows = range(floor(y - radius), floor(y + radius) + 1)
        across = [(i, (i + 0.5 - x) ** 2) for i in columns]
        along = [(j, (j + 0.5 - y) ** 2) for j in rows]
        dots = [(i, j) for j, down in along for i, right in across if least < right + down <= most]
        self.points(dots, ink)

    def label(self, column: int, row: int, text: str, ink: int) -> None:
        """Write text over the dots from a cell on, cut off at the edges."""
        if 0 <= row < self.rows:
            for at, character in enumerate(text, column):
                if 0 <= at < self.columns:
                    self._letters[row * self.columns + at] = character, ink

    def is_free(self, column: int, row: int) -> bool:
        """Return whether a cell is on the canvas and has no letter yet."""
        inside = 0 <= column < self.columns and 0 <= row < self.rows
        return inside and row * self.columns + column not in self._letters

    def label_where_blank(self, places: Iterable[tuple[int, int]], text: str, ink: int) -> bool:
        """Write text at the first of these cells where it covers nothing, if any."""
        for column, row in places:
            first = row * self.columns + column
            is_free = all(self.is_free(column + at, row) for at in range(len(text)))
            if is_free and not any(self._bits[first : first + len(text)]):
                self.label(column, row, text, ink)
                return True
        return False

    def ink_at(self, column: int, row: int) -> int:
        """Return the ink of a cell, NOBODY where it is blank."""
        cell = row * self.columns + column
        letter = self._letters.get(cell)
        return self._inks[cell] + NOBODY if letter is None else letter[1]

    def picture(self) -> Picture:
        text, _ = codecs.charmap_decode(self._bits, "strict", _BRAILLE)
        lettered = self._inks[:]
        pieces: list[str] = []
        end = 0
        for cell, (letter, ink) in sorted(self._letters.items()):
            pieces += text[end:cell], letter
            end = cell + 1
            lettered[cell] = 0 if letter == " " else ink - NOBODY
        text = "".join([*pieces, text[end:]])
        inks = bytes(lettered)
        rows = [slice(self.columns * row, self.columns * (row + 1)) for row in range(self.rows)]
        return Picture(tuple([_row(text[row], inks[row]) for row in rows]))


@lru_cache(maxsize=512)  # most rows are the same in the next frame
def _row(text: str, inks: bytes) -> Row:
    """Return a row in pieces of one ink."""
    return tuple(
        [
            (text[span.start() : span.end()], (span[1] or b"\0")[0] + NOBODY)
            for span in _SPANS.finditer(inks)
        ]
    )
