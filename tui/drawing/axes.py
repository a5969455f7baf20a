"""Axes: ranges, round labels, and the part of a series in each column."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Ticks = list[tuple[float, str]]


@dataclass(frozen=True, slots=True)
class Axis:
    """A range of numbers, and labels by value."""

    low: float
    high: float
    labels: dict[float, str]

    def share(self, values: ArrayLike) -> Floats:
        """Return the positions of values along the axis, from 0 to 1, clipped."""
        shares = (np.asarray(values, np.float64) - self.low) / (self.high - self.low)
        return np.clip(shares, 0.0, 1.0)

    @property
    def label_width(self) -> int:
        """Columns of the widest label; at least 5, or the chart would jump with each digit."""
        return max([5, *map(len, self.labels.values())])


@dataclass(frozen=True, slots=True)
class Frame:
    """Two axes around a field of characters."""

    x_axis: Axis
    y_axis: Axis
    columns: int
    rows: int
    left: int  # the first column

    def right(self, x: ArrayLike) -> Floats:
        """Return distances from the left edge, in characters."""
        return self.columns * self.x_axis.share(x)

    def up(self, y: ArrayLike) -> Floats:
        """Return distances from the lower edge, in characters."""
        return self.rows * self.y_axis.share(y)

    def row(self, y: float) -> int:
        """Return the row of a value, from the top."""
        return max(self.rows - 1 - int(self.up(y)), 0)


def nice(value: float) -> float:
    """Return the smallest of 1, 2, 5, 10 times a power of ten that is not below the value."""
    if not value > 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= value * (1 - 1e-9))


_DECADES = (
    *(1 / 16, 1 / 12, 1 / 8, 1 / 6, 1 / 4, 1 / 3, 1 / 2, 2 / 3),
    *(1, 3 / 2, 2, 3, 4, 6, 12, 50, 200, 500),
)
"""How many decades a row of characters may span."""


def log_axis(low: float, high: float, rows: int) -> Axis:
    """Return a vertical axis of log10 from low to high, at least two decades long."""
    low = min(low, high - 2)
    size = next(size for size in _DECADES if round(high / size) - round(low / size) < rows)
    bottom = (round(high / size) + 0.5 - rows) * size
    top = (round(high / size) + 0.5) * size
    values = _multiples(bottom, top, math.ceil(2 * size))
    if len(values) < 2 and size >= 1:  # few rows: label each
        values = [top - (row + 0.5) * size for row in reversed(range(rows))]
    return Axis(bottom, top, {value: _power(value) for value in values})


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

    Its labels are equally spaced, two or more rows apart if possible.
    """
    least = max(1e-4 * max(abs(low), abs(high)), 1e-16)
    if high - low < least:
        low = low - least
        high = high + least
    power = 10.0 ** (math.floor(math.log10(high - low)) - 1)
    steps = [part * power for part in (1, 2, 5, 10, 20, 50, 100)]

    def rows_apart(step: float) -> int:
        top = math.ceil(high / step - 1e-9)
        return math.floor((rows - 1) * step / (top * step - low) + 1e-9)

    step = next(step for apart in (2, 1) for step in steps if rows_apart(step) >= apart)
    top = math.ceil(high / step - 1e-9) * step
    row = step / rows_apart(step)
    bottom = top - (rows - 0.5) * row
    labels = {value: _label(value, step) for value in _multiples(bottom, top, step)}
    return Axis(bottom, top + row / 2, labels)


def _label(value: float, step: float) -> str:
    decimals = max(-math.floor(math.log10(step) + 1e-9), 0)
    if decimals < 5:
        return f"{value:.{decimals}f}"
    return f"{value * 10.0**decimals:.0f}e-{decimals}" if value else "0"


def time_axis(start: float, end: float, columns: int, note: str = "") -> Axis:
    """Return an axis of seconds with labels in s, min or h about every 10 columns.

    The last label adds unit and note.
    """
    units = ((3600, "h"), (60, "min"))
    size, unit = next((each for each in units if end - start >= 5 * each[0]), (1, "s"))
    step = nice((end - start) / size / max(columns / 10, 1))
    values = _multiples(start / size, end / size, step)
    labels = {value * size: f"{value:.6g}" for value in values}
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
        labels = {math.log10(value): text for value, text in linear.items() if value > 0}
    else:
        labels[max(labels)] += note
    return Axis(low, high, labels)


def number_ticks(low: float, high: float, most: int) -> Ticks:
    """Return positions and labels of about `most` numbers."""
    values = _multiples(low, high, nice((high - low) / most))
    return [(value, compact(value)) for value in values]


def theta_ticks(low: float, high: float, most: int, wrap: bool) -> Ticks:
    """Return positions and labels of about `most` angles, in pi or, zoomed in, in rad."""
    share = (high - low) / math.pi / most
    if high - low <= 0.02 * math.pi:
        return number_ticks(low, high, most)
    step = nice(share)
    if 0.1 < share <= 1:
        step = next(quarters / 4 for quarters in (1, 2, 4) if quarters / 4 >= share)
    values = _multiples(low / math.pi, high / math.pi, step)
    return [(value * math.pi, in_pi(value, wrap)) for value in values]


def _multiples(low: float, high: float, step: float) -> list[float]:
    first = math.ceil(low / step - 1e-6)
    last = math.floor(high / step + 1e-6)
    return [number * step for number in range(first, last + 1)]


def compact(value: float) -> str:
    """Write a number in few characters: "0.5", "-2e-7"."""
    return f"{value:.6g}".replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


def in_pi(turns: float, wrap: bool = False) -> str:
    """Write a multiple of pi: "-pi", "3pi/4", "0.35pi"; `wrapped` to -pi to pi."""
    if wrap and abs(turns) > 1:
        turns = round(math.remainder(turns, 2), 12)
    if turns == 0:
        return "0"
    for divisor, over in ((1, ""), (2, "/2"), (4, "/4")):
        if turns * divisor % 1 == 0:
            count = f"{turns * divisor:.0f}"
            return {"1": "", "-1": "-"}.get(count, count) + "pi" + over
    return f"{compact(turns)}pi"


def time_span(x: Floats, seconds: float | None, columns: int) -> tuple[float, float]:
    """Return the first and last x; columns keep their moments while the window moves."""
    latest = float(x.max(initial=0.0))
    if seconds is None:
        unit = 10 ** math.floor(math.log10(max(latest, 1.0))) / 10
        return 0.0, max(math.ceil(latest / unit) * unit, 1.0)
    column = seconds / columns
    end = max(math.ceil(latest / column) * column, seconds)
    return end - seconds, end


def per_column(
    x: Floats, low: Floats, high: Floats, edges: Floats, hold: float = 0.0
) -> tuple[Floats, Floats]:
    """Return the lowest `low` and highest `high` in each column, or up to `hold` before it.

    x ascends; a column lies between two edges.  Returns (columns, series); nan where no row is, and
    in columns after the last row.
    """
    lows = np.full((len(edges) - 1, low.shape[1]), np.nan)
    highs = lows.copy()
    # a row on an edge belongs to the column on the right, however the edge is rounded
    slack = 1e-9 * np.diff(edges)
    begins = np.searchsorted(x, edges[:-1] - slack - hold)
    ends = np.searchsorted(x, edges[1:] - slack)
    ends[-1] = np.searchsorted(x, edges[-1], "right")
    begun = np.append(0, ends[:-1]) < len(x)
    filled = np.flatnonzero((ends > begins) & begun)
    if len(filled):
        pairs = np.stack([begins[filled], ends[filled]], axis=1).ravel()
        beyond = np.full((1, low.shape[1]), np.nan)  # an empty row for the end
        lows[filled] = np.fmin.reduceat(np.vstack([low, beyond]), pairs, axis=0)[::2]
        highs[filled] = np.fmax.reduceat(np.vstack([high, beyond]), pairs, axis=0)[::2]
    return lows, highs
