"""Few dots on a small pane, drawn anew with every frame: plain integers, kept for the touched cells only.

The same dots, owners and labels as on a Canvas, which is for many points at once: a NumPy call on a few
dozen numbers costs more than the numbers.
"""

from collections.abc import Iterable
from functools import cached_property
from math import floor

from tui.drawing.palette import NOBODY

ORDER = (0, 3, 1, 4, 2, 5, 6, 7)
"""The places of a cell's dots, taken row by row, among Unicode's bits of braille."""
_DOTS = tuple(1 << place for place in ORDER)
_BRAILLE = 0x2800
_OWNER = 21  # bits of a character; above them, its owner
_CODE = (1 << _OWNER) - 1


def disc(x: float, y: float, radius: float, hollow: bool) -> list[tuple[int, int]]:
    """The dots whose centres are within `radius` of (x, y); hollow: only the rim, one dot wide."""
    most, least = radius * radius, (radius - 1) ** 2 if hollow and radius > 1 else -1.0
    across = [(i, (i + 0.5 - x) ** 2) for i in range(floor(x - radius), floor(x + radius) + 2)]
    down = [(j, (j + 0.5 - y) ** 2) for j in range(floor(y - radius), floor(y + radius) + 2)]
    return [(i, j) for j, dy in down for i, dx in across if least < dx + dy <= most]


class Sketch:
    """Something to draw on, `columns` × `rows` cells large."""

    def __init__(self, columns: int, rows: int) -> None:
        self.columns, self.rows = columns, rows
        self.width, self.height = 2 * columns, 4 * rows  # dots
        self._cells: dict[int, int] = {}  # by row · columns + column: braille or a label's code, and the owner
        self._labels: dict[int, int] = {}

    def points(self, points: Iterable[tuple[float, float]], owner: int) -> None:
        """Set the dots at (x, y); nan is nowhere."""
        cells, columns, width, height = self._cells, self.columns, self.width, self.height
        mark = (owner - NOBODY << _OWNER) | _BRAILLE
        for x, y in points:
            if 0 <= x < width and 0 <= y < height:
                i, j = int(x), int(y)
                cell = (j >> 2) * columns + (i >> 1)
                cells[cell] = cells.get(cell, 0) & 0xFF | _DOTS[(j & 3) << 1 | i & 1] | mark

    def line(self, x0: float, y0: float, x1: float, y1: float, owner: int, dotted: bool = False) -> None:
        """A straight line: a dot in each column of dots, or row where it is steep; dotted: every third of them."""
        dx, dy = x1 - x0, y1 - y0
        steep = abs(dy) > abs(dx)
        start, end, step = (y0, y1, dy) if steep else (x0, x1, dx)
        first, last = floor(start), floor(end)
        sign, every = -1 if last < first else 1, 3 if dotted else 1
        if not step:
            self.points([(x0, y0)], owner)
            return
        shares = [(at + 0.5 - start) / step for at in range(first, last + sign, sign * every)]
        shares[0], shares[-1] = max(shares[0], 0.0), min(shares[-1], 1.0)  # what is between lies on the line
        self.points([(x0 + share * dx, y0 + share * dy) for share in shares], owner)

    def disc(self, x: float, y: float, radius: float, owner: int, hollow: bool = False) -> None:
        """Set the dots whose centres are within `radius` of (x, y); hollow: only the rim, one dot wide."""
        self.points(disc(x, y, radius, hollow), owner)

    def label(self, column: int, row: int, text: str, owner: int) -> None:
        """Write text from a cell on, over any dots; what does not fit is cut off."""
        for at, character in enumerate(text, column):
            if 0 <= at < self.columns and 0 <= row < self.rows:
                self._labels[row * self.columns + at] = owner - NOBODY << _OWNER | ord(character)

    def is_free(self, column: int, row: int) -> bool:
        """Whether a label may go to a cell: it is on the sketch and has none yet."""
        inside = 0 <= column < self.columns and 0 <= row < self.rows
        return inside and row * self.columns + column not in self._labels

    def row(self, y: int) -> list[tuple[str, int]]:
        """Row y from the left, as Picture.row; a blank belongs to the owner before it."""
        start, columns = y * self.columns, self.columns
        spans: list[tuple[str, int]] = []
        text, owner = "", NOBODY
        for value in map(self.cells.get, range(start, start + columns)):
            if value is None:
                text += " "
                continue
            whose = (value >> _OWNER) + NOBODY
            if whose != owner and text:
                spans.append((text, owner))
                text = ""
            text, owner = text + chr(value & _CODE), whose
        return [*spans, (text, owner)] if text else spans

    def changed_rows(self, before: "Sketch | None") -> list[int]:
        """The rows that differ from those of a sketch before; all of them where there is nothing to compare with."""
        if before is None or (before.columns, before.rows) != (self.columns, self.rows):
            return list(range(self.rows))
        return sorted({cell // self.columns for cell, _ in self.cells.items() ^ before.cells.items()})

    @cached_property
    def cells(self) -> dict[int, int]:
        """What has been drawn, once all has been, by row · columns + column."""
        return self._cells | self._labels

    @property
    def letters(self) -> Iterable[tuple[int, int, int]]:
        """Cell, code point and owner of all that has been drawn."""
        return ((cell, value & _CODE, (value >> _OWNER) + NOBODY) for cell, value in self.cells.items())
