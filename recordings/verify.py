"""Verify: simulate a recording's runs again from their events, and compare every sample bit for bit.

If this machine's sin differs from the recording's, samples need not have the same bits, but must lie
within a tolerance: as far as the same run strays when its start is changed by one part in 10^11 (which
is simulated, too), and at least one part in 10^11 of the number.  Another libm's sin differs by 1e-16 in
one value of 1400; the tests use one that differs in every second value.  Once the changed run is off by
a thousandth of a radian, as happens in chaos, that method is no longer compared.
"""

from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from engine.run.compiled import tiered
from engine.run.lockstep import Lockstep, Sample
from engine.run.stepping import Stepping
from engine.scenes import SceneError
from recordings.errors import RecordingError, named
from recordings.events import Event, unknown_in
from recordings.fields import EXTREMES, PHASE, VALUES, distance, same_bits, ulps, values_of
from recordings.headless import MOST_STEPS, StepBudget
from recordings.library import open_file
from recordings.scan import Gap, Scan, ShowProgress
from recordings.summary import other_functions

Only = Collection[str] | None
"""Keys of the methods to compare; None: all."""

TOLERANCE = 1e-11
LOST = 1e-3  # rad, or rad/s
STEPS_AT_ONCE = 50_000  # between reports of progress: a fifth of a second


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
    def size(self) -> float:
        """Their distance; infinite if one is missing."""
        return distance(self.recorded, self.computed)

    @property
    def ulps(self) -> int | None:
        """Their distance in doubles; None if one is missing."""
        return ulps(self.recorded, self.computed)


@dataclass(frozen=True, slots=True)
class Verification:
    """The result of `verify`.  Complete and identical: nothing was changed or lost since it was recorded."""

    file: Path
    complete: bool  # finished, and every checksum right
    reason: str | None  # why not, a clause
    runs: int
    samples: int
    other_functions: tuple[str, ...]  # that this machine computes differently
    identical: bool  # every sample, to the last bit, or within the tolerance where sin differs; and no damage
    sealed: bool | None  # whether the digest of all that is in it is right; None: it has none
    sha256: str | None  # the last right digest
    max_difference: float  # of any number, in its unit, within tolerance or not
    first_difference: Difference | None

    @property
    def same_sin(self) -> bool:
        """Whether this machine's sine is the recording's."""
        return "sin" not in self.other_functions


def verify(
    path: Path, progress: ShowProgress | None = None, max_steps: int = MOST_STEPS, only: Only = None
) -> Verification:
    """Verify a recording up to where it is first damaged; `only`: compare the methods of these keys.

    Raises RecordingError if it is not a recording, is inconsistent, has no samples, or claims more than `max_steps`
    steps: the number is in the file's hands, and the time that they take is not.
    """
    with named(path), open_file(path) as stream:
        scan = Scan(stream, progress)
        budget = StepBudget(max_steps)
        runs = samples = 0
        others: tuple[str, ...] = ()
        max_difference = 0.0
        first: Difference | None = None
        rerun: Rerun | None = None
        for piece in scan:
            if isinstance(piece, Gap):
                break
            others = other_functions(piece.layout.functions)
            budget.show = scan.progress_within(piece)
            for _, (_, value) in scan.entries(piece):
                if isinstance(value, Event) and value.scene is not None:
                    if rerun is not None and value.run <= rerun.run:
                        raise RecordingError("its runs are not in order")
                    if unknown := unknown_in(value.scene, only):
                        raise RecordingError(f"it cannot be verified: this version does not know {unknown}")
                    rerun = Rerun(value, exact=not others, budget=budget, only=only)
                    runs += 1
                if rerun is None or value.run != rerun.run:
                    raise RecordingError(f"data of run {value.run} lies outside that run")
                if isinstance(value, Event):
                    rerun.follow(value)
                    continue
                samples += 1
                for difference in rerun.compare(value):
                    first = first or difference
                max_difference = max(max_difference, rerun.max_difference)
        if samples == 0:
            raise scan.nothing("verified")
        return Verification(
            file=path,
            complete=scan.complete,
            reason=scan.reason,
            runs=runs,
            samples=samples,
            other_functions=others,
            identical=first is None and not scan.damaged,
            sealed=scan.sealed,
            sha256=scan.seal.sha256 if scan.seal else None,
            max_difference=max_difference,
            first_difference=first,
        )


class Rerun:
    """One run, simulated again.  `exact`: its sin is this machine's, so every bit must be the same.

    `max_difference`: the largest so far of any number, within tolerance or not.
    """

    def __init__(self, start: Event, exact: bool = True, budget: StepBudget | None = None, only: Only = None) -> None:
        if start.scene is None or start.step != 0:
            raise RecordingError(f"run {start.run} does not begin at its start")
        scene, self.run = start.scene, start.run
        off = replace(scene, theta=scene.theta * (1 - TOLERANCE), omega=scene.omega * (1 - TOLERANCE))
        self._locksteps = [Lockstep(each, self.run, tiered) for each in ([scene] if exact else [scene, off])]
        self._exact, self._budget, self._only = exact, budget, only
        self._changes: list[Event] = []  # that no sample has come after yet
        self._allowed: dict[tuple[str, str], float] = defaultdict(float)
        self._cast, self._methods = scene.cast, [method.key for method in scene.cast]
        if only is not None and not set(only) & set(self._methods):
            raise RecordingError(f"run {self.run} has none of the methods {', '.join(only)}")
        self._sampled = -1
        self._reached = 0  # the step of the last change
        self.max_difference = 0.0

    def follow(self, event: Event) -> None:
        """Take in a recorded event.  It is applied at the next sample, which shows that its step was reached."""
        if event.kind == "set_h" and event.h is not None:
            if event.step < max(self._reached, self._sampled):
                raise RecordingError(f"the steps of run {self.run} are not in order")
            try:
                Stepping(event.h, event.equal_cost, self._cast).check(self._locksteps[0].scene.w0)
            except SceneError as error:
                raise RecordingError(f"run {self.run} cannot have been recorded: {error}") from error
            self._reached = event.step
            self._changes.append(event)

    def reach(self, step: int) -> list[Sample]:
        """The run's sample at this step; if not `exact`, also that of the run with the changed start."""
        if step <= self._sampled or step < self._reached:
            raise RecordingError(f"the steps of run {self.run} are not in order")
        if self._budget is not None:
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

    def compare(self, recorded: Sample) -> list[Difference]:
        """The differences from a recorded sample."""
        computed, *astray = self.reach(recorded.step)
        for other in astray:
            self._widen(computed, other)
        if self._exact and computed.t == recorded.t and all(map(same_bits, recorded.readings, computed.readings)):
            return []
        return list(self._differences(recorded, computed))

    def _go(self, step: int) -> None:
        """Go to a step.  Many steps are taken in parts, between which progress is shown and Ctrl+C is heard."""
        first, show = self._locksteps[0].step, self._budget and self._budget.show
        at = step if self._budget is None else first
        while at < step:
            at = min(at + STEPS_AT_ONCE, step)
            for lockstep in self._locksteps:
                lockstep.advance(at - lockstep.step)
            if show and step - first > STEPS_AT_ONCE:
                show((at - first) / (step - first))
        for lockstep in self._locksteps:
            lockstep.advance(step - lockstep.step)

    def _differences(self, recorded: Sample, computed: Sample) -> Iterator[Difference]:
        if recorded.t != computed.t:
            self.max_difference = max(self.max_difference, distance(recorded.t, computed.t))
            yield Difference(self.run, recorded.step, recorded.t, "", "t", recorded.t, computed.t)
        for method, was, now in zip(self._methods, recorded.readings, computed.readings, strict=True):
            if self._only is not None and method not in self._only:
                continue
            lost = max(self._allowed[method, name] for name in PHASE) > LOST
            for field, a, b in zip(VALUES, values_of(was), values_of(now), strict=True):
                if field in EXTREMES and a == was.energy_error:
                    continue  # such an extreme claims nothing: see fields.without_extremes
                self.max_difference = max(self.max_difference, distance(a, b))
                if self._exact:
                    equal = a == b and not ulps(a, b)
                else:
                    equal = distance(a, b) <= max(self._allowed[method, field], TOLERANCE * max(1.0, abs(b or 0.0)))
                if not (equal or lost):
                    yield Difference(self.run, recorded.step, recorded.t, method, field, a, b)

    def _widen(self, computed: Sample, astray: Sample) -> None:
        for method, a, b in zip(self._methods, computed.readings, astray.readings, strict=True):
            for field, one, other in zip(VALUES, values_of(a), values_of(b), strict=True):
                apart = distance(one, other)
                self._allowed[method, field] = max(self._allowed[method, field], apart)
