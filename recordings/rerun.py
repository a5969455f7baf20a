"""Rerun: a recorded run, simulated again, sample by sample beside the recorded one.

Where this machine's sin is not the one of the recording, bits cannot be demanded.  What can be is that
a sample lies within a tolerance: as far as the same run strays when its start is off by one part in
10^11 (measured, by simulating that, too), and at least one part in 10^11 of the number.  Another libm's
sin is off by 1e-16 in one value of 1400; tested is one that is off in every other.  Where a run is so
chaotic that its strayed twin has lost it, by a thousandth of a radian, nothing can be demanded of that
method any more.
"""

import math
import struct
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace

from engine.methods import METHODS
from engine.run.compiled import tiered
from engine.run.lockstep import Lockstep, Reading, Sample
from engine.run.stepping import Stepping
from engine.scenes import SceneError
from recordings.errors import RecordingError
from recordings.events import Event

TOLERANCE = 1e-11
LOST = 1e-3  # rad, or rad/s
MOST_STEPS = 10**10  # of a run that is simulated again; hours of computing
NUMBERS = ("theta", "omega", "energy", "energy_error", "max_energy_error")
EXTREMES = ("energy_error_low", "energy_error_high")


@dataclass(frozen=True, slots=True)
class Difference:
    """A number that was recorded and did not come out again."""

    run: int
    step: int
    t: float  # s, simulated
    method: str  # "" for the time itself
    field: str
    recorded: float | None
    computed: float | None

    @property
    def size(self) -> float:
        """How far they are apart; infinitely, where there is only one."""
        return _distance(self.recorded, self.computed)

    @property
    def ulps(self) -> int | None:
        """How many doubles they are apart; None where there is only one."""
        if self.recorded is None or self.computed is None:
            return None
        return abs(_ordinal(self.recorded) - _ordinal(self.computed))


class Rerun:
    """One run, again.  `exact`: its sin is this machine's, so every bit must be the same.

    `max_difference`: the largest so far of any number, within tolerance or not.
    """

    def __init__(self, start: Event, exact: bool) -> None:
        if start.scene is None or start.step != 0:
            raise RecordingError(f"run {start.run} does not begin at its start")
        scene, self.run = start.scene, start.run
        methods = [method for method in METHODS if method.key in start.methods]
        self._lockstep = Lockstep(scene, start.run, methods, tiered)
        off = replace(scene, theta=scene.theta * (1 - TOLERANCE), omega=scene.omega * (1 - TOLERANCE))
        self._astray = None if exact else Lockstep(off, start.run, methods, tiered)
        self._allowed: dict[tuple[str, str], float] = defaultdict(float)
        self._methods = start.methods
        self._sampled = -1
        self.max_difference = 0.0

    def follow(self, event: Event) -> None:
        """Do what was done."""
        if event.kind == "set_h" and event.h is not None:
            for lockstep in self._go(event.step):
                try:
                    lockstep.set_stepping(Stepping(event.h, event.equal_cost))
                except SceneError as error:
                    raise RecordingError(f"run {self.run} cannot have been recorded: {error}") from error

    def compare(self, recorded: Sample) -> list[Difference]:
        """What differs from the sample when the run gets there."""
        if recorded.step <= self._sampled:
            raise RecordingError(f"the steps of run {self.run} are not in order")
        self._sampled = recorded.step
        computed, *astray = (lockstep.sample() for lockstep in self._go(recorded.step))
        if astray:
            self._widen(computed, astray[0])
        elif computed.t == recorded.t and all(map(_same, recorded.readings, computed.readings)):
            return []
        return list(self._differences(recorded, computed))

    def _go(self, step: int) -> list[Lockstep]:
        locksteps = [self._lockstep, *([self._astray] if self._astray else [])]
        if step < self._lockstep.step:
            raise RecordingError(f"the steps of run {self.run} are not in order")
        if step > MOST_STEPS:
            raise RecordingError(f"run {self.run} has {step} steps, more than can be simulated again")
        for lockstep in locksteps:
            lockstep.advance(step - lockstep.step)
        return locksteps

    def _differences(self, recorded: Sample, computed: Sample) -> Iterator[Difference]:
        if recorded.t != computed.t:
            self.max_difference = max(self.max_difference, _distance(recorded.t, computed.t))
            yield Difference(self.run, recorded.step, recorded.t, "", "t", recorded.t, computed.t)
        for method, was, now in zip(self._methods, recorded.readings, computed.readings, strict=True):
            lost = max(self._allowed[method, "theta"], self._allowed[method, "omega"]) > LOST
            # A recorded extreme that is the energy error itself claims nothing: see format.without_extremes.
            extremes = (name for name in EXTREMES if getattr(was, name) != was.energy_error)
            for field in (*NUMBERS, *extremes, "diverged_at"):
                a, b = getattr(was, field), getattr(now, field)
                self.max_difference = max(self.max_difference, _distance(a, b))
                if self._astray is None:
                    equal = a == b and (a is None or _ordinal(a) == _ordinal(b))
                else:
                    equal = _distance(a, b) <= max(self._allowed[method, field], TOLERANCE * max(1.0, abs(b or 0.0)))
                if not (equal or lost):
                    yield Difference(self.run, recorded.step, recorded.t, method, field, a, b)

    def _widen(self, computed: Sample, astray: Sample) -> None:
        for method, a, b in zip(self._methods, computed.readings, astray.readings, strict=True):
            for field in (*NUMBERS, *EXTREMES, "diverged_at"):
                distance = _distance(getattr(a, field), getattr(b, field))
                self._allowed[method, field] = max(self._allowed[method, field], distance)


_pack = struct.Struct("<5d").pack


def _same(a: Reading, b: Reading) -> bool:
    """Whether two readings have the same bits; the usual case, quickly.  (0.0 == -0.0, hence the second half.)"""
    return a == b and (
        _pack(a.theta, a.omega, a.energy, a.energy_error, a.max_energy_error)
        == _pack(b.theta, b.omega, b.energy, b.energy_error, b.max_energy_error)
    )


def _distance(a: float | None, b: float | None) -> float:
    return 0.0 if a == b else math.inf if a is None or b is None else abs(a - b)


def _ordinal(value: float) -> int:
    """The place of a double among all doubles in order; neighbours differ by 1, and -0.0 comes just before 0.0."""
    bits = int.from_bytes(struct.pack(">d", value), "big", signed=True)
    return bits if bits >= 0 else -(bits & (1 << 63) - 1) - 1
