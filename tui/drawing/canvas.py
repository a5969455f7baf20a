"""Points and lines -> characters.

A canvas has 2×4 dots in every cell.  Coordinates are in dots, x to the right and y downwards from
the upper left corner; dot (i, j) covers [i, i+1) × [j, j+1).  Dots of several owners can share a cell,
which has the colour of the last one drawn.  Points outside or not finite are not drawn.
"""

import copy
import itertools
import textwrap
from array import array
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tui.drawing.palette import NOBODY
from tui.drawing.sketch import ORDER, Sketch, disc

Span = tuple[str, int]
"""Adjacent characters with the same owner."""

_ORDER = np.array(ORDER)
_BLANK = ord(" ")
_GLYPHS = np.array([ord(" "), *range(0x2801, 0x2900)], np.uint32)


def _grown(bits: int) -> int:
    """The dots of a braille cell, each as wide as the cell and two rows high."""
    rows = (0x09, 0x12, 0x24, 0xC0)  # two dots each, from the top
    neighbours = (*rows[1:], rows[2])
    return sum({dots for row, other in zip(rows, neighbours, strict=True) if bits & row for dots in (row, other)})


_THICK = np.array([0x2800 + _grown(bits) for bits in range(256)], np.uint32)


@dataclass(frozen=True, slots=True)
class Picture:
    """Characters and their owners, ready for a screen."""

    characters: NDArray[np.uint32]  # code points, (rows, columns)
    owners: NDArray[np.int8]  # (rows, columns)

    def row(self, y: int) -> list[Span]:
        """The spans of row y, from the left; blanks belong to the span before them, or to the first one."""
        codes = self.characters[y]
        text = codes.astype("<u4", copy=False).tobytes().decode("utf-32-le")
        there = (codes != _BLANK).nonzero()[0]
        if not len(there):
            return [(text, NOBODY)] if text else []
        owners = self.owners[y][there]
        turns = (owners[1:] != owners[:-1]).nonzero()[0] + 1
        starts = [0, *there[turns].tolist(), len(text)]
        whose = [int(owners[0]), *owners[turns].tolist()]
        return [(text[start:end], owner) for (start, end), owner in zip(itertools.pairwise(starts), whose, strict=True)]

    @property
    def text(self) -> str:
        """The characters alone, one line per row, without trailing blanks."""
        return "\n".join("".join(text for text, _ in self.row(y)).rstrip() for y in range(len(self.characters)))

    def write(self, row: int, column: int, text: str, owner: int) -> None:
        """Replace characters, beginning at a cell; text beyond the edges is cut off."""
        for at, character in enumerate(text, column):
            if 0 <= at < self.characters.shape[1]:
                self.characters[row, at], self.owners[row, at] = ord(character), owner

    @classmethod
    def stacked(cls, *pictures: "Picture") -> "Picture":
        """Pictures of one width, one below the other."""
        return cls(
            np.concatenate([picture.characters for picture in pictures]),
            np.concatenate([picture.owners for picture in pictures]),
        )

    def thick(self) -> "Picture":
        """The picture with thick lines; words stay as they are."""
        codes = self.characters
        return Picture(np.where(codes & ~np.uint32(0xFF) == 0x2800, _THICK[codes & 0xFF], codes), self.owners)

    @classmethod
    def of_sketch(cls, sketch: Sketch) -> "Picture":
        """The same as a picture."""
        picture = Canvas(sketch.columns, sketch.rows).picture()
        for cell, code, owner in sketch.letters:
            at = divmod(cell, sketch.columns)
            picture.characters[at], picture.owners[at] = code, owner
        return picture

    def changed_rows(self, before: "Picture | None") -> list[int]:
        """The rows that differ from those of a picture before; all of them where there is nothing to compare with."""
        if before is None or before.characters.shape != self.characters.shape:
            return list(range(len(self.characters)))
        changed = (before.characters != self.characters) | (before.owners != self.owners)
        return np.flatnonzero(changed.any(axis=1)).tolist()

    @classmethod
    def of_text(cls, text: str, columns: int, rows: int, owner: int) -> "Picture":
        """A text wrapped and centred; lines that do not fit are cut off."""
        lines = textwrap.wrap(text, max(columns, 1))[:rows]
        canvas = Canvas(columns, rows)
        for row, line in enumerate(lines, (rows - len(lines)) // 2):
            canvas.label((columns - len(line)) // 2, row, line, owner)
        return canvas.picture()


class Canvas:
    """A drawing area of `columns` × `rows` cells."""

    def __init__(self, columns: int, rows: int) -> None:
        self.columns, self.rows = columns, rows
        self.width, self.height = 2 * columns, 4 * rows  # dots
        self._dots = bytearray(8 * rows * columns)  # cell by cell, in Unicode's order
        self._owners = array("b", [NOBODY]) * (rows * columns)
        self._labels: dict[tuple[int, int], tuple[str, int]] = {}  # (row, column) -> character, owner

    def copy(self) -> "Canvas":
        """The same dots, to draw more on; labels are not copied."""
        copied = copy.copy(self)
        copied._dots, copied._owners, copied._labels = self._dots[:], self._owners[:], {}
        return copied

    def points(self, x: ArrayLike, y: ArrayLike, owner: ArrayLike) -> None:
        """Set the dots at x, y (numbers or arrays of one shape); `owner` is one, or one for each."""
        with np.errstate(invalid="ignore"):
            i = np.floor(np.atleast_1d(np.asarray(x, np.float64)))
            j = np.floor(np.atleast_1d(np.asarray(y, np.float64)))
            inside = (i >= 0) & (i < self.width) & (j >= 0) & (j < self.height)
        i, j = i[inside].astype(np.intp), j[inside].astype(np.intp)
        cells = (j >> 2) * self.columns + (i >> 1)
        np.frombuffer(self._dots, np.uint8)[8 * cells + _ORDER[(j & 3) << 1 | i & 1]] = 1
        np.frombuffer(self._owners, np.int8)[cells] = owner[inside] if isinstance(owner, np.ndarray) else owner

    def line(self, x: ArrayLike, y: ArrayLike, owner: ArrayLike, dotted: bool = False) -> None:
        """Join the points x, y (arrays of n) with straight lines, broken where a point is not finite.

        `owner` is one, or an array of n with that of the line from each point on.
        """
        i, j, segment = _along(np.asarray(x, np.float64), np.asarray(y, np.float64), self.width, self.height)
        every = 3 if dotted else 1
        self.points(i[::every], j[::every], owner[segment][::every] if isinstance(owner, np.ndarray) else owner)

    def disc(self, x: float, y: float, radius: float, owner: int, hollow: bool = False) -> None:
        """Set the dots whose centres are within `radius` of (x, y); hollow: only the rim, one dot wide."""
        if abs(x) < 1e6 and abs(y) < 1e6:  # not elsewhere, and finite
            for i, j in disc(x, y, radius, hollow):  # so few, that NumPy would take longer
                if (dot := self.dot(i, j)) is not None:
                    self.put(dot, True, owner)

    def dot(self, x: float, y: float) -> int | None:
        """The number of the dot at x, y, eight to a cell; None outside."""
        if 0 <= x < self.width and 0 <= y < self.height:
            i, j = int(x), int(y)
            return 8 * ((j >> 2) * self.columns + (i >> 1)) + ORDER[(j & 3) << 1 | i & 1]
        return None

    def at(self, dot: int) -> tuple[bool, int]:
        """Whether a dot is set, and the owner of its cell."""
        return self._dots[dot] == 1, self._owners[dot >> 3]

    def put(self, dot: int, on: bool, owner: int) -> None:
        """Set a dot or take it away, and give its cell an owner."""
        self._dots[dot], self._owners[dot >> 3] = on, owner

    def label(self, column: int, row: int, text: str, owner: int) -> None:
        """Write text over any dots, beginning at a cell; text beyond the edges is cut off."""
        for at, character in enumerate(text, column):
            if 0 <= at < self.columns and 0 <= row < self.rows:
                self._labels[row, at] = character, owner

    def is_free(self, column: int, row: int) -> bool:
        """Whether a cell is on the canvas and has no label yet."""
        return 0 <= column < self.columns and 0 <= row < self.rows and (row, column) not in self._labels

    def picture(self) -> Picture:
        """The characters and owners drawn so far."""
        bits = np.packbits(np.frombuffer(self._dots, np.uint8), bitorder="little")
        shape = self.rows, self.columns
        characters = _GLYPHS[bits].reshape(shape)
        owners = np.frombuffer(self._owners, np.int8).reshape(shape).copy()
        for place, (character, owner) in self._labels.items():
            characters[place], owners[place] = ord(character), owner
        return Picture(characters, owners)


def _all_inside(values: NDArray[np.float64], size: int) -> bool:
    """Whether nothing is outside [0, size), which is clear at once from the extremes."""
    return bool(np.fmin.reduce(values, initial=0.0) >= 0 and np.fmax.reduce(values, initial=0.0) < size)


def _along(
    x: NDArray[np.float64], y: NDArray[np.float64], width: int, height: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]:
    """Points along the visible part of a polyline: one per column of dots, or per row where it is steep."""
    with np.errstate(all="ignore"):
        x0, y0, dx, dy = x[:-1], y[:-1], np.diff(x), np.diff(y)
        # Liang and Barsky (1984): the part [first, last] of each segment that is inside, as fractions of it.
        first, last = np.zeros(len(dx)), np.ones(len(dx))
        sides = ((x0, dx, width), (y0, dy, height))
        for start, step, size in () if _all_inside(x, width) and _all_inside(y, height) else sides:
            low, high = np.sort([-start / step, (size - start) / step], axis=0)
            level, inside = step == 0, (start >= 0) & (start < size)
            first = np.maximum(first, np.where(level, np.where(inside, 0.0, 2.0), low))
            last = np.minimum(last, np.where(level, 1.0, high))
        drawn = (first <= last) & np.isfinite(dx) & np.isfinite(dy)
        x0, y0, dx, dy, first, last = (part[drawn] for part in (x0, y0, dx, dy, first, last))
        steep = abs(dy) > abs(dx)
        start, step = np.where(steep, y0, x0), np.where(steep, dy, dx)
        begin, end = np.floor(start + first * step), np.floor(start + last * step)
        # From very far away, rounding could ask for more points than the canvas has dots.
        counts = np.minimum(abs(end - begin) + 1, max(width, height) + 2).astype(np.intp)
        segment = np.repeat(np.arange(len(counts)), counts)
        nth = np.arange(len(segment)) - np.repeat(np.cumsum(counts) - counts, counts)
        centre = begin[segment] + np.sign(step)[segment] * nth + 0.5
        share = np.where(step[segment] == 0, 0.0, np.clip((centre - start[segment]) / step[segment], 0.0, 1.0))
        x, y = x0[segment] + share * dx[segment], y0[segment] + share * dy[segment]
        return x, y, np.flatnonzero(drawn)[segment]
