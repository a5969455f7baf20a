"""Verify: simulate a recording's runs again from their events, and compare every sample bit for
bit.

If this machine's sin differs from the recording's, samples need not have the same bits, but must
lie within a tolerance: as far as the same run strays when its start is changed by one part in 10^11
(which is simulated, too), and at least one part in 10^11 of the number.  Once the changed run is
off by a thousandth of a radian, as happens in chaos, that method is no longer compared.
"""

from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from engine.run import NUMERICS
from engine.run.compiled import TieredLoops
from engine.run.lockstep import Lockstep, Sample
from engine.run.stepping import Stepping
from engine.scenes import Scene
from recordings.errors import RecordingError, named
from recordings.events import Event, check_present
from recordings.fields import EXTREMES, STATE, VALUES, distance, same_bits, ulps, values_of
from recordings.reader import ShowProgress
from recordings.recording import Recording

Only = Collection[str] | None
"""Keys of the methods to compare; None: all."""

TOLERANCE = 1e-11
LOST = 1e-3  # rad, or rad/s
STEPS_AT_ONCE = 50_000  # a fifth of a second, after which an interrupt is heard
MAX_STEPS = 10_000_000  # simulated again of a file, unless more are asked for: less than a minute


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
    path: Path, progress: ShowProgress | None = None, max_steps: int = MAX_STEPS, only: Only = None
) -> Verification:
    """Verify a recording up to where it is first damaged; `only`: compare the methods of these
    keys.

    Raises RecordingError if it is not a recording, is inconsistent, has no samples, or claims more
    than `max_steps` steps: the number is in the file's hands.
    """
    result = Verification(path)
    with Recording.open(path, check=True, progress=progress) as recording, named(path):
        rerun: Rerun | None = None
        for is_after_gap, entries in recording.chunks():
            if is_after_gap:
                break
            for _, value in entries:
                if isinstance(value, Event) and value.scene is not None:
                    max_steps -= rerun.steps if rerun else 0
                    rerun = Rerun(value, value.scene, result, max_steps, only)
                if rerun is None or value.run != rerun.run:
                    raise RecordingError(f"data of run {value.run} lies outside that run")
                rerun.take(value)
        if recording.runs_lost and not recording.damaged:
            raise RecordingError("a run has no start")
        if result.samples == 0:
            raise RecordingError(recording.reason or "it has no samples")
        result.complete = recording.complete
        result.reason = recording.reason
        result.identical = result.first_difference is None and not recording.damaged
    return result


class Rerun:
    """One run, simulated again, and compared with what was recorded."""

    def __init__(
        self, start: Event, scene: Scene, result: Verification, max_steps: int, only: Only
    ) -> None:
        check_present(scene, only)
        assert start.arithmetic is not None
        result.runs += 1
        result.numerics = start.arithmetic.numerics
        result.other_functions = start.arithmetic.other_functions()
        self.run = start.run
        self._result = result
        self._is_exact = not result.other_functions
        scenes = [scene]
        if not self._is_exact:
            nearer = {name: getattr(scene, name) * (1 - TOLERANCE) for name in ("theta", "omega")}
            scenes.append(replace(scene, **nearer))
        self._locksteps = [Lockstep(each, self.run, TieredLoops) for each in scenes]
        self._max_steps = max_steps
        self._only = only
        self._changes: list[Event] = []  # that no sample has come after yet
        self._allowed: dict[tuple[str, str], float] = defaultdict(float)
        self._cast = scene.cast
        self._methods = [method.key for method in scene.cast]
        if only is not None and not set(only) & set(self._methods):
            raise RecordingError(f"run {self.run} has none of the methods {', '.join(only)}")
        self._sampled = -1
        self._changed = 0  # the step of the last change

    @property
    def steps(self) -> int:
        """How many steps have been simulated."""
        return self._locksteps[0].step

    def take(self, value: Sample | Event) -> None:
        """Take what was recorded.  A change is applied at the next sample, which shows that it was reached."""
        if isinstance(value, Sample):
            self._compare(value)
        elif value.h is not None:
            if value.step < max(self._changed, self._sampled):
                raise RecordingError(f"the steps of run {self.run} are not in order")
            self._changed = value.step
            self._changes.append(value)

    def _compare(self, recorded: Sample) -> None:
        computed, *astray = self._reach(recorded.step)
        for other in astray:
            self._widen(computed, other)
        self._result.samples += 1
        are_same = computed.t == recorded.t and all(
            map(same_bits, recorded.readings, computed.readings)
        )
        if not (self._is_exact and are_same):
            for difference in self._differences(recorded, computed):
                self._result.first_difference = self._result.first_difference or difference

    def _reach(self, step: int) -> list[Sample]:
        """Return the run's sample at this step; if not exact, also that of the changed start."""
        if step <= self._sampled or step < self._changed:
            raise RecordingError(f"the steps of run {self.run} are not in order")
        if step > self._max_steps:
            raise RecordingError(
                f"run {self.run} claims to reach step {step}, more than may be simulated; if you trust the file,"
                f" use --max-steps {MAX_STEPS + step}"
            )
        self._sampled = step
        for change in self._changes:
            assert change.h is not None
            self._go(change.step)
            for lockstep in self._locksteps:
                lockstep.set_stepping(Stepping(change.h, change.equal_cost, self._cast))
        self._changes.clear()
        self._go(step)
        return [lockstep.sample() for lockstep in self._locksteps]

    def _go(self, step: int) -> None:
        for lockstep in self._locksteps:
            while lockstep.step < step:
                lockstep.advance(min(step - lockstep.step, STEPS_AT_ONCE))

    def _differences(self, recorded: Sample, computed: Sample) -> Iterator[Difference]:
        run, step, t, _ = recorded
        if t != computed.t:
            yield Difference(run, step, t, "", "t", t, computed.t)
        for method, was, now in zip(
            self._methods, recorded.readings, computed.readings, strict=True
        ):
            if self._only is not None and method not in self._only:
                continue
            is_lost = max(self._allowed[method, name] for name in STATE) > LOST
            for field, a, b in zip(VALUES, values_of(was), values_of(now), strict=True):
                if field in EXTREMES and a == was.energy_error:
                    continue  # such an extreme holds no information: see fields.without_extremes
                if not is_lost and not self._is_equal(method, field, a, b):
                    yield Difference(run, step, t, method, field, a, b)

    def _is_equal(self, method: str, field: str, a: float | None, b: float | None) -> bool:
        if self._is_exact:
            return a == b and not ulps(a, b)
        return distance(a, b) <= max(
            self._allowed[method, field], TOLERANCE * max(1.0, abs(b or 0.0))
        )

    def _widen(self, computed: Sample, astray: Sample) -> None:
        for method, a, b in zip(self._methods, computed.readings, astray.readings, strict=True):
            for field, one, other in zip(VALUES, values_of(a), values_of(b), strict=True):
                allowed = self._allowed[method, field]
                self._allowed[method, field] = max(allowed, distance(one, other))
