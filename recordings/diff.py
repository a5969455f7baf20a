"""Diff: the differences of two recordings: scenes, methods, events, and every number that both have.

Runs are paired by number, samples by step.  Where the runs step differently, samples are paired by the time that was
simulated up to them, so that the same swing at two step sizes can be held side by side.
"""

from collections import Counter
from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import isclose
from typing import Any, NamedTuple

from engine.models import PARAMETERS
from engine.run.lockstep import Reading, Sample
from engine.scenes import Scene
from recordings.events import Event
from recordings.fields import EXTREMES, VALUES, distance, same_bits, ulps, values_of
from recordings.recording import Recording
from recordings.scan import ShowProgress
from recordings.timeline import NOT_DONE

SAME_TIME = 1e-9  # of the simulated time: a multiple of h is rounded to a few parts in 10^16
SHOW_EVERY = 1000  # samples

MethodsOf = Callable[[int], tuple[str, ...]]
"""The methods of a run."""


@dataclass(frozen=True, slots=True)
class SceneDifference:
    """A number or a name of a run's start."""

    run: int
    field: str
    a: float | str
    b: float | str


@dataclass(frozen=True, slots=True)
class EventDifference:
    """An event of one of the recordings only."""

    only_in: str  # "a" or "b"
    event: Event


@dataclass(frozen=True, slots=True)
class ValueDifference:
    """A number that is not the same to the last bit."""

    run: int
    step: int  # of a
    step_b: int
    t: float  # s, simulated, of a
    method: str  # "" for the time itself
    field: str
    a: float | None
    b: float | None

    @property
    def ulps(self) -> int | None:
        """Their distance in doubles; None if one is missing."""
        return ulps(self.a, self.b)


@dataclass(slots=True)
class MethodErrors:
    """A method's errors in both recordings, and the largest differences between them."""

    max_energy_error: list[float | None] = field(default_factory=lambda: [None, None])  # of a and b; None: not in it
    theta_difference: float = 0.0  # rad, the largest of paired samples
    energy_error_difference: float = 0.0  # likewise
    run: int | None = None  # where theta differs most
    t: float | None = None  # s, of a

    def take(self, sample: Sample, a: Reading, b: Reading) -> None:
        """Take in the readings of a pair; `sample` is a's."""
        if (apart := distance(a.theta, b.theta)) > self.theta_difference:
            self.theta_difference, self.run, self.t = apart, sample.run, sample.t
        self.energy_error_difference = max(self.energy_error_difference, distance(a.energy_error, b.energy_error))


@dataclass(slots=True)
class Comparison:
    """The result of `compare`."""

    scenes: list[SceneDifference]
    runs_only: tuple[list[int], list[int]]  # numbers of runs in a, or in b, only
    methods_only: tuple[list[str], list[str]]
    events: list[EventDifference]
    errors: dict[str, MethodErrors]  # of each method
    first: ValueDifference | None = None
    paired: int = 0  # samples
    differing: int = 0  # of them
    unpaired: list[int] = field(default_factory=lambda: [0, 0])  # samples in a, or in b, only

    @property
    def identical(self) -> bool:
        """Whether all events and all numbers are the same."""
        only_in_one = (*self.runs_only, *self.methods_only, *self.unpaired)
        return not (self.scenes or self.events or self.first or any(only_in_one))


def compare(a: Recording, b: Recording, progress: ShowProgress | None = None) -> Comparison:
    """Compare two open recordings, a damaged one as far as it is intact; memory does not grow with their samples."""
    scenes = {run.number: run.scene for run in a.runs}, {run.number: run.scene for run in b.runs}
    common = [number for number in scenes[0] if number in scenes[1]]
    starts = ((number, _fields(scenes[0][number]), _fields(scenes[1][number])) for number in common)
    result = Comparison(
        [SceneDifference(run, name, x[name], y[name]) for run, x, y in starts for name in x if x[name] != y[name]],
        (sorted(scenes[0].keys() - scenes[1].keys()), sorted(scenes[1].keys() - scenes[0].keys())),
        ([key for key in a.methods if key not in b.methods], [key for key in b.methods if key not in a.methods]),
        [difference for number in common for difference in _events(a, b, number)],
        {key: MethodErrors() for key in dict.fromkeys((*a.methods, *b.methods))},
    )
    by_step = {number for number in common if _stepping(a, number) == _stepping(b, number)}
    pairing = _Pairing((a.methods_of, b.methods_of), by_step, result)
    for done, (one, other) in enumerate(_paired(_moments(a, by_step), _moments(b, by_step)), 1):
        pairing.take(one, other)
        if progress and done % SHOW_EVERY == 0:
            progress(2 * result.paired + sum(result.unpaired), a.samples + b.samples)
    return result


def _fields(scene: Scene) -> dict[str, Any]:
    """The start of a run, as numbers and texts."""
    parameters = {name: scene.parameters.get(name, 0.0) for name in PARAMETERS}  # 0.0 of models without
    return scene.fields() | parameters | {"methods": ", ".join(method.key for method in scene.cast)}


def _events(a: Recording, b: Recording, run: int) -> Iterator[EventDifference]:
    """The events of one of them only, a's first."""
    done = [[event for _, event in each.events.of(run) if event.kind not in NOT_DONE] for each in (a, b)]
    for side, only_in in enumerate("ab"):
        left = Counter(done[1 - side])
        for event in done[side]:
            if left[event]:
                left[event] -= 1
            else:
                yield EventDifference(only_in, event)


def _stepping(recording: Recording, run: int) -> list[tuple[int, float | None, bool]]:
    """How a run steps: (from which step on, h, equal cost)."""
    return [
        (event.step, event.scene.h if event.scene else event.h, event.equal_cost)
        for _, event in recording.events.of(run)
        if event.kind in ("start", "set_h")
    ]


class _Moment(NamedTuple):
    """Where a sample belongs in order to be paired."""

    run: int
    place: float  # steps, or s simulated, since the run's start
    sample: Sample


def _moments(recording: Recording, by_step: Container[int]) -> Iterator[_Moment]:
    """The samples of a recording.  Time that runs backwards adds to what was simulated, too."""
    simulated = t = 0.0
    for _, value in recording.entries():
        if isinstance(value, Event) and value.kind == "start":
            simulated = t = 0.0
        simulated, t = simulated + abs(value.t - t), value.t
        if isinstance(value, Sample):
            yield _Moment(value.run, value.step if value.run in by_step else simulated, value)


def _paired(a: Iterator[_Moment], b: Iterator[_Moment]) -> Iterator[tuple[Sample | None, Sample | None]]:
    """The samples of both in order, those of the same moment together."""
    one, other = next(a, None), next(b, None)
    while one or other:
        same = one and other and one.run == other.run and isclose(one.place, other.place, rel_tol=SAME_TIME)
        first = one is not None and (other is None or one[:2] < other[:2])
        yield one.sample if one and (same or first) else None, other.sample if other and (same or not first) else None
        one, other = next(a, None) if same or first else one, next(b, None) if same or not first else other


class _Pairing:
    """Takes pairs of samples into a comparison."""

    def __init__(self, methods: tuple[MethodsOf, MethodsOf], by_step: Container[int], result: Comparison) -> None:
        self._methods, self._by_step, self._result = methods, by_step, result
        self._gap = False  # a sample had no counterpart, so that extremes since then are not about the same steps

    def take(self, *pair: Sample | None) -> None:
        """The next pair, or a sample without a counterpart."""
        readings: list[dict[str, Reading]] = [{}, {}]
        for side, sample in enumerate(pair):
            if sample is None:
                continue
            readings[side] = dict(zip(self._methods[side](sample.run), sample.readings, strict=True))
            for key, reading in readings[side].items():
                worst = self._result.errors[key].max_energy_error
                worst[side] = max(worst[side] or 0.0, reading.max_energy_error)
        a, b = pair
        if a is None or b is None:
            self._result.unpaired[a is None] += 1
            self._gap = True
            return
        self._result.paired += 1
        differences = list(self._differences(a, b, *readings))
        self._result.differing += bool(differences)
        self._result.first = self._result.first or next(iter(differences), None)
        self._gap = False

    def _differences(
        self, a: Sample, b: Sample, ours: Mapping[str, Reading], theirs: Mapping[str, Reading]
    ) -> Iterator[ValueDifference]:
        at = ValueDifference(a.run, a.step, b.step, a.t, "", "t", a.t, b.t)
        if a.run in self._by_step and a.t != b.t:
            yield at
        for key, one in ours.items():
            other = theirs.get(key)
            if other is None or same_bits(one, other):
                continue
            self._result.errors[key].take(a, one, other)
            for name, x, y in zip(VALUES, values_of(one), values_of(other), strict=True):
                if name in EXTREMES and (self._gap or x == one.energy_error or y == other.energy_error):
                    continue  # it claims nothing, see fields.without_extremes, or they are about different steps
                if x != y or ulps(x, y):
                    yield replace(at, method=key, field=name, a=x, b=y)
