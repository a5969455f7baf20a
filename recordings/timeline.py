"""Timeline: the events and the runs of a recording, in columns.

A recording may have 100 000 of either.  As objects they would take ten times the memory, and a look through all of
them for those of one run would make whatever is done for each run quadratic.
"""

from abc import abstractmethod
from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import compress
from math import nan
from typing import Any, TypeVar, get_args, overload

from engine.methods import Method
from engine.models import PARAMETERS
from engine.run.lockstep import Sample
from engine.run.observer import Milestone
from engine.scenes import Scene
from recordings.events import Entry, Event, EventKind, method_named, name_of, noticed, scene_named
from recordings.fields import SCENE_NUMBERS

TEXT_LIMIT = 1 << 22  # characters of all the different texts together
_KINDS: tuple[EventKind, ...] = get_args(EventKind)
_EQUAL_COST = 1 << 7  # beside the kind
_NOTHING = -1
_NUMBERS = (*SCENE_NUMBERS, *PARAMETERS)
NOT_DONE = ("start", "stop", "noticed")  # by somebody in a run
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Run:
    """One run of a recording."""

    number: int
    scene: Scene
    begin: float  # s of the recording clock
    end: float  # s, at its last sample
    steps: int  # at its last sample
    t: float  # s simulated, at its last sample
    events: int  # besides start, stop and what was noticed


class _Rows(Sequence[T]):
    """A sequence that makes its items when they are asked for."""

    @abstractmethod
    def _row(self, at: int) -> T: ...

    @overload
    def __getitem__(self, at: int) -> T: ...
    @overload
    def __getitem__(self, at: slice) -> list[T]: ...
    def __getitem__(self, at: int | slice) -> T | list[T]:
        places = range(len(self))[at]
        return self._row(places) if isinstance(places, int) else [self._row(each) for each in places]


class Events(_Rows[tuple[float, Event]]):
    """The events of a recording, each with its clock [s], in the order of recording."""

    def __init__(self) -> None:
        self.clocks = array("d")
        self.runs = array("Q")
        self._steps = array("Q")
        self._t = array("d")
        self._kinds = array("B")
        self._values = array("d")  # of h, speed or a milestone's energy error
        self._extras = array("l")  # the number of a mark's text, of a start's scene, or of what a milestone is
        self._scenes = array("d")  # their numbers, one after the other
        self._names = array("l")  # the numbers of the texts of their names and watches
        self._methods: dict[str, int] = {}  # keys, each once; a file has as many as it has channels, at most
        self._models: dict[str, int] = {}  # likewise
        self._casts = bytearray()  # the numbers of their models and methods, one after the other
        self._cast_ends = array("L", [0])
        self._sorts: dict[tuple[Any, ...], int] = {}  # of milestones, each once
        self._texts: dict[str, int] = {}  # each once
        self._room = TEXT_LIMIT

    def __len__(self) -> int:
        return len(self.clocks)

    @property
    def cut(self) -> bool:
        """Whether the last texts were left out, as all together were too long."""
        return self._room < 0

    def add(self, clock: float, event: Event) -> None:
        extra, value = _NOTHING, event.speed if event.h is None else event.h
        if (scene := event.scene) is not None:
            extra = len(self._cast_ends) - 1
            self._scenes.extend(scene.numbers.get(name, 0.0) for name in _NUMBERS)
            self._names.extend(map(self._number, (scene.name, scene.watch)))
            self._casts.append(self._models.setdefault(scene.model, len(self._models)))
            self._casts.extend(self._methods.setdefault(name_of(method), len(self._methods)) for method in scene.cast)
            self._cast_ends.append(len(self._casts))
        elif (milestone := event.milestone) is not None:
            value = milestone.energy_error
            other = milestone.other and name_of(milestone.other)
            sort = milestone.kind, name_of(milestone.method), milestone.verdict, other
            extra = self._sorts.setdefault(sort, len(self._sorts))
        elif event.text is not None:
            extra = self._number(event.text)
        self.clocks.append(clock)
        self.runs.append(event.run)
        self._steps.append(event.step)
        self._t.append(event.t)
        self._kinds.append(_KINDS.index(event.kind) | _EQUAL_COST * event.equal_cost)
        self._values.append(nan if value is None else value)
        self._extras.append(extra)

    def keep(self, runs: Container[int]) -> None:
        """Forget the events of other runs."""
        kept = [run in runs for run in self.runs]
        if not all(kept):
            for counts in (self.runs, self._steps, self._kinds, self._extras):
                counts[:] = array(counts.typecode, compress(counts, kept))
            for numbers in (self.clocks, self._t, self._values):
                numbers[:] = array("d", compress(numbers, kept))

    def of(self, run: int) -> Iterator[tuple[float, Event]]:
        """The events of one run."""
        return map(self._row, self.places(run))

    def places(self, run: int) -> "array[int]":
        """The places of a run's events."""
        order, runs = self._by_run
        return order[bisect_left(runs, run) : bisect_right(runs, run)]

    def made(self, run: int) -> int:
        """How many events a run has besides start and stop."""
        kinds = (_KINDS[self._kinds[at] & 7] for at in self.places(run))
        return sum(kind not in NOT_DONE for kind in kinds)

    def done(self) -> Iterator[float]:
        """The clocks of all but the stops [s]."""
        return (clock for clock, kind in zip(self.clocks, self._kinds, strict=True) if _KINDS[kind & 7] != "stop")

    def start_of(self, run: int) -> Scene | None:
        """The scene of a run's start."""
        kinds = ((at, _KINDS[self._kinds[at] & 7]) for at in self.places(run))
        return next((self._scene(self._extras[at]) for at, kind in kinds if kind == "start"), None)

    def milestones(self, run: int) -> list[tuple[float, Milestone]]:
        """The milestones of a run, each with its clock [s], in the order of recording."""
        found = (self._row(at) for at in self.places(run) if _KINDS[self._kinds[at] & 7] == "noticed")
        return [(clock, event.milestone) for clock, event in found if event.milestone is not None]

    def starts(self) -> Iterator[int]:
        """The places of the starts."""
        return (at for at, kind in enumerate(self._kinds) if kind == _KINDS.index("start"))

    def head(self, at: int) -> tuple[float, int, int, float]:
        """Clock [s], run, step and simulated time [s]."""
        return self.clocks[at], self.runs[at], self._steps[at], self._t[at]

    @cached_property
    def _by_run(self) -> "tuple[array[int], array[int]]":
        order = array("L", sorted(range(len(self)), key=self.runs.__getitem__))
        return order, array("Q", map(self.runs.__getitem__, order))

    @cached_property
    def _known(self) -> tuple[list[Method], list[str], list[tuple[Any, ...]]]:
        return [method_named(key) for key in self._methods], list(self._models), list(self._sorts)

    @cached_property
    def _known_texts(self) -> list[str]:
        return list(self._texts)

    def _number(self, text: str) -> int:
        if text not in self._texts:
            self._room -= len(text)
            if self._room < 0:
                text = "…"
        return self._texts.setdefault(text, len(self._texts))

    def _row(self, at: int) -> tuple[float, Event]:
        kind, extra = _KINDS[self._kinds[at] & 7], self._extras[at]
        clock, run, step, t = self.head(at)
        if kind == "noticed":
            what, name, verdict, other = self._known[2][extra]
            method, passed = method_named(name), other and method_named(other)
            return clock, noticed(run, Milestone(what, method, step, t, self._values[at], verdict, passed))
        event = Event(
            kind,
            run,
            step,
            t,
            scene=self._scene(extra) if kind == "start" else None,
            h=self._values[at] if kind == "set_h" else None,
            equal_cost=self._kinds[at] >= _EQUAL_COST,
            speed=self._values[at] if kind == "speed" else None,
            text=self._known_texts[extra] if kind == "mark" and extra != _NOTHING else None,
        )
        return clock, event

    def _scene(self, number: int) -> Scene:
        name, watch = (self._known_texts[text] for text in self._names[2 * number : 2 * number + 2])
        count = len(_NUMBERS)
        values = self._scenes[count * number : count * (number + 1)]
        numbers: dict[str, Any] = dict(zip(_NUMBERS, values, strict=True))
        model, *methods = self._casts[self._cast_ends[number] : self._cast_ends[number + 1]]
        cast = tuple(self._known[0][method] for method in methods)
        return scene_named(name, watch=watch, model=self._known[1][model], cast=cast, **numbers)


class Runs(_Rows[Run]):
    """The runs of a recording, in the order of their numbers."""

    def __init__(self, events: Events) -> None:
        self.numbers = array("Q")
        self._events = events
        self._starts = array("L")  # where they are among the events
        self._ends = array("d")
        self._steps = array("Q")
        self._t = array("d")

    def __len__(self) -> int:
        return len(self.numbers)

    def add(self, start: int, last: Entry | None) -> None:
        """Add the next one: where its start is among the events, and the last sample before the next run's."""
        clock, number, step, t = self._events.head(start)
        if last is not None and isinstance(last.value, Sample) and last.value.run == number:
            clock, step, t = last.clock, last.value.step, last.value.t
        self.numbers.append(number)
        self._starts.append(start)
        self._ends.append(clock)
        self._steps.append(step)
        self._t.append(t)

    def place(self, number: int) -> int:
        """Where the run of this number is."""
        return bisect_left(self.numbers, number)

    def _row(self, at: int) -> Run:
        begin, start = self._events[self._starts[at]]
        assert start.scene is not None
        made = self._events.made(start.run)
        return Run(start.run, start.scene, begin, self._ends[at], self._steps[at], self._t[at], made)
