"""The past of a run: rows for a chart, trails for a portrait.

A row is a sample at a fixed step of the run, so that neither depends on the frame rate.  The sample
of a frame is the last point of both, and leaves with the frame.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from engine.models.model import State
from engine.run.lockstep import Sample
from engine.scenes import Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tui.playback.rows import Row, Rows, Window  # NumPy can wait for the first paint

MAX_WAITING = 64  # rows that are shown without NumPy
_UNKNOWN = State(math.nan, math.nan)


class _Taken(NamedTuple):
    sample: Sample
    x: float  # s, simulated time run through
    exact: State
    modified: Sequence[float]


class ErrorHistory:
    """The past of one run, up to the last sample added."""

    def __init__(self, scene: Scene, capacity: int = 4096) -> None:
        exact = scene.exact()
        model = scene.equations
        self._reference = model.reference(scene.theta, scene.omega)
        self._methods = len(scene.cast)
        self._energy = [] if model.energy_error.conserved else ["energy"]
        self._extra = [each.name for each in model.quantities()]
        self._theta_error = model.theta_error
        self._repeats = (exact.period or 0.0) / (2 if exact.regime == "libration" else 1)
        self._capacity = capacity
        self._run = 0
        self._latest: tuple[int, float, float] | None = None  # step, x and t of the last row
        self._now: _Taken | None = None
        self._is_behind = False  # the sample lies before the last row
        self._waiting: list[_Taken] = []
        self._rows: Rows | None = None
        self._returned: Sample | None = None
        self._trails: tuple[_Taken | None, int, NDArray] | None = None  # type: ignore[type-arg]

    def add(
        self,
        sample: Sample,
        exact: State | None = None,
        modified: Sequence[float] | None = None,
        is_row: bool = True,
    ) -> None:
        """Add a sample, the exact motion at its time, and the errors of the modified energies.

        An earlier one leaves the rows after it for the way forward.  One of another run takes back
        everything from its step on: that run goes on from this one's past.
        """
        if sample.run != self._run and self._latest is not None:
            self._truncate(sample.step - 1)
        self._run = sample.run
        latest = self._latest
        self._is_behind = latest is not None and sample.step < latest[0]
        is_new = latest is None or sample.step > latest[0]
        x = self._x(sample)
        known = modified or [math.nan] * self._methods
        self._now = _Taken(sample, x, exact or _UNKNOWN, known)
        if latest and is_new:
            length = (sample.t - latest[2]) / (sample.step - latest[0])
            if abs(sample.t) < 1e-6 * abs(length):  # t is rounded
                self._returned = sample
        if is_row and is_new:
            self._latest = sample.step, x, sample.t
            self._waiting.append(self._now)
            if len(self._waiting) >= MAX_WAITING:
                _ = self.rows

    @property
    def returned(self) -> Sample | None:
        """The sample at which simulated time was back at 0."""
        now = self._now
        is_ahead = self._returned is None or now is None or self._returned.step > now.sample.step
        return None if is_ahead else self._returned

    def _x(self, sample: Sample) -> float:
        before = self._latest
        if self._is_behind:
            number = self.rows.number_after(sample.step)
            before = self.rows.times_before(number) if number else None
        return abs(sample.t) if before is None else before[1] + abs(sample.t - before[2])

    @property
    def rows(self) -> "Rows":
        if self._rows is None:
            from tui.playback.rows import Rows

            others = [*self._energy, *self._extra]
            self._rows = Rows(
                self._repeats, self._reference[:2], others, self._methods, self._capacity
            )
        for taken in self._waiting:
            self._rows.append(self._row(taken))
        self._waiting.clear()
        return self._rows

    def _row(self, taken: _Taken, at_once: bool = False) -> "Row":
        """Return a row; `at_once`: with what is true at its end only."""
        from tui.playback.rows import Row

        readings = taken.sample.readings
        states = [State(reading.theta, reading.omega) for reading in readings]
        others = [[self._theta_error(theta, taken.exact.theta) for theta, _ in states]]
        others.append([*taken.modified])
        if self._energy:
            others.append([reading.energy for reading in readings])
        others += [[reading.extra[name] for reading in readings] for name in self._extra]
        now = [reading.energy_error for reading in readings]
        low = now if at_once else [reading.energy_error_low for reading in readings]
        high = now if at_once else [reading.energy_error_high for reading in readings]
        times = (taken.x, taken.sample.t)
        return Row(
            taken.sample.step, times, [*states, taken.exact], [low, *others], [high, *others]
        )

    def _truncate(self, step: int) -> None:
        rows = self.rows
        rows.truncate(step)
        self._latest = rows.times_before(rows.count) if rows.count else None
        if self._returned is not None and self._returned.step > step:
            self._returned = None

    @property
    def _until(self) -> int:
        """The number of the first row after the sample."""
        rows = self.rows
        if not self._is_behind or self._now is None:
            return rows.count
        return rows.number_after(self._now.sample.step)

    def _current(self) -> "Row | None":
        """Return the sample as a row, unless it is one."""
        until = self._until
        now = self._now
        if now is None or (until and self.rows.times_before(until)[0] == now.sample.step):
            return None
        return self._row(now, at_once=True)

    def window(self, seconds: float | None = None) -> "Window":
        """Return the last `seconds` of simulated time and half a swing before, or the whole run."""
        start = -math.inf
        if seconds is not None and self._now is not None:
            start = self._now.x - seconds - self._repeats
        return self.rows.window(self._until, self._current(), start)

    def between(self, begin: float, end: float) -> "Window":
        """Return what lies between two x [s], and half a swing before."""
        return self.window().cut(begin - self._repeats, end)

    def since(self, step: int) -> tuple[list[float], list[float]] | None:
        """Return the largest energy errors after a step, and the theta errors there."""
        number = self.rows.number_after(step)
        now = self._now
        if now is None or not 0 < number <= self._until:
            return None
        x = self.rows.times_before(number)[1]
        window = self.window()
        before = int((window.x <= x).sum()) - 1
        if before < 0:
            return None
        low = -window.low["energy_error"][before + 1 :]
        high = window.high["energy_error"][before + 1 :]
        errors = [abs(reading.energy_error) for reading in now.sample.readings]
        largest = [max(each) for each in zip(errors, *low.tolist(), *high.tolist(), strict=True)]
        return largest, window.high["theta_error"][before].tolist()

    def trails(self, length: int) -> "NDArray":  # type: ignore[type-arg]
        """Return theta [rad] and omega [rad/s] of every method and the exact motion, oldest first.

        At the last `length` samples, (samples, methods + 1, 2).
        """
        import numpy as np

        if self._trails is None or self._trails[:2] != (self._now, length):
            rows = self.rows.trails(self._until, length)
            current = self._current()
            if current is not None:
                rows = np.concatenate([rows, np.array(current.states)[None]])[-length:]
            self._trails = self._now, length, rows
        return self._trails[2]

    def thetas(self, index: int, length: int) -> list[float]:
        """Return theta [rad] of a method at the last `length` samples, oldest first."""
        if self._rows is None:
            return [each.sample.readings[index].theta for each in self._waiting[-length:]]
        return self.trails(length)[:, index, 0].tolist()  # type: ignore[no-any-return]
