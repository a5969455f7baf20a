"""Stretches of numbers with round labels, each in the middle of a row of characters or at a place in time."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Axis:
    """A stretch of numbers."""

    low: float
    high: float
    labels: dict[float, str]  # by the number they stand at

    def share(self, values: ArrayLike) -> Floats:
        """Where values lie on it, from 0 to 1; those outside at its ends."""
        return np.clip((np.asarray(values, np.float64) - self.low) / (self.high - self.low), 0.0, 1.0)

    @property
    def label_width(self) -> int:
        """Columns for the widest label; 5 at least, so that a chart does not jump with every digit."""
        return max([5, *map(len, self.labels.values())])


def decades(low: float, high: float, rows: int) -> Axis:
    """An axis of log10 with room for low and high, and for two decades at least."""
    top = math.ceil(high)
    return _ruled(min(math.floor(low), top - 2), top, rows, (1, 2, 3, 4, 6, 8, 12, 24, 100, 400, 1000), _power)


def decades_across(low: float, high: float, columns: int) -> Axis:
    """The same from left to right, with a label in 8 columns at most."""
    first, last = math.floor(low), max(math.ceil(high), math.floor(low) + 1)
    step = math.ceil((last - first) * 8 / columns)
    return Axis(first, last, {power: _power(power) for power in range(first, last + 1) if power % step == 0})


def _power(exponent: float, _: float = 1) -> str:
    return "1" + "0" * int(exponent) if 0 <= exponent <= 2 else f"1e{exponent:.0f}"


def linear(low: float, high: float, rows: int) -> Axis:
    """An axis from low to high, or around them where they hardly differ."""
    margin = max(1e-4 * max(abs(low), abs(high)), 1e-16)
    if high - low < margin:
        low, high = low - margin, high + margin
    power = math.floor(math.log10(high - low)) - 1

    def label(value: float, step: float) -> str:
        decimals = max(-math.floor(math.log10(step) + 1e-9), 0)
        if decimals < 5:
            return f"{value:.{decimals}f}"
        return f"{value * 10.0**decimals:.0f}e-{decimals}" if value else "0"

    return _ruled(low, high, rows, [part * 10.0**power for part in (1, 2, 5, 10, 20, 50, 100)], label)


def _ruled(low: float, high: float, rows: int, steps: Sequence[float], label: Callable[[float, float], str]) -> Axis:
    """An axis from low to high, or a little more, with labels equally many rows apart: two or more if possible."""

    def rows_apart(step: float) -> int:
        top = math.ceil(high / step - 1e-9)
        return math.floor((rows - 1) * step / (top * step - low) + 1e-9)

    step = next((step for step in steps if rows_apart(step) >= 2), None)
    step = step or next(step for step in steps if rows_apart(step) >= 1)
    top, row = math.ceil(high / step - 1e-9), step / rows_apart(step)
    bottom = top * step - (rows - 0.5) * row
    numbers = range(math.ceil(bottom / step), top + 1)
    return Axis(bottom, top * step + row / 2, {number * step: label(number * step, step) for number in numbers})


def times(start: float, end: float, columns: int, note: str = "") -> Axis:
    """An axis of seconds labelled in s, min or h about every 10 columns; the last label has the unit and the note."""
    size, unit = next(
        (size, unit) for size, unit in ((3600, "h"), (60, "min"), (1, "s")) if end - start >= 5 * size or size == 1
    )
    least = (end - start) / size / max(columns / 10, 1)
    decade = 10.0 ** math.floor(math.log10(least))
    step = next(part * decade for part in (1, 2, 5, 10) if part * decade >= least * (1 - 1e-9))
    numbers = range(math.ceil(start / size / step - 1e-9), math.floor(end / size / step + 1e-9) + 1)
    labels = {number * step * size: f"{number * step:.6g}" for number in numbers}
    if labels:
        labels[max(labels)] += f" {unit}{note}"
    return Axis(start, end, labels)
