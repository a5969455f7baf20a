"""Verify: simulate a recording's runs again from their events, and compare every sample bit for
bit.

If this machine's sin differs from the recording's, samples need not have the same bits, but must
lie within a tolerance: as far as the same run strays when its start is changed by one part in 10^11
(which is simulated, too), and at least one part in 10^11 of the number.  Once the changed run is
off by a thousandth of a radian, as happens in chaos, that method is no longer compared.
"""

import math
from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from engine.run import NUMERICS
from engine.run.compiled import TieredLoops
from engine.run.lockstep import Lockstep, Sample
from engine.run.stepping import Stepping
from recordings.errors import RecordingError, named
from recordings.events import Event, check_present
from recordings.fields import EXTREMES, STATE, VALUES, differences, distance, ulps, values_of
from recordings.reader import ShowProgress
from recordings.recording import Recording, Run

Only = Collection[str] | None
"""Keys of the methods to compare; None: all."""

TOLERANCE = 1e-11
LOST = 1e-3  # rad, or rad/s
STEPS_AT_ONCE = 50_000  # a fifth of a second, after which an interrupt is heard
MAX_STEPS = 1_000_000  # simulated again of a file, about three seconds, or
MAX_STEPS_PER_SAMPLE = 100  # if that is more: the lab at h = 0.001 s has 33


@dataclass(frozen=True, slots=True)
class Difference:
    """A recorded number that the re-simulation did not reproduce."""

    run: int
    step: int
    t: float  # s, simulated
    method: str  # "" for the time itself
    field: str
    recorded: float | None
    computed: float | None

    @property
    def ulps(self) -> int | None:
        """Their distance in doubles; None if one is missing."""
        return ulps(self.recorded, self.computed)


@dataclass(slots=True)
class Verification:
    """The result of `verify`.  Complete and identical: nothing was changed or lost."""

    file: Path
    complete: bool = False  # finished, and every checksum right
    reason: str | None = None  # why not, a clause
    runs: int = 0
    samples: int = 0
    numerics: int = NUMERICS  # the version of the numbers
    other_functions: tuple[str, ...] = ()  # that this machine computes differently
    identical: bool = False  # every sample, or within the tolerance where sin differs; no damage
    first_difference: Difference | None = None


def verify(
    path: Path,
    progress: ShowProgress | None = None,
    max_steps: int | None = None,
    only: Only = None,
) -> Verification:
    """Verify a recording up to where it is first damaged; `only`: compare the methods of these
    keys.

    Raises RecordingError if it is not a recording, is inconsistent, has no samples, or claims more
    than `max_steps` steps: the number is in the file's hands.
    """
    result = Verification(path)
    with Recording.open(path, check=True, progress=progress) as recording, named(path):
        _check_steps(recording, max_steps)
        rerun: Rerun | None = None
        for _, value in recording.entries():
            if value is None:
                break
            if rerun is None or value.run != rerun.run.number:
                run = recording.run_of(value.run)
                if run is None or not isinstance(value, Event) or value.scene is None:
                    raise RecordingError(f"data of run {value.run} lies outside that run")
                rerun = Rerun(run, result, only)
            elif isinstance(value, Sample):
                rerun.compare(value)
            elif value.h is not None:
                rerun.change(value)
        if recording.lost_runs and not recording.damaged:
            raise RecordingError("a run has no start")
        if result.samples == 0:
            raise RecordingError(recording.reason or "it has no samples")
        result.complete = recording.complete
        result.reason = recording.reason
        result.identical = result.first_difference is None and not recording.damaged
    return result


def _check_steps(recording: Recording, max_steps: int | None) -> None:
    """Raise RecordingError if re-simulation would take too many steps."""
    steps = sum(run.steps for run in recording.runs)
    if steps > (max_steps or max(MAX_STEPS, MAX_STEPS_PER_SAMPLE * recording.samples)):
        raise RecordingError(
            f"it claims {steps} steps, more than may be simulated; if you trust the file, use"
            f" --max-steps {steps}"
        )


class Rerun:
    """One run, simulated again, and compared with what was recorded."""

    def __init__(self, run: Run, result: Verification, only: Only) -> None:
        scene = run.scene
        check_present(scene, only)
        result.runs += 1
        result.numerics = run.arithmetic.numerics
        result.other_functions = run.arithmetic.other_functions()
        self.run = run
        self._result = result
        self._is_exact = not result.other_functions
        self._lockstep = Lockstep(scene, run.number, TieredLoops)
        self._locksteps = [self._lockstep]
        if not self._is_exact:
            nearer = {name: getattr(scene, name) * (1 - TOLERANCE) for name in ("theta", "omega")}
            self._locksteps.append(Lockstep(replace(scene, **nearer), run.number, TieredLoops))
        self._only = only
        self._changes: list[Event] = []  # that no sample has come after yet
        self._allowed: dict[tuple[str, str], float] = defaultdict(float)
        self._methods = [method.key for method in scene.cast]
        if only is not None and not set(only) & set(self._methods):
            raise RecordingError(f"run {run.number} has none of the methods {', '.join(only)}")
        self._reached = 0  # the step of the last change or sample

    def change(self, event: Event) -> None:
        """Take a change of h, which is applied once a sample shows that it was reached."""
        self._check_order(event.step, math.inf)
        self._changes.append(event)

    def compare(self, recorded: Sample) -> None:
        """Simulate up to a sample, and compare."""
        self._check_order(recorded.step, self.run.steps)
        for change in self._changes:
            assert change.h is not None
            self._go(change.step)
            for lockstep in self._locksteps:
                stepping = Stepping(change.h, change.equal_cost, self.run.scene.cast)
                lockstep.set_stepping(stepping)
        self._changes.clear()
        self._go(recorded.step)
        computed, *astray = [lockstep.sample() for lockstep in self._locksteps]
        for other in astray:
            self._widen(computed, other)
        self._result.samples += 1
        for difference in self._differences(recorded, computed):
            self._result.first_difference = self._result.first_difference or difference

    def _check_order(self, step: int, last: float) -> None:
        """Raise RecordingError unless steps ascend, up to the last."""
        if not self._reached <= step <= last:
            raise RecordingError(f"the steps of run {self.run.number} are not in order")
        self._reached = step

    def _go(self, step: int) -> None:
        for lockstep in self._locksteps:
            while lockstep.step < step:
                lockstep.advance(min(step - lockstep.step, STEPS_AT_ONCE))

    def _differences(self, recorded: Sample, computed: Sample) -> Iterator[Difference]:
        place = (recorded.run, recorded.step, recorded.t)
        if recorded.t != computed.t:
            yield Difference(*place, "", "t", recorded.t, computed.t)
        for method, was, now in zip(
            self._methods, recorded.readings, computed.readings, strict=True
        ):
            if self._only is not None and method not in self._only:
                continue
            for field, a, b in differences(was, now):
                is_implied = field in EXTREMES and a == was.energy_error  # see without_extremes
                if not is_implied and not self._is_tolerated(method, field, a, b):
                    yield Difference(*place, method, field, a, b)

    def _is_tolerated(self, method: str, field: str, a: float | None, b: float | None) -> bool:
        if self._is_exact:
            return False
        is_lost = max(self._allowed[method, name] for name in STATE) > LOST
        rounding = TOLERANCE * max(1.0, abs(b or 0.0))
        return is_lost or distance(a, b) <= max(self._allowed[method, field], rounding)

    def _widen(self, computed: Sample, astray: Sample) -> None:
        for method, a, b in zip(self._methods, computed.readings, astray.readings, strict=True):
            for field, one, other in zip(VALUES, values_of(a), values_of(b), strict=True):
                allowed = self._allowed[method, field]
                self._allowed[method, field] = max(allowed, distance(one, other))
