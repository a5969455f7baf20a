"""Diff: what was done differently in two recordings, and where their numbers part.

Runs are paired by number, samples by the time that was simulated up to them.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import isclose
from typing import Any, NamedTuple

from engine.run.lockstep import Reading, Sample
from recordings.events import NOT_DONE, Event
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
    method: str  # "" for the time itself
    field: str
    a: float | None
    b: float | None


@dataclass(slots=True)
class MethodErrors:
    """A method's errors in both recordings, at equal times."""

    a: float = 0.0  # the largest energy error
    b: float = 0.0
    theta_difference: float = 0.0  # rad, the largest
    t: float | None = None  # s, simulated, where theta differs most


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
    errors: dict[str, MethodErrors] = field(default_factory=dict)  # by method

    @property
    def identical(self) -> bool:
        """Whether all events and all numbers are the same."""
        return not (self.done or self.first or self.only_in_a or self.only_in_b)


def compare(a: Recording, b: Recording, progress: ShowProgress | None = None) -> Comparison:
    """Compare two open recordings, a damaged one as far as it is intact."""
    result = Comparison(list(_done(a, b)))
    for one, other in _paired(_timed(a), _timed(b)):
        if one is None:
            result.only_in_b += 1
        elif other is None:
            result.only_in_a += 1
        else:
            readings = [
                dict(zip(recording.methods_of(one.run), sample.readings, strict=True))
                for recording, sample in ((a, one), (b, other))
            ]
            _take(result, one, other, *readings)
        if progress:
            progress(result.samples + max(result.only_in_a, result.only_in_b), a.samples)
    return result


def _done(a: Recording, b: Recording) -> Iterator[tuple[str, str, str]]:
    """Yield what was done differently in each run."""
    for number in sorted({run.number for run in (*a.runs, *b.runs)}):
        runs = [a.run_of(number), b.run_of(number)]
        starts = [_start(run) for run in runs]
        for name in {**starts[0], **starts[1]}:
            values = [str(start.get(name, "-")) for start in starts]
            if values[0] != values[1]:
                yield f"run {number}, {name}", values[0], values[1]
        events = [Counter(_events(run)) for run in runs]
        for where, what in (events[0] - events[1]).elements():
            yield f"run {number}, {where}", what, "-"
        for where, what in (events[1] - events[0]).elements():
            yield f"run {number}, {where}", "-", what


def _start(run: Run | None) -> dict[str, Any]:
    if run is None:
        return {}
    methods = ", ".join(method.key for method in run.scene.cast)
    return {"model": run.scene.model, "methods": methods, **run.scene.numbers}


def _events(run: Run | None) -> Iterator[tuple[str, str]]:
    for _, event in run.events if run else ():
        if isinstance(event, Event) and event.kind not in NOT_DONE:
            value = event.h or event.speed or event.text or ""
            cost = " at equal cost" if event.equal_cost else ""
            yield f"step {event.step}, t = {event.t:g} s", f"{event.kind} {value}{cost}".strip()


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


def _paired(a: Iterator[Timed], b: Iterator[Timed]) -> Iterator[tuple[Sample | None, Sample | None]]:
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


def _take(result: Comparison, a: Sample, b: Sample, ours: dict[str, Reading], theirs: dict[str, Reading]) -> None:
    """Take a pair of samples into the result."""
    result.samples += 1
    differences = []
    for key in [key for key in ours if key in theirs]:
        x, y = ours[key], theirs[key]
        errors = result.errors.setdefault(key, MethodErrors())
        errors.a = max(errors.a, x.max_energy_error)
        errors.b = max(errors.b, y.max_energy_error)
        if same_bits(x, y):
            continue
        apart = distance(x.theta, y.theta)
        if apart > errors.theta_difference:
            errors.theta_difference, errors.t = apart, a.t
        for name, value, other in zip(VALUES, values_of(x), values_of(y), strict=True):
            if name not in EXTREMES and (value != other or ulps(value, other)):
                differences.append(Difference(a.run, a.step, b.step, a.t, key, name, value, other))
    result.different += bool(differences)
    if differences and result.first is None:
        order = list(ours)
        result.first = min(differences, key=lambda each: order.index(each.method))
