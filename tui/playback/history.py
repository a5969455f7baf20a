"""The past of a run: what came last as plain numbers, and all of it in `levels` when a chart or a portrait asks."""

import math
from collections import deque
from collections.abc import Sequence
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple, cast

from engine.models.model import State
from engine.run.lockstep import Sample
from engine.scenes import Scene

if TYPE_CHECKING:
    from tui.playback.levels import Levels, Window  # NumPy can wait for the first paint

RECENT = 16  # samples whose states are at hand
MOST_WAITING = 64  # rows
_UNKNOWN = State(math.nan, math.nan)


class _Row(NamedTuple):
    sample: Sample
    x: float  # s, simulated time run through
    exact: State
    modified: Sequence[float] | None


class ErrorHistory:
    """The past of one run, up to the last sample added."""

    def __init__(self, scene: Scene, capacity: int = 2048) -> None:
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
        self._recent: deque[Sequence[Sequence[float]]] = deque(
            maxlen=RECENT
        )  # theta and omega of each method
        self._waiting: list[_Row] = []
        self._levels: Levels | None = None
        self.added = self.rewound = 0  # samples so far, and how often some were taken back
        self.returned: Sample | None = None  # where simulated time last was back at 0

    def add(
        self, sample: Sample, exact: State | None = None, modified: Sequence[float] | None = None
    ) -> None:
        """Add the sample of a frame, the exact motion at its time, and the errors of the modified energies.

        The same sample again changes nothing.  An earlier one, and one of a run that goes on from
        this one's past, first takes back everything from its step on.
        """
        latest = self._latest
        if latest and (sample.run, sample.step) == (self._run, latest[0]):
            return
        self._run = sample.run
        if latest and sample.step <= latest[0]:
            self.rewind(sample.step - 1)
            latest = self._latest
        x = abs(sample.t)
        if latest:
            step, before, t = latest
            x = before + abs(sample.t - t)
            if abs(sample.t) < 1e-6 * abs((sample.t - t) / (sample.step - step)):  # t is rounded
                self.returned = sample
        self.added += 1
        self._latest = sample.step, x, sample.t
        self._recent.append([(reading.theta, reading.omega) for reading in sample.readings])
        self._waiting.append(_Row(sample, x, exact or _UNKNOWN, modified))
        if len(self._waiting) >= MOST_WAITING:
            _ = self.levels

    @property
    def levels(self) -> "Levels":
        if self._levels is None:
            from tui.playback.levels import Levels

            self._levels = Levels(
                self._repeats,
                self._reference[:2],
                [*self._energy, *self._extra],
                self._methods,
                self._capacity,
            )
        for sample, x, exact, modified in self._waiting:
            states = [State(reading.theta, reading.omega) for reading in sample.readings]
            theta_errors = [self._theta_error(theta, exact.theta) for theta, _ in states]
            others = [[reading.energy for reading in sample.readings]] if self._energy else []
            others += [[reading.extra[name] for reading in sample.readings] for name in self._extra]
            low, high = (
                (errors, theta_errors, modified or [math.nan] * len(states), *others)
                for errors in zip(
                    *(
                        (reading.energy_error_low, reading.energy_error_high)
                        for reading in sample.readings
                    ),
                    strict=True,
                )
            )
            self._levels.append(sample.step, (x, sample.t), [*states, exact], low, high)
        self._waiting.clear()
        return self._levels

    def rewind(self, step: int) -> None:
        """Forget what came after `step`, or a little more where it is long ago."""
        self.rewound += 1
        if self.returned is not None and self.returned.step > step:
            self.returned = None
        levels = self.levels
        levels.rewind(step)
        self._latest = levels.latest()
        self._recent = deque(levels.trails(RECENT)[:, :-1].tolist(), RECENT)

    def window(self, seconds: float | None = None) -> "Window":
        return self.levels.window(seconds)

    def between(self, begin: float, end: float) -> "Window":
        """What lies between two moments [s] of simulated time run through, and half a swing before."""
        latest = self._latest[1] if self._latest else 0.0
        return self.window(latest - begin).cut(begin - self._repeats, end)

    def states(self, length: int) -> Sequence[Sequence[Sequence[float]]]:
        """theta [rad] and omega [rad/s] of each method at the last `length` samples, oldest first."""
        if length > RECENT:
            return cast(
                Sequence[Sequence[Sequence[float]]], self.levels.trails(length)[:, :-1].tolist()
            )
        return list(islice(self._recent, max(len(self._recent) - length, 0), None))

    def thetas(self, index: int, length: int) -> list[float]:
        """theta [rad] of a method at the last `length` samples, oldest first."""
        return [states[index][0] for states in self.states(length)]
