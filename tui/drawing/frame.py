"""Axes with round labels, the field between two of them, and the names of lines in it."""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.picture import FRAME, TEXT, Ink, Row

Floats = NDArray[np.float64]
Value = TypeVar("Value", float, Floats)


@dataclass(frozen=True, slots=True)
class Axis:
    """A range of numbers, and labels by value."""

    low: float
    high: float
    labels: dict[float, str]

    def share(self, value: Value) -> Value:
        """Return the position of a value, or of an array of them, from 0 to 1 on the axis."""
        return (value - self.low) / (self.high - self.low)

    @property
    def label_width(self) -> int:
        """Columns of the widest label; at least 5, or the chart would jump with each digit."""
        return max([5, *map(len, self.labels.values())])


def nice(value: float) -> float:
    """Return the smallest of 1, 2, 5, 10 times a power of ten that is not below the value."""
    if not value > 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= value * (1 - 1e-9))


_DECADES = sorted(
    {Fraction(n, d) for n in range(1, 6) for d in range(1, 17)} | {Fraction(12), Fraction(500)}
)
"""How many decades a row of characters may span."""
FEW_ROWS = 9


def log_axis(low: float, high: float, rows: int) -> Axis:
    """Return a vertical axis of log10 that covers low to high.

    It is the shortest with powers of ten at the middle of three rows, or of two if rows are few, or
    one dot beside it.
    """
    need = 3 if rows >= FEW_ROWS else 2
    for decades in _DECADES:
        size = float(decades)
        step = decades.numerator  # from a label to the next, which are two rows or more apart
        if decades.denominator == 1:
            step *= 2
        first = math.ceil(4 * high / size - 2)
        last = math.floor(4 * (low / size + rows) - 2)
        tops = [top for top in range(first, last + 1) if top % 4 != 2]
        for top in sorted(tops, key=lambda top: top % 4 != 0):
            axis = _centred(top / 4, size, step, rows)
            if len(axis.labels) >= need:
                return replace(axis, labels={each: _power(each) for each in axis.labels})
    raise AssertionError("no axis spans that many decades")


def _centred(top: float, row: float, step: float, rows: int) -> Axis:
    """Return an axis whose rows have multiples of `row` in the middle, `top` times it at the top.

    Multiples of `step` are labelled.
    """
    low = (top - rows + 0.5) * row
    high = (top + 0.5) * row
    return Axis(low, high, dict.fromkeys(_multiples(low, high, step), ""))


def log_x_axis(low: float, high: float, columns: int) -> Axis:
    """Return a horizontal axis of log10 with at most one label in 8 columns."""
    first = math.floor(low)
    last = max(math.ceil(high), first + 1)
    step = math.ceil((last - first) * 8 / columns)
    return Axis(first, last, {power: _power(power) for power in _multiples(first, last, step)})


def _power(exponent: float) -> str:
    return "1" + "0" * int(exponent) if 0 <= exponent <= 2 else f"1e{exponent:.0f}"


def linear_axis(low: float, high: float, rows: int) -> Axis:
    """Return a vertical axis from low to high or a little beyond, wider if they hardly differ.

    Labels are two to five rows apart.
    """
    least = max(1e-4 * abs(high), 1e-16)
    if high - low < least:
        low = low - least
        high = high + least
    power = 10.0 ** math.floor(math.log10((high - low) / rows))
    steps = [part * power for part in (5, 10, 20, 50)]
    most = 5 if rows >= 10 else 4  # or one label might stand alone
    sizes = sorted((step / apart, step) for step in steps for apart in range(2, most + 1))
    row, step = next(
        (row, step) for row, step in sizes if round(high / row) - round(low / row) < rows
    )
    axis = _centred(round(high / row), row, step, rows)
    return replace(axis, labels=_written(axis.labels, step))


def time_axis(start: float, end: float, columns: int, note: str = "") -> Axis:
    """Return an axis of seconds with labels in s, min or h about every 10 columns.

    The last label adds unit and note.
    """
    units = ((3600, "h"), (60, "min"))
    size, unit = next((each for each in units if end - start >= 5 * each[0]), (1, "s"))
    ticks = number_ticks(start / size, end / size, max(columns / 10, 1))
    labels = {value * size: text for value, text in ticks.items()}
    if labels:
        labels[max(labels)] += f" {unit}{note}"
    return Axis(start, end, labels)


_TIMES = (
    *((value, f"{value:g} s") for value in (0.01, 0.1, 1, 2, 5, 10, 20)),
    *((60 * value, f"{value} min") for value in (1, 2, 5, 10, 20)),
    *((3600 * value, f"{value} h") for value in (1, 2, 5, 10)),
    *((86400 * 10.0**power, f"1{'0' * power} d") for power in range(5)),
)


def log_time_axis(start: float, end: float, columns: int, note: str = "") -> Axis:
    """Return an axis of log10 of seconds, labelled in s, min, h or d every 8 columns or more."""
    low = math.log10(start)
    high = math.log10(end)
    labels: dict[float, str] = {}
    apart = 8 * (high - low) / columns
    for seconds, text in _TIMES:
        place = math.log10(seconds)
        if low <= place <= high and (not labels or place - max(labels) >= apart):
            labels[place] = text
    if len(labels) < 2:  # short, and so almost linear
        linear = time_axis(start, end, columns, note).labels
        labels = {math.log10(value): text for value, text in linear.items()}
    else:
        labels[max(labels)] += note
    return Axis(low, high, labels)


def number_ticks(low: float, high: float, most: float) -> dict[float, str]:
    """Return labels by position of about `most` numbers."""
    step = nice((high - low) / most)
    return _written(_multiples(low, high, step), step)


def theta_ticks(low: float, high: float, most: int) -> dict[float, str]:
    """Return labels by position of about `most` angles, in pi or, below pi/4 apart, in rad."""
    share = (high - low) / math.pi / most
    if share <= 0.1:
        return number_ticks(low, high, most)
    step = next((quarters / 4 for quarters in (1, 2, 4) if quarters / 4 >= share), nice(share))
    values = _multiples(low / math.pi, high / math.pi, step)
    return {value * math.pi: in_pi(value) for value in values}


def _multiples(low: float, high: float, step: float) -> list[float]:
    first = math.ceil(low / step - 1e-6)
    last = math.floor(high / step + 1e-6)
    return [number * step for number in range(first, last + 1)]


def _written(multiples: Iterable[float], step: float) -> dict[float, str]:
    """Write multiples of a step with the same decimals: "-0.10", "-0.08", "0"; or "-2e-7"."""
    decimals = -math.floor(math.log10(step))
    if 0 <= decimals <= 5:
        return {value: f"{value:.{decimals}f}" if value else "0" for value in multiples}
    texts = {value: f"{value:.6g}" for value in multiples}
    return {value: re.sub(r"e\+?(-?)0?", r"e\1", text) for value, text in texts.items()}


def in_pi(turns: float) -> str:
    """Write quarters of pi: "-pi", "3pi/4"."""
    if turns == 0:
        return "0"
    divisor = next(each for each in (1, 2, 4) if turns * each % 1 == 0)
    count = f"{turns * divisor:.0f}"
    over = "" if divisor == 1 else f"/{divisor}"
    return {"1": "", "-1": "-"}.get(count, count) + "pi" + over


ROOM = 4  # columns for letters on the right of the field
NAMED = 60, 8  # columns and rows of a chart from which on its lines have names


class End(NamedTuple):
    """The end of a line."""

    column: int  # after its last point
    rows: Floats  # (2, columns): the highest and lowest of the line in the field's columns
    letter: str
    name: str
    ink: int

    @property
    def row(self) -> float:
        """The row of its last point, from the top."""
        return float(self.rows[:, self.column - 1].mean()) - 0.5


class Frame:
    """Two axes at the left of a field and below it, with `room` for letters at its right."""

    def __init__(self, x_axis: Axis, y_axis: Axis, columns: int, rows: int, room: int = 0) -> None:
        self.x_axis = x_axis
        self.y_axis = y_axis
        self.columns = columns
        self.rows = rows
        self.width = columns + room
        self.left = y_axis.label_width + 1

    def right(self, x: Value) -> Value:
        """Return distances from the left edge of the field, in characters, at most its width."""
        share: Value = np.clip(self.x_axis.share(x), 0.0, 1.0)
        return self.columns * share

    def up(self, y: Value) -> Value:
        """Return distances from the lower edge of the field, in characters, at most its height."""
        share: Value = np.clip(self.y_axis.share(y), 0.0, 1.0)
        return self.rows * share

    def column(self, x: float) -> int:
        """Return the column of a value in the field."""
        return min(int(self.right(x)), self.columns - 1)

    def row(self, y: float) -> int:
        """Return the row of a value in the field."""
        return self.rows - 1 - min(int(self.up(y)), self.rows - 1)

    def around(self, field: Iterable[Row]) -> list[Row]:
        """Put the axes around the rows of the field, with labels on them."""
        labels = {self.row(value): text for value, text in self.y_axis.labels.items()}
        rows: list[Row] = []
        for at, row in enumerate(field):
            label = labels.get(at, "").rjust(self.left - 1)
            rows.append([(label, TEXT), ("┤" if at in labels else "│", FRAME), *row])
        below: list[tuple[str, Ink]] = [("└".rjust(self.left), FRAME)]
        end = 0
        for value, text in self.x_axis.labels.items():
            label = f" {text} "
            begin = self.column(value) - len(label) // 2
            begin = min(max(begin, 0), self.width - len(label))
            if begin >= end:
                below += ("─" * (begin - end), FRAME), (label, TEXT)
                end = begin + len(label)
        return [*rows, [*below, ("─" * (self.width - end), FRAME)]]


class LineChart(Frame):
    """A frame whose field is a canvas with lines, each with a letter at its end."""

    def __init__(self, x_axis: Axis, y_axis: Axis, columns: int, rows: int) -> None:
        super().__init__(x_axis, y_axis, columns, rows, room=ROOM)
        self.canvas = Canvas(self.width, rows)

    def framed(self) -> list[Row]:
        return self.around(self.canvas.picture().rows)

    def name_lines(self, ends: Iterable[End]) -> None:
        """Write each line's letter at its end and, where there is room, its name beside it.

        On few rows, letters of one row stand side by side, or they would be far from their lines.
        """
        ends = sorted(ends, key=lambda end: end.row)
        rows = spread([end.row for end in ends], self.rows)
        for end, row in zip(ends, rows, strict=True):
            near = [row]
            if self.rows < NAMED[1]:
                near = sorted(range(self.rows), key=lambda at: abs(at - end.row))
            across = range(end.column, end.column + ROOM)
            places = [(column, at) for at in near for column in across]
            self.canvas.label_where_blank(places, end.letter, end.ink)
        if self.left + self.width >= NAMED[0] and self.rows >= NAMED[1]:
            above = -1
            for end, row, below in zip(ends, rows, [*rows, self.rows][1:], strict=True):
                above = max(self._write_name(end, above, below), row)

    def _write_name(self, end: End, above: int, below: int) -> int:
        """Write a name near the end of its line, between two rows; return the row, or -1."""
        text = f" {end.name} "
        last = end.column - len(text)
        for begin in range(last - 1, 2 * self.columns // 3 - len(text), -1):
            beside = end.rows[:, max(begin, 0) : begin + len(text)]
            top = np.fmin.reduce(beside[0], initial=np.inf)
            if top < np.inf:
                over = range(int(top) - 1, above, -1)[:2]
                under = range(int(np.fmax.reduce(beside[1])) + 1, below)[:2]
                rows = [*under, *over] if len(under) > len(over) else [*over, *under]
                row: int
                for row in rows:
                    if self.canvas.label_where_blank([(begin, row)], text, end.ink):
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
    return math.floor(sum(group) / len(group) + 0.5)
