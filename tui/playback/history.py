"""History: a run up to a sample, in rows for charts and trails.

Rows are samples at fixed steps of the run, so that pictures do not depend on the frame rate.  The
current sample is the last point, whether it is a row or not.
"""

import math
from collections.abc import Sequence
from copy import copy, deepcopy
from operator import attrgetter
from typing import TYPE_CHECKING, NamedTuple

from pendu_tui.engine.quantities import ENERGY, ENERGY_ERROR, HIGH, LOW
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping, SteppingChange, change_before
from pendu_tui.engine.scenes import Scene

if TYPE_CHECKING:
    from pendu_tui.tui.playback.rows import Floats, Ghost, Records, Rows, Window

TRAIL = 300  # rows, ten seconds
ERROR = attrgetter(ENERGY_ERROR.name)
LOWEST = attrgetter(LOW.name)  # since the previous sample
HIGHEST = attrgetter(HIGH.name)


class Row(NamedTuple):
    """A sample as charts and trails need it."""

    step: int
    since: int  # step of the last change of h
    x: float  # s, simulated time covered
    t: float  # s, simulated
    states: Sequence[Sequence[float]]  # of the methods and the exact motion: theta, omega
    low: list[list[float]]  # of each quantity and method, since the row before
    high: list[list[float]]


class History:
    sample: Sample
    gap = -1  # after this step samples are missing

    def __init__(
        self, scene: Scene, changes: Sequence[SteppingChange], capacity: int = 4096
    ) -> None:
        """`changes` are those of the run, its start first; a live run appends to them."""
        self.scene = scene
        self.exact = scene.exact()
        self.changes = changes
        self._model = scene.equations
        self._reference = self._model.reference(scene.theta, scene.omega)
        self._extra = [each.name for each in self._model.variables if each.chart.title]
        self._quantities = [each.name for each in self._model.charted()]
        self._repeats = self.exact.period or 0.0
        if self.exact.regime == "libration":
            self._repeats /= 2
        self._capacity = capacity
        self.step = -1  # of the current sample
        self._last_row = -1  # the step of the last row
        self._waiting: list[Row] = []
        self._rows: Rows | None = None
        self._modified_starts: dict[SteppingChange, list[float]] = {}

    def continued(self, changes: Sequence[SteppingChange]) -> "History":
        """Return a copy from which a lab's run with these changes branches off."""
        copied = copy(self)
        copied.changes = changes
        copied.sample = self.sample._replace(run=0)  # no run of a lab
        copied._rows = deepcopy(self._filled)
        copied._waiting = []
        return copied

    def add(self, sample: Sample, is_row: bool = True) -> None:
        """Make this the current sample, and keep it if it is a row.

        Going back keeps the later rows.  A sample of another run, which branched off here, drops
        them; its extremes may be those of the whole run.
        """
        branches = self.step >= 0 and sample.run != self.sample.run
        if branches:
            self._last_row = self._filled.truncate(sample.step)
        change = change_before(self.changes, sample.step)
        if change not in self._modified_starts and change.step <= self.step < sample.step:
            self._modified_starts[change] = self._modified_energies(self.sample, change.stepping)
        self.sample = sample
        self.step = sample.step
        if is_row and sample.step > self._last_row:
            self._last_row = sample.step
            self._waiting.append(self._row(sample, with_extremes=not branches))
            if len(self._waiting) >= 64:  # the first paint does not wait for NumPy
                _ = self._filled

    def _row(self, sample: Sample, with_extremes: bool) -> Row:
        """Return a row; without extremes, of the values at its end."""
        readings = sample.readings
        exact = self.exact.at(sample.t)
        states = [(reading.theta, reading.omega) for reading in readings]
        others = [
            *([reading.extra[name] for reading in readings] for name in self._extra),
            [self._model.theta_error(theta, exact.theta) for theta, _ in states],
            self._shadow_errors(sample),
            [reading.energy for reading in readings],
        ]
        low = high = [ERROR(reading) for reading in readings]
        if with_extremes:
            low = [LOWEST(reading) for reading in readings]
            high = [HIGHEST(reading) for reading in readings]
        change = change_before(self.changes, sample.step)
        place = sample.step, change.step, change.x_at(sample.t), sample.t
        return Row(*place, [*states, exact], [low, *others], [high, *others])

    def _shadow_errors(self, sample: Sample) -> list[float]:
        """Return the relative change of each modified energy since the step size changed.

        Each step size has its own modified energy.  It is nan for a method without one, and for
        the first sample after a change.
        """
        change = change_before(self.changes, sample.step)
        starts = self._modified_starts.get(change)
        if starts is None:
            return [math.nan] * len(sample.readings)
        energies = self._modified_energies(sample, change.stepping)
        scale = self._reference.scale
        return [(now - start) / scale for now, start in zip(energies, starts, strict=True)]

    def _modified_energies(self, sample: Sample, stepping: Stepping) -> list[float]:
        energies = []
        for method, reading, h in zip(self.scene.cast, sample.readings, stepping.own, strict=True):
            energy = math.nan
            if method.modified_energy and not self._model.without_force:
                energy = method.modified_energy(self._model, (reading.theta, reading.omega), h)
            energies.append(energy)
        return energies

    @property
    def _current(self) -> Row:
        return self._row(self.sample, with_extremes=False)

    @property
    def _filled(self) -> "Rows":
        """The rows, in NumPy's arrays."""
        if self._rows is None:
            from pendu_tui.tui.playback.rows import Rows

            self._rows = Rows(len(self._quantities), len(self.scene.cast), self._capacity)
        for row in self._waiting:
            self._rows.append(row)
        self._waiting.clear()
        return self._rows

    @property
    def rows(self) -> "Records":
        """The rows of the whole run up to the current sample."""
        return self._filled.until(self._current)

    def window(self, seconds: float | None = None) -> "Window":
        """Return the last `seconds` of simulated time and half a swing before, or the whole run."""
        from pendu_tui.tui.playback.rows import Window

        records = self.rows
        if seconds is not None:
            records = records[records["x"] >= records["x"][-1] - seconds - self._repeats]
        low = self._named(records["low"])
        high = self._named(records["high"])
        return Window(records["x"], records["t"], low, high, self._repeats)

    def _named(self, extremes: "Floats") -> dict[str, "Floats"]:
        named = {name: extremes[:, i] for i, name in enumerate(self._quantities)}
        if self._model.conserves_energy:  # then the energy's extremes are known, too
            start, scale, *_ = self._reference
            named[ENERGY.name] = start + scale * named[ENERGY_ERROR.name]
        return named

    def between(self, begin: float, end: float) -> "Window":
        return self.window().cut(begin - self._repeats, end)

    def since(self, change: SteppingChange) -> tuple[list[float], list[float]] | None:
        """Return the largest energy errors since a change, and the theta errors at it.

        Returns None where not all samples from the change on have been read.
        """
        rows = self.rows
        if change.step <= self.gap or change.step not in rows["step"]:
            return None
        later = rows["step"] > change.step
        low = -self._named(rows["low"][later])[ENERGY_ERROR.name]
        high = self._named(rows["high"][later])[ENERGY_ERROR.name]
        errors = [abs(ERROR(reading)) for reading in self.sample.readings]
        largest = [max(each) for each in zip(errors, *low.tolist(), *high.tolist(), strict=True)]
        *states, exact = rows["states"][rows["step"] == change.step][0].tolist()
        return largest, [self._model.theta_error(theta, exact[0]) for theta, _ in states]

    def trails(self, length: int = TRAIL) -> "Floats":
        """Return theta [rad] and omega [rad/s] at the last samples, oldest first.

        Its shape is (samples, methods + 1, 2); the exact motion is last.
        """
        return self._filled.recent_until(self._current, length)["states"][-length:]

    def thetas(self, length: int) -> list[Sequence[float]]:
        """Return each method's last angles [rad] before the current sample, oldest first.

        The first paint needs no NumPy for them.
        """
        if self._rows is not None:
            states = self._filled.before(self.step)[-length:]["states"].tolist()
        else:
            states = [row.states for row in self._waiting if row.step < self.step][-length:]
        return [[each[place][0] for each in states] for place in range(len(self.scene.cast))]

    def ghost(self) -> "Ghost":
        """Return this run to lay under another one."""
        from pendu_tui.tui.playback.rows import Ghost

        steps = dict.fromkeys(f"{abs(change.stepping.h):.4g}" for change in self.changes)
        label = f"dim: run before, h {', '.join(steps)} s"
        return Ghost(self.scene, label, self.window(), self.rows)
