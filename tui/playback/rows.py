"""The rows of a history: the last ones as they were, and the whole run in ever wider ones.

Rows are numbered from the run's start on, and a wide row always begins at a multiple of its width.
So what is merged depends on the run alone, and memory does not grow.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.models.model import State
from tui.playback.shown import Quantity

STORED: tuple[Quantity, ...] = ("energy_error", "theta_error", "shadow_error")  # of every model

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Window:
    """A stretch of the past; rows in the order in which they were simulated."""

    x: Floats  # s, (n,): simulated time run through, which goes up even while t goes down
    t: Floats  # s, (n,): simulated time
    low: dict[Quantity, Floats]  # (n, methods): extremes since the row before; nan where not known
    high: dict[Quantity, Floats]
    repeats: float  # s, after which errors repeat: half a swing, a whole turn, or 0
    turned: bool  # whether time has run backwards, so that x is not t

    def cut(self, begin: float, end: float) -> "Window":
        """Return what lies between two x [s]."""
        rows = (self.x >= begin) & (self.x <= end)
        low = {name: each[rows] for name, each in self.low.items()}
        high = {name: each[rows] for name, each in self.high.items()}
        return replace(self, x=self.x[rows], t=self.t[rows], low=low, high=high)


@dataclass(frozen=True, slots=True)
class Row:
    """A sample's place, and each method's extremes since the row before."""

    step: int
    times: tuple[float, float]  # s: x and t
    states: Sequence[State]  # of the methods; the exact motion comes last
    low: ArrayLike  # (stored, methods)
    high: ArrayLike


class _Block:
    """Arrays of rows."""

    def __init__(self, capacity: int, stored: int, methods: int) -> None:
        self.steps = np.zeros(capacity, np.int64)  # at the end of the row
        self.times = np.zeros((capacity, 2))  # x and t there
        self.low = np.zeros((capacity, stored, methods))
        self.high = np.zeros((capacity, stored, methods))

    def put(self, at: int, row: Row) -> None:
        self.steps[at] = row.step
        self.times[at] = row.times
        self.low[at] = row.low
        self.high[at] = row.high

    def widen(self, at: int, row: Row) -> None:
        """Extend a row to the end of another one."""
        self.steps[at] = row.step
        self.times[at] = row.times
        self.low[at] = np.fmin(self.low[at], row.low)
        self.high[at] = np.fmax(self.high[at], row.high)

    def merge_pairs(self) -> None:
        """Make half as many rows of all rows."""
        half = len(self.steps) // 2
        self.steps[:half] = self.steps[1::2]
        self.times[:half] = self.times[1::2]
        self.low[:half] = np.fmin(self.low[::2], self.low[1::2])
        self.high[:half] = np.fmax(self.high[::2], self.high[1::2])


class Rows:
    """The rows of one run, with the STORED quantities and the `others` that its model has.

    Errors repeat after `repeats` [s]; `reference` is the start and the scale of energies.  The
    `capacity` is even.
    """

    def __init__(
        self,
        repeats: float,
        reference: tuple[float, float],
        others: Sequence[Quantity],
        methods: int,
        capacity: int,
    ) -> None:
        self.count = 0
        self._repeats = repeats
        self._reference = reference
        self._stored = (*STORED, *others)
        self._capacity = capacity
        self._first = 0  # of the recent rows
        self._width = 1  # recent rows in one of the whole run
        self._recent = _Block(capacity, len(self._stored), methods)  # a ring
        self._whole = _Block(capacity, len(self._stored), methods)
        self._states = np.zeros((capacity, methods + 1, 2))  # of the recent rows

    def append(self, row: Row) -> None:
        at = self.count % self._capacity
        self._recent.put(at, row)
        self._states[at] = row.states
        if self.count == self._capacity * self._width:
            self._whole.merge_pairs()
            self._width *= 2
        self._add_to_whole(self.count, row)
        self.count += 1
        self._first = max(self._first, self.count - self._capacity)

    def _add_to_whole(self, number: int, row: Row) -> None:
        if number % self._width:
            self._whole.widen(number // self._width, row)
        else:
            self._whole.put(number // self._width, row)

    def number_after(self, step: int) -> int:
        """Return the number of the first row after a step; of old steps, that of their wide row."""
        recent = self._recent.steps[self._slots(self._first, self.count)]
        number = self._first + int(np.searchsorted(recent, step, "right"))
        if number > self._first or not self._first:
            return number
        steps = self._whole.steps[: self._first // self._width]
        return int(np.searchsorted(steps, step, "right")) * self._width

    def truncate(self, step: int) -> None:
        """Forget what came after a step, or a little more where it is long ago."""
        number = self.number_after(step)
        begin = number - number % self._width
        if begin < self._first:
            number = begin
        self._first = min(self._first, number)
        self.count = number
        if number == begin:
            return
        for each in range(begin, number):
            at = each % self._capacity
            recent = self._recent
            times = (float(recent.times[at, 0]), float(recent.times[at, 1]))
            step = int(recent.steps[at])
            self._add_to_whole(each, Row(step, times, (), recent.low[at], recent.high[at]))

    def times_before(self, number: int) -> tuple[int, float, float]:
        """Return step, x and t of the last row before a number > 0."""
        if number > self._first:
            block = self._recent
            at = (number - 1) % self._capacity
        else:
            block = self._whole
            at = (number - 1) // self._width
        x, t = block.times[at].tolist()
        return int(block.steps[at]), x, t

    def window(self, until: int, current: Row | None, start: float) -> Window:
        """Return the rows before number `until` from x = start [s] on, and the current one.

        The whole run's rows end where the recent ones begin: every sample is in exactly one row.
        """
        wide = min(-(-self._first // self._width), until // self._width)
        begin = max(wide * self._width, self._first)
        if begin > wide * self._width and until == self.count:
            wide += 1  # which has just begun
            begin = until
        slots = self._slots(begin, until)
        last = _Block(0, len(self._stored), self._states.shape[1] - 1)
        if current is not None:
            last = _Block(1, len(self._stored), self._states.shape[1] - 1)
            last.put(0, current)

        def joined(name: str) -> Floats:
            old = getattr(self._whole, name)[:wide]
            return np.concatenate([old, getattr(self._recent, name)[slots], getattr(last, name)])

        times = joined("times")
        inside = times[:, 0] >= start
        times = times[inside]
        return Window(
            x=times[:, 0],
            t=times[:, 1],
            low=self._quantities(joined("low")[inside]),
            high=self._quantities(joined("high")[inside]),
            repeats=self._repeats,
            turned=bool(len(times)) and not math.isclose(times[-1, 0], times[-1, 1], rel_tol=1e-9),
        )

    def trails(self, until: int, length: int) -> Floats:
        """Return theta [rad] and omega [rad/s] of every method and the exact motion, oldest first.

        Of the last rows before number `until`, (rows, methods + 1, 2).
        """
        return self._states[self._slots(max(until - length, self._first), until)]

    def thetas(self) -> tuple[Floats, Floats]:
        """Return x [s] and theta [rad] of the recent rows, nan once a method has failed."""
        slots = self._slots(self._first, self.count)
        failed = ~np.isfinite(self._recent.high[slots, 0])
        return self._recent.times[slots, 0], np.where(failed, np.nan, self._states[slots, :-1, 0])

    def _slots(self, begin: int, end: int) -> NDArray[np.intp]:
        return np.arange(begin, max(begin, end)) % self._capacity

    def _quantities(self, rows: Floats) -> dict[Quantity, Floats]:
        stored: dict[Quantity, Floats] = {
            quantity: rows[:, i] for i, quantity in enumerate(self._stored)
        }
        start, scale = self._reference
        return {"energy": start + scale * stored["energy_error"], **stored}
