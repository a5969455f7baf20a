"""The rows of a history: the last ones as they were, and the whole run in merged ones.

As a run gets longer, its rows are merged into ever wider ones, so memory does not grow.  Rows are
numbered from the start, and a wide row begins at a multiple of its width: what is merged depends on
the run alone.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pendu_tui.tui.playback.row import Row
from pendu_tui.tui.playback.shown import Quantity

Floats = NDArray[np.float64]
Records = NDArray[np.void]


@dataclass(frozen=True, slots=True)
class Window:
    """A stretch of the past; rows in the order in which they were simulated."""

    x: Floats  # s, (n,): simulated time covered, which grows even while t goes back
    t: Floats  # s, (n,): simulated time
    low: dict[Quantity, Floats]  # (n, methods): extremes since the previous row; nan if unknown
    high: dict[Quantity, Floats]
    repeats: float  # s, the period of the errors: half a swing, a whole turn, or 0

    @property
    def turned(self) -> bool:
        return bool(len(self.x)) and not math.isclose(self.x[-1], self.t[-1], rel_tol=1e-9)

    def cut(self, begin: float, end: float) -> "Window":
        rows = (self.x >= begin) & (self.x <= end)
        low = {name: each[rows] for name, each in self.low.items()}
        high = {name: each[rows] for name, each in self.high.items()}
        return replace(self, x=self.x[rows], t=self.t[rows], low=low, high=high)


class Rows:
    """The rows of one run; `capacity` is even."""

    def __init__(self, quantities: int, methods: int, capacity: int) -> None:
        extremes = (float, (quantities, methods))
        states = (float, (methods + 1, 2))
        row = [("step", int), ("x", float), ("t", float)]
        record = np.dtype([*row, ("states", *states), ("low", *extremes), ("high", *extremes)])
        self.count = 0
        self._capacity = capacity
        self._first = 0  # number of the first recent row
        self._width = 1  # rows merged into one
        self._recent = np.zeros(capacity, record)  # a ring buffer
        self._whole = np.zeros(capacity, record)

    def append(self, row: Row) -> None:
        self._recent[self.count % self._capacity] = row
        if self.count == self._capacity * self._width:
            merged = _merged(self._whole[::2], self._whole[1::2])
            self._whole[: len(merged)] = merged
            self._width *= 2
        self._add_to_whole(self.count)
        self.count += 1
        self._first = max(self._first, self.count - self._capacity)

    def _add_to_whole(self, number: int) -> None:
        row = self._recent[[number % self._capacity]]
        wide = self._whole[number // self._width :][:1]
        if number % self._width:
            row = _merged(wide, row)
        wide[:] = row

    def truncate(self, step: int) -> None:
        """Drop the rows after a step; long ago, the whole wide row."""
        number = self.number_after(step)
        begin = number - number % self._width
        if begin < self._first:
            number = begin
        self._first = min(self._first, number)
        self.count = number
        for each in range(begin, number):
            self._add_to_whole(each)

    @property
    def recent(self) -> Records:
        return self._recent[self._slots(self._first, self.count)]

    def number_after(self, step: int) -> int:
        """Return the number of the first row after a step; long ago, of its wide row."""
        if step >= self.last_step(self.count):
            return self.count
        recent = self._recent["step"][self._slots(self._first, self.count)]
        number = self._first + int(np.searchsorted(recent, step, "right"))
        if number > self._first or not self._first:
            return number
        steps = self._whole["step"][: self._first // self._width]
        return int(np.searchsorted(steps, step, "right")) * self._width

    def last_step(self, number: int) -> int:
        if number > self._first:
            return int(self._recent["step"][(number - 1) % self._capacity])
        if not number:
            return -1
        return int(self._whole["step"][(number - 1) // self._width])

    def until(self, current: Row) -> Records:
        """Return the rows of the whole run up to the current sample.

        The wide rows end where the recent ones begin, so every sample is in one row.
        """
        until = self.number_after(current.step)
        wide = min(-(-self._first // self._width), until // self._width)
        begin = max(wide * self._width, self._first)
        if begin > wide * self._width and until == self.count:
            wide += 1  # the one that has just begun
            begin = until
        recent = self._recent[self._slots(begin, until)]
        return np.concatenate([self._whole[:wide], recent, self._between(current, until)])

    def trails(self, current: Row, length: int) -> Floats:
        """Return the last states up to the current sample, (rows, methods + 1, 2)."""
        until = self.number_after(current.step)
        slots = self._slots(max(until - length, self._first), until)
        last = self._between(current, until)["states"]
        return np.concatenate([self._recent["states"][slots], last])[-length:]

    def _between(self, current: Row, until: int) -> Records:
        """Return the current sample as a row, unless row `until` - 1 is at its step."""
        rows = [current]
        if self.last_step(until) == current.step:
            rows = []
        return np.array(rows, self._recent.dtype)

    def _slots(self, begin: int, end: int) -> NDArray[np.intp]:
        return np.arange(begin, max(begin, end)) % self._capacity


def _merged(first: Records, last: Records) -> Records:
    rows = last.copy()
    rows["low"] = np.fmin(first["low"], last["low"])
    rows["high"] = np.fmax(first["high"], last["high"])
    return rows
