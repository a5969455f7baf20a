"""Frame: two axes around a field of characters, and the names of lines at their ends."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from pendu_tui.tui.drawing.axes import Axis, Floats
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import FRAME, TEXT
from pendu_tui.tui.drawing.picture import Picture

ROOM = 4  # columns for letters on the right of the field
NAMED = 60, 8  # columns and rows of a chart from which on its lines have names


class End(NamedTuple):
    """The end of a line."""

    column: int  # after its last point
    row: float  # of its last point, from the top
    ink: int
    letter: str
    name: str
    rows: Floats  # (2, columns): the highest and lowest of the line in the field's columns


@dataclass(frozen=True, slots=True)
class Frame:
    """A canvas with two axes; `margin` rows are free above the field and below the labels."""

    canvas: Canvas
    x_axis: Axis
    y_axis: Axis
    margin: int = 0

    @property
    def left(self) -> int:
        return self.y_axis.label_width + 1

    @property
    def columns(self) -> int:
        return columns_beside(self.y_axis.label_width, self.canvas.columns)

    @property
    def rows(self) -> int:
        return self.canvas.rows - 2 - 2 * self.margin

    def right(self, x: ArrayLike) -> Floats:
        """Return distances from the left edge of the field, in characters."""
        return self.columns * self.x_axis.share(x)

    def up(self, y: ArrayLike) -> Floats:
        """Return distances from the lower edge of the field, in characters."""
        return self.rows * self.y_axis.share(y)

    def row(self, y: float) -> int:
        """Return the row of a value on the canvas."""
        return self.margin + max(self.rows - 1 - int(self.up(y)), 0)

    def draw_axes(self) -> None:
        canvas = self.canvas
        left = self.left
        bottom = self.margin + self.rows
        for row in range(self.margin, bottom):
            canvas.label(left - 1, row, "│", FRAME)
        canvas.label(left - 1, bottom, "└".ljust(self.columns + ROOM + 1, "─"), FRAME)
        for value, text in self.y_axis.labels.items():
            row = self.row(value)
            canvas.label(0, row, text.rjust(left - 1), TEXT)
            canvas.label(left - 1, row, "┤", FRAME)
        free = 0  # the first column after the previous label
        for value, text in self.x_axis.labels.items():
            column = left + min(int(self.right(value)), self.columns - 1)
            begin = min(column - (len(text) - 1) // 2, canvas.columns - len(text))
            if begin >= free:
                canvas.label(column, bottom, "┬", FRAME)
                canvas.label(begin, bottom + 1, text, TEXT)
                free = begin + len(text) + 1

    def name_lines(self, ends: Iterable[End]) -> None:
        """Write each line's letter at its end and, where there is room, its name beside it."""
        ends = sorted(ends, key=lambda end: end.row)
        rows = spread([end.row for end in ends], self.rows)
        for end, row in zip(ends, rows, strict=True):
            across = range(end.column, end.column + ROOM)
            self.canvas.label_where_blank([(at, row) for at in across], end.letter, end.ink)
        if self.canvas.columns >= NAMED[0] and self.rows >= NAMED[1]:
            above = -1
            for end, row, below in zip(ends, rows, [*rows, self.rows][1:], strict=True):
                above = max(self._write_name(end, above, below), row)

    def _write_name(self, end: End, above: int, below: int) -> int:
        """Write a name near the end of its line, between two rows; return the row, or -1."""
        text = f" {end.name} "
        last = end.column - self.left - len(text)
        for begin in range(last - 1, 2 * self.columns // 3 - len(text), -1):
            beside = end.rows[:, max(begin, 0) : begin + len(text)]
            top = np.fmin.reduce(beside[0], initial=np.inf)
            if top < np.inf:
                over = range(int(top) - 1, above, -1)[:2]
                under = range(int(np.fmax.reduce(beside[1])) + 1, below)[:2]
                rows = [*under, *over] if len(under) > len(over) else [*over, *under]
                row: int
                for row in rows:
                    if self.canvas.label_where_blank([(self.left + begin, row)], text, end.ink):
                        return row
        return -1


def columns_beside(label_width: int, width: int) -> int:
    """Return the columns of a field beside labels, the axis, and room for letters."""
    return width - label_width - 1 - ROOM


def spread(wanted: Sequence[float], room: int) -> list[int]:
    """Return a row for each of some ascending rows: their own or a near one, in the same order.

    Where there are more than `room` rows, neighbours share one.
    """
    groups: list[list[float]] = []  # neighbours that touch: where each wants the first one
    for number, row in enumerate(wanted):
        groups.append([row - number])
        while len(groups) > 1 and _mean(groups[-2]) > _mean(groups[-1]):
            groups[-2:] = [groups[-2] + groups[-1]]
    firsts = [_mean(group) for group in groups for _ in group]
    last = max(room - len(wanted), 0)
    rows = [min(max(first, 0), last) + number for number, first in enumerate(firsts)]
    return [min(row, row * room // len(wanted)) for row in rows]


def _mean(group: Sequence[float]) -> int:
    return round(sum(group) / len(group))


def too_small(width: int, height: int, columns: int, rows: int) -> Picture:
    return Picture.of_text(f"A chart needs {columns}×{rows} characters.", width, height, TEXT)
