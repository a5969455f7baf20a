"""Diff: what was done differently in two recordings, and where their numbers part.

Runs are paired by number, samples by the time that was simulated up to them.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import isclose
from typing import NamedTuple

from engine.run.lockstep import Reading, Sample
from recordings.events import NOT_DONE, name_of
from recordings.fields import EXTREMES, VALUES, distance, same_bits, ulps, values_of
from recordings.reader import ShowProgress
from recordings.recording import Recording, Run

SAME_TIME = 1e-9  # of the simulated time: a multiple of h is rounded to a few parts in 10^16


class Difference(NamedTuple):
    """A number that is not the same to the last bit."""

    run: int
    step_a: int
    step_b: int
    t: float  # s, simulated
    method: str
    field: str
    a: float | None
    b: float | None


@dataclass(slots=True)
class Comparison:
    """The result of `compare`."""

    done: list[tuple[str, str, str]] = field(default_factory=list)
    """What was done differently: where, in a, in b."""
    first: Difference | None = None
    samples: int = 0  # at equal times
    different: int = 0  # of them
    only_in_a: int = 0  # samples
    only_in_b: int = 0
    errors: dict[str, dict[str, float]] = field(default_factory=dict)
    """By method, at equal times: the largest energy error in a and in b, the largest difference in
    theta [rad], and the simulated time t of that [s]."""

    @property
    def identical(self) -> bool:
        """Whether all events and all numbers are the same."""
        return not (self.done or self.first or self.only_in_a or self.only_in_b)


def compare(a: Recording, b: Recording, progress: ShowProgress | None = None) -> Comparison:
    """Compare two open recordings, a damaged one as far as it is intact."""
    result = Comparison(list(_done(a, b)))
    for one, other in _paired(_timed(a), _timed(b)):
        result.only_in_a += other is None
        result.only_in_b += one is None
        if one and other:
            _take(result, one, other, _readings(a, one), _readings(b, other))
        if progress:
            progress(result.samples + max(result.only_in_a, result.only_in_b), a.samples)
    return result


def _done(a: Recording, b: Recording) -> Iterator[tuple[str, str, str]]:
    """Yield what was done differently in each run."""
    for number in sorted({run.number for run in (*a.runs, *b.runs)}):
        one, other = (Counter(_inputs(recording.run_of(number))) for recording in (a, b))
        in_a, in_b = dict((one - other).elements()), dict((other - one).elements())
        for where in in_a | in_b:
            yield f"run {number}, {where}", in_a.get(where, "-"), in_b.get(where, "-")


def _inputs(run: Run | None) -> Iterator[tuple[str, str]]:
    """Yield all that determines a run, as where and what."""
    if run is None:
        return
    yield "model", run.scene.model
    yield "methods", ", ".join(name_of(method) for method in run.scene.cast)
    yield from ((name, str(value)) for name, value in run.scene.numbers.items())
    for _, event in run.events:
        if event.kind not in NOT_DONE:
            value = event.h or event.speed or event.text or ""
            cost = " at equal cost" if event.equal_cost else ""
            where = f"{event.kind} at step {event.step}, t = {event.t:g} s"
            yield where, f"{value}{cost}".strip() or event.kind


Timed = tuple[int, float, Sample]
"""Run, time simulated since its start [s], sample."""


def _timed(recording: Recording) -> Iterator[Timed]:
    """Yield the samples.  Time that runs backwards adds to what was simulated, too."""
    run, elapsed, t = 0, 0.0, 0.0
    for _, sample in recording.samples_between():
        if sample.run != run:
            run, elapsed, t = sample.run, 0.0, 0.0
        elapsed += abs(sample.t - t)
        t = sample.t
        yield run, elapsed, sample


def _paired(
    a: Iterator[Timed], b: Iterator[Timed]
) -> Iterator[tuple[Sample | None, Sample | None]]:
    """Yield the samples of both in order, those of one time together."""
    one, other = next(a, None), next(b, None)
    while one or other:
        if one and other and one[0] == other[0] and isclose(one[1], other[1], rel_tol=SAME_TIME):
            yield one[2], other[2]
            one, other = next(a, None), next(b, None)
        elif one and (not other or one[:2] < other[:2]):
            yield one[2], None
            one = next(a, None)
        elif other:
            yield None, other[2]
            other = next(b, None)


def _readings(recording: Recording, sample: Sample) -> dict[str, Reading]:
    return dict(zip(recording.methods_of(sample.run), sample.readings, strict=True))


def _take(
    result: Comparison, a: Sample, b: Sample, ours: dict[str, Reading], theirs: dict[str, Reading]
) -> None:
    """Take a pair of samples into the result."""
    result.samples += 1
    is_same = True
    for key, x in ours.items():
        if (y := theirs.get(key)) is None:
            continue
        errors = result.errors.setdefault(
            key, dict.fromkeys(("a", "b", "theta_difference", "t"), 0.0)
        )
        errors["a"] = max(errors["a"], x.max_energy_error)
        errors["b"] = max(errors["b"], y.max_energy_error)
        if same_bits(x, y):
            continue
        apart = distance(x.theta, y.theta)
        if apart > errors["theta_difference"]:
            errors |= {"theta_difference": apart, "t": a.t}
        for name, value, other in zip(VALUES, values_of(x), values_of(y), strict=True):
            if name not in EXTREMES and (value != other or ulps(value, other)):
                is_same = False
                first = Difference(a.run, a.step, b.step, a.t, key, name, value, other)
                result.first = result.first or first
    result.different += not is_same
