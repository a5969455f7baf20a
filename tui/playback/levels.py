"""The rows of a history, ready to be charted: extremes of ever more samples the older they are.

Level 0 holds the last samples as they were, each further level the lows and highs of pairs of rows
of the level below, all in rings of the same capacity.  So memory grows with the logarithm of the
run's length only: an hour at 60 samples a second takes eight levels.
"""

import itertools
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
        """What lies between two x [s]."""
        rows = (self.x >= begin) & (self.x <= end)
        low, high = (
            {name: each[rows] for name, each in side.items()} for side in (self.low, self.high)
        )
        return replace(self, x=self.x[rows], t=self.t[rows], low=low, high=high)


class Level:
    """A ring of rows, numbered from the run's start on; it holds [first, count)."""

    def __init__(self, stored: int, methods: int, capacity: int) -> None:
        shape = (capacity, stored, methods)
        self.capacity = capacity
        self.first = self.count = 0
        self.steps = np.zeros(capacity, np.int64)  # at the end of the row
        self.times = np.zeros((capacity, 2))  # x, t at the end of the row
        self.low, self.high = np.zeros(shape), np.zeros(shape)

    def slots(self, first: int, end: int) -> NDArray[np.intp]:
        """Where in the ring the rows [first, end) are, as far as it holds them."""
        return np.arange(max(first, self.first), max(end, self.first)) % self.capacity

    def append(
        self, step: int, times: tuple[float, float], low: ArrayLike, high: ArrayLike
    ) -> None:
        at = self.count % self.capacity
        self.steps[at], self.times[at], self.low[at], self.high[at] = step, times, low, high
        self._grow(1)

    def append_pairs(self, finer: "Level", first: int) -> None:
        """Add the merged pairs of the finer level's rows from `first` on."""
        a, b = finer.slots(first, finer.count).reshape(-1, 2).T
        at = (self.count + np.arange(len(a))) % self.capacity
        self.steps[at], self.times[at] = finer.steps[b], finer.times[b]
        self.low[at] = np.fmin(finer.low[a], finer.low[b])
        self.high[at] = np.fmax(finer.high[a], finer.high[b])
        self._grow(len(a))

    def _grow(self, rows: int) -> None:
        self.count += rows
        self.first = max(self.first, self.count - self.capacity)

    def cut(self, step: int, otherwise: int) -> None:
        """Forget the rows after `step`; where the ring begins later than that, be empty at row `otherwise`."""
        kept = int(np.searchsorted(self.steps[self.slots(0, self.count)], step, "right"))
        if kept or self.first == 0:
            self.count = self.first + kept
        else:
            self.first = self.count = otherwise


class Levels:
    """The rows of one run, with the STORED quantities and the `others` that its model has.

    Errors repeat after `repeats` [s]; `reference` is the start and the scale of energies.
    """

    def __init__(
        self,
        repeats: float,
        reference: tuple[float, float],
        others: Sequence[Quantity],
        methods: int,
        capacity: int,
    ) -> None:
        self._repeats, self._reference = repeats, reference
        self._stored, self._methods = (*STORED, *others), methods
        self.levels = [Level(len(self._stored), methods, capacity)]
        self._states = np.zeros(
            (capacity, methods + 1, 2)
        )  # next to level 0; the exact motion comes last

    def append(
        self,
        step: int,
        times: tuple[float, float],
        states: Sequence[State],
        low: ArrayLike,
        high: ArrayLike,
    ) -> None:
        """Add a sample's row: where it is, and the extremes of what is stored of each method since the row before."""
        finest = self.levels[0]
        self._states[finest.count % finest.capacity] = states
        finest.append(step, times, low, high)
        self._merge()

    def _merge(self) -> None:
        """Carry complete pairs of rows to the next level, and open one when the last ring is full."""
        for level, coarser in itertools.pairwise(self.levels):
            if level.count % 2:
                return
            coarser.append_pairs(level, level.count - 2)
        last = self.levels[-1]
        if last.count == last.capacity:
            self.levels.append(Level(len(self._stored), self._methods, last.capacity))
            self.levels[-1].append_pairs(last, 0)

    def rewind(self, step: int) -> None:
        """Forget what came after `step`.

        Where the finer levels do not reach back so far, up to one row of the finest that does is
        forgotten as well.
        """
        count = 0
        for level in reversed(self.levels):
            level.cut(step, otherwise=2 * count)
            count = level.count

    def latest(self) -> tuple[int, float, float] | None:
        """Step, x and t of the last row."""
        for level in self.levels:
            if level.count > level.first:
                at = (level.count - 1) % level.capacity
                return int(level.steps[at]), *level.times[at].tolist()
        return None

    def window(self, seconds: float | None = None) -> Window:
        """The last `seconds` of simulated time and half a swing before, or the whole run, in `capacity` rows or so.

        The finest level that reaches back so far, and after its last row those of the finer ones:
        every sample is in exactly one row.
        """
        latest = self.latest()
        start = (
            -math.inf if seconds is None or latest is None else latest[1] - seconds - self._repeats
        )
        depth = next(
            depth for depth, level in enumerate(self.levels) if self._reaches(level, start)
        )
        parts, first = [], 0
        for level in reversed(self.levels[: depth + 1]):
            parts.append((level, level.slots(first, level.count)))
            first = 2 * level.count
        times, low, high = (
            np.concatenate([getattr(level, name)[slots] for level, slots in parts])
            for name in ("times", "low", "high")
        )
        inside = times[:, 0] >= start
        times, low, high = times[inside], low[inside], high[inside]
        return Window(
            x=times[:, 0],
            t=times[:, 1],
            low=self._quantities(low),
            high=self._quantities(high),
            repeats=self._repeats,
            turned=bool(len(times)) and not math.isclose(times[-1, 0], times[-1, 1], rel_tol=1e-9),
        )

    def _quantities(self, rows: Floats) -> dict[Quantity, Floats]:
        stored: dict[Quantity, Floats] = {
            quantity: rows[:, i] for i, quantity in enumerate(self._stored)
        }
        start, scale = self._reference
        return {"energy": start + scale * stored["energy_error"], **stored}

    @staticmethod
    def _reaches(level: Level, start: float) -> bool:
        """Whether the level's rows reach back to x = start, or to the run's start."""
        return level.first == 0 or (
            level.count > level.first and level.times[level.first % level.capacity, 0] <= start
        )

    def trails(self, length: int) -> Floats:
        """theta [rad] and omega [rad/s] of every method and the exact motion at the last `length` samples.

        Of shape (samples, methods + 1, 2), oldest first.
        """
        level = self.levels[0]
        return self._states[level.slots(level.count - length, level.count)]
