"""Verify: simulate a recording's runs again from their events, and compare every sample bit for bit.

If this machine's sin differs from the recording's, samples need not have the same bits, but must lie within
a tolerance: as far as the same run strays when its start is changed by one part in 10^11 (which is
simulated, too), and at least one part in 10^11 of the number.  Another libm's sin differs by 1e-16 in one
value of 1400; the tests use one that differs in every second value.  Once the changed run is off by a
thousandth of a radian, as happens in chaos, that method is no longer compared.
"""

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
from recordings.fields import EXTREMES, STATE, VALUES, distance, same_bits, ulps, values_of
from recordings.library import open_file
from recordings.reader import Decoder, Scan, ShowProgress

Only = Collection[str] | None
"""Keys of the methods to compare; None: all."""

TOLERANCE = 1e-11
LOST = 1e-3  # rad, or rad/s
STEPS_AT_ONCE = 50_000  # a fifth of a second
MAX_STEPS = 10_000_000  # simulated again of a file, unless more are asked for: less than a minute
STEP_SECONDS = 5e-6  # of all four methods in plain Python, about


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
    """The result of `verify`.  Complete and identical: nothing was changed or lost since it was recorded."""

    file: Path
    complete: bool = False  # finished, and every checksum right
    reason: str | None = None  # why not, a clause
    runs: int = 0
    samples: int = 0
    numerics: int = NUMERICS  # the version of the numbers
    other_functions: tuple[str, ...] = ()  # that this machine computes differently
    identical: bool = False  # every sample, or within the tolerance where sin differs; no damage
    max_difference: float = 0.0  # of any number, in its unit, within tolerance or not
    first_difference: Difference | None = None


def verify(
    path: Path,
    progress: ShowProgress | None = None,
    max_steps: int = MAX_STEPS,
    only: Only = None,
) -> Verification:
    """Verify a recording up to where it is first damaged; `only`: compare the methods of these keys.

    Raises RecordingError if it is not a recording, is inconsistent, has no samples, or claims more than
    `max_steps` steps.
    """
    result = Verification(path)
    with named(path), open_file(path) as stream:
        scan = Scan(stream, progress)
        budget = StepBudget(max_steps)
        decoder = Decoder(scan.channels)
        rerun: Rerun | None = None
        for _, messages in scan:
            if scan.damaged:
                break
            for _, value in decoder.entries(messages):
                if isinstance(value, Event) and value.scene is not None:
                    rerun = _begin(value, rerun, result, budget, only)
                if rerun is None or value.run != rerun.run:
                    raise RecordingError(f"data of run {value.run} lies outside that run")
                _compare(value, rerun, result)
        if decoder.lost_runs:
            raise RecordingError(f"run {min(decoder.lost_runs)} has no start")
        if result.samples == 0:
            raise RecordingError(scan.reason or "it has no samples")
        result.complete = scan.complete
        result.reason = scan.reason
        result.identical = result.first_difference is None and not scan.damaged
    return result


def _begin(start: Event, before: "Rerun | None", result: Verification, budget: "StepBudget", only: Only) -> "Rerun":
    if before is not None and start.run <= before.run:
        raise RecordingError("its runs are not in order")
    assert start.scene is not None
    assert start.arithmetic is not None
    check_present(start.scene, only)
    result.runs += 1
    result.numerics = start.arithmetic.numerics
    result.other_functions = start.arithmetic.other_functions()
    return Rerun(start, exact=not result.other_functions, budget=budget, only=only)


def _compare(value: Sample | Event, rerun: "Rerun", result: Verification) -> None:
    if isinstance(value, Event):
        rerun.follow(value)
        return
    result.samples += 1
    for difference in rerun.compare(value):
        result.first_difference = result.first_difference or difference
    result.max_difference = max(result.max_difference, rerun.max_difference)


class StepBudget:
    """How many steps may be simulated: a file's number of steps is not to be trusted."""

    def __init__(self, steps: int) -> None:
        self._steps = steps
        self._left = steps

    def spend(self, run: int, step: int, steps: int) -> None:
        """Take steps off, or raise RecordingError."""
        if steps > self._left:
            needed = self._steps - self._left + steps
            raise RecordingError(
                f"run {run} claims to reach step {step}; to simulate {needed} steps takes about"
                f" {needed * STEP_SECONDS / 60:,.0f} minutes, and the limit is {self._steps} steps; if you"
                f" trust the file, use --max-steps {needed}"
            )
        self._left -= steps


class Rerun:
    """One run, simulated again.  `exact`: its sin is this machine's, so every bit must be the same.

    `max_difference`: the largest so far of any number, within tolerance or not.
    """

    def __init__(
        self,
        start: Event,
        exact: bool = True,
        budget: StepBudget | None = None,
        only: Only = None,
    ) -> None:
        scene = start.scene
        assert scene is not None
        self.run = start.run
        self.max_difference = 0.0
        scenes = [scene]
        if not exact:
            nearer = {name: getattr(scene, name) * (1 - TOLERANCE) for name in ("theta", "omega")}
            scenes.append(replace(scene, **nearer))
        self._locksteps = [Lockstep(each, self.run, TieredLoops) for each in scenes]
        self._exact = exact
        self._budget = budget or StepBudget(MAX_STEPS)
        self._only = only
        self._changes: list[Event] = []  # that no sample has come after yet
        self._allowed: dict[tuple[str, str], float] = defaultdict(float)
        self._cast = scene.cast
        self._methods = [method.key for method in scene.cast]
        if only is not None and not set(only) & set(self._methods):
            raise RecordingError(f"run {self.run} has none of the methods {', '.join(only)}")
        self._sampled = -1
        self._reached = 0  # the step of the last change

    def follow(self, event: Event) -> None:
        """Take a recorded event.  It is applied at the next sample, which shows that its step was reached."""
        if event.h is None:
            return
        if event.step < max(self._reached, self._sampled):
            raise RecordingError(f"the steps of run {self.run} are not in order")
        self._reached = event.step
        self._changes.append(event)

    def compare(self, recorded: Sample) -> list[Difference]:
        """Return the differences from a recorded sample."""
        computed, *astray = self._reach(recorded.step)
        for other in astray:
            self._widen(computed, other)
        if self._exact and computed.t == recorded.t and all(map(same_bits, recorded.readings, computed.readings)):
            return []
        return list(self._differences(recorded, computed))

    def _reach(self, step: int) -> list[Sample]:
        """Return the run's sample at this step; if not `exact`, also that of the changed start."""
        if step <= self._sampled or step < self._reached:
            raise RecordingError(f"the steps of run {self.run} are not in order")
        self._budget.spend(self.run, step, step - self._locksteps[0].step)
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
        """Go to a step, in parts between which an interrupt is heard."""
        for lockstep in self._locksteps:
            while lockstep.step < step:
                lockstep.advance(min(step - lockstep.step, STEPS_AT_ONCE))

    def _differences(self, recorded: Sample, computed: Sample) -> Iterator[Difference]:
        if recorded.t != computed.t:
            self.max_difference = max(self.max_difference, distance(recorded.t, computed.t))
            yield Difference(self.run, recorded.step, recorded.t, "", "t", recorded.t, computed.t)
        for method, was, now in zip(self._methods, recorded.readings, computed.readings, strict=True):
            if self._only is not None and method not in self._only:
                continue
            is_lost = max(self._allowed[method, name] for name in STATE) > LOST
            for field, a, b in zip(VALUES, values_of(was), values_of(now), strict=True):
                if field in EXTREMES and a == was.energy_error:
                    continue  # such an extreme holds no information: see fields.without_extremes
                self.max_difference = max(self.max_difference, distance(a, b))
                if not is_lost and not self._is_equal(method, field, a, b):
                    yield Difference(self.run, recorded.step, recorded.t, method, field, a, b)

    def _is_equal(self, method: str, field: str, a: float | None, b: float | None) -> bool:
        if self._exact:
            return a == b and not ulps(a, b)
        allowed = max(self._allowed[method, field], TOLERANCE * max(1.0, abs(b or 0.0)))
        return distance(a, b) <= allowed

    def _widen(self, computed: Sample, astray: Sample) -> None:
        for method, a, b in zip(self._methods, computed.readings, astray.readings, strict=True):
            for field, one, other in zip(VALUES, values_of(a), values_of(b), strict=True):
                apart = distance(one, other)
                self._allowed[method, field] = max(self._allowed[method, field], apart)
