"""The rows of a history: the last ones as they were, those before merged into ever wider ones.

Memory does not grow with the run, and no extreme is lost.
"""

import math
from bisect import bisect_left, bisect_right
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.scenes import Scene

Floats = NDArray[np.float64]
Records = NDArray[np.void]


@dataclass(frozen=True, slots=True)
class Window:
    """A stretch of the past; rows in the order in which they were simulated."""

    x: Floats  # s, (n,): simulated time covered, which grows even while t goes back
    t: Floats  # s, (n,): simulated time
    low: dict[str, Floats]  # (n, methods): extremes since the previous row; nan if unknown
    high: dict[str, Floats]
    repeats: float  # s, the period of the errors: half a swing, a whole turn, or 0

    @property
    def turned(self) -> bool:
        return bool(len(self.x)) and not math.isclose(self.x[-1], self.t[-1], rel_tol=1e-9)

    def cut(self, begin: float, end: float) -> "Window":
        rows = (self.x >= begin) & (self.x <= end)
        low = {name: each[rows] for name, each in self.low.items()}
        high = {name: each[rows] for name, each in self.high.items()}
        return replace(self, x=self.x[rows], t=self.t[rows], low=low, high=high)


class Ghost:
    """The run before a restart, laid under the lab at the same simulated time."""

    def __init__(self, scene: Scene, label: str, window: Window, rows: Records) -> None:
        self.scene = scene
        self.label = label
        self._window = window
        self._thetas = rows["states"][:, :-1, 0]
        self.widest = float(abs(self._thetas).max(initial=0.0))
        """The largest angle that it comes to [rad]."""

    def rods(self, t: float) -> dict[str, float]:
        """Return the angles [rad] at a time [s] by method key."""
        row = int(np.searchsorted(self._window.x, t, "right")) - 1
        if not self.scene.equations.rigid or row < 0 or t > self._window.x[-1] + abs(self.scene.h):
            return {}
        keys = (method.key for method in self.scene.cast)
        return dict(zip(keys, self._thetas[row].tolist(), strict=True))

    def window(self, until: float, seconds: float | None = None) -> Window:
        """Return its errors up to a simulated time [s], of the last `seconds` or all."""
        back = (seconds or math.inf) + self._window.repeats
        return self._window.cut(until - back, until)


class Rows:
    """The rows of one run, in records with the fields of a `Row`; `capacity` is a power of 2."""

    def __init__(self, quantities: int, methods: int, capacity: int) -> None:
        extremes = (float, (quantities, methods))
        states = (float, (methods + 1, 2))
        row = [("step", int), ("since", int), ("x", float), ("t", float)]
        record = np.dtype([*row, ("states", *states), ("low", *extremes), ("high", *extremes)])
        self._recent = np.zeros(capacity, record)
        self._count = 0  # of recent rows
        self._wide = np.zeros(0, record)
        self._halvings = 0  # of the number of wide rows

    def append(self, row: tuple[Any, ...]) -> None:
        if self._count == len(self._recent):
            self._widen()
        self._recent[self._count] = row
        self._count += 1

    def _widen(self) -> None:
        """Merge the older half of the recent rows into wide ones."""
        half = len(self._recent) // 2
        leaving = self._recent[:half].copy()
        for _ in range(self._halvings):
            leaving = _halved(leaving)
        self._wide = np.concatenate([self._wide, leaving])
        if len(self._wide) > len(self._recent):
            self._wide = _halved(self._wide)
            self._halvings += 1
        self._recent[:half] = self._recent[half:]
        self._count -= half

    def truncate(self, step: int) -> int:
        """Drop the rows after a step (long ago, the whole wide row); return that of the last."""
        self._wide = _up_to(step, self._wide)
        self._count = len(_up_to(step, self._recent[: self._count]))
        kept = (self._wide, self._recent[: self._count])
        return max((int(rows["step"][-1]) for rows in kept if len(rows)), default=-1)

    def before(self, step: int) -> Records:
        """Return the recent rows before a step."""
        return self._recent[: bisect_left(self._recent["step"], step, hi=self._count)]

    def until(self, current: tuple[Any, ...]) -> Records:
        """Return the rows of the whole run up to the current sample."""
        wide = _up_to(current[0], self._wide)
        return np.concatenate([wide, self.recent_until(current)])

    def recent_until(self, current: tuple[Any, ...], most: int | None = None) -> Records:
        """Return the last rows, perhaps `most`, and the current sample if it is none of them."""
        step = current[0]
        rows = _up_to(step, self._recent[: self._count])
        if most is not None:
            rows = rows[-most:]
        last = rows[-1:] if len(rows) else _up_to(step, self._wide)[-1:]
        if step in last["step"]:
            return rows
        until = np.empty(len(rows) + 1, rows.dtype)
        until[:-1] = rows
        until[-1] = current
        return until


def _up_to(step: int, rows: Records) -> Records:
    return rows[: bisect_right(rows["step"], step)]  # NumPy's search would copy the steps


def _halved(rows: Records) -> Records:
    """Merge neighbours in pairs, but none across a change of h; an odd last row stays as it is."""
    pairs = len(rows) // 2 * 2
    first = rows[:pairs:2]
    last = rows[1:pairs:2]
    merged = last.copy()
    merged["low"] = np.fmin(first["low"], last["low"])
    merged["high"] = np.fmax(first["high"], last["high"])
    alone = first["since"] != last["since"]
    merged[alone] = last[alone]
    merged = np.insert(merged, np.flatnonzero(alone), first[alone])
    return np.concatenate([merged, rows[pairs:]])
