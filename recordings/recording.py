"""Recording: random access to a file, of which as much is read as is intact."""

import sys
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from io import SEEK_END
from math import inf
from operator import attrgetter
from pathlib import Path
from typing import BinaryIO, NamedTuple, Self

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping, SteppingChange
from pendu_tui.engine.run.verdicts import Milestone
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.events import MAX_EVENTS, NOT_INPUTS, Arithmetic, Entry, Event
from pendu_tui.recordings.files import RecordingError, is_stream, named
from pendu_tui.recordings.format import (
    CLOCK_OFFSET,
    EVENTS,
    decode_event,
    decode_readings,
    topics_of,
)
from pendu_tui.recordings.reader import Contents, Group, read_chunk, read_contents

CHUNKS_KEPT = 3  # decoded; playing reads one of them 30 times, stepping over an edge needs two


class SamplePlace(NamedTuple):
    """The place of a sample in a file.  Single steps in a pause share a clock."""

    chunk: int
    entry: int


@dataclass(slots=True)
class Run:
    """One run of a recording."""

    number: int
    scene: Scene
    arithmetic: Arithmetic
    begin: float  # s of the recording clock
    end: float  # s, at its last sample
    steps: int = 0  # at its last sample
    t: float = 0.0  # s, simulated, at its last sample
    events: list[tuple[float, Event]] = field(default_factory=list)  # each with its clock [s]
    topics: tuple[str, ...] = ()  # of its samples
    changes: list[SteppingChange] = field(default_factory=list)  # of its stepping, the start first

    def __post_init__(self) -> None:
        self.topics = topics_of(self.scene)
        self._change(0, 0.0, self.scene.h)

    def add(self, clock: float, event: Event) -> None:
        """Add the next event.  Raises RecordingError for a step that no run could have."""
        self.events.append((clock, event))
        if event.h is not None:
            self._change(event.step, event.t, event.h, event.equal_cost)

    def _change(self, step: int, t: float, h: float, equal_cost: bool = False) -> None:
        stepping = Stepping(h, equal_cost, self.scene.cast)
        try:
            stepping.check(self.scene.w0)
        except InputError as error:
            why = f"run {self.number} cannot have been recorded: {error}"
            raise RecordingError(why) from error
        x = self.changes[-1].x_at(t) if self.changes else 0.0
        self.changes.append(SteppingChange(step, t, stepping, x))

    @property
    def inputs(self) -> int:
        """The number of actions of a user."""
        return sum(event.kind not in NOT_INPUTS for _, event in self.events)

    @property
    def milestones(self) -> list[Milestone]:
        """The milestones, as they were noticed."""
        return [event.milestone for _, event in self.events if event.milestone]


class Recording:
    """A recording that is open for reading.

    `damaged`: something was changed or lost; `reason`: what is wrong, a clause, or None.  Unless
    the file is checked, damage may be found only while it plays.  Clocks are in s.
    """

    def __init__(self, path: Path, stream: BinaryIO, contents: Contents) -> None:
        self.path = path
        self.bytes = stream.seek(0, SEEK_END)
        self.damaged = contents.damaged
        self.reason = contents.reason
        self.entries_lost = contents.entries_lost
        self.events: list[tuple[float, Event]] = []  # as recorded, each with its clock [s]
        self.lost_runs: set[int] = set()  # runs with entries, but without a start
        self._runs: dict[int, Run] = {}
        self._stream = stream
        self._places = contents.places
        self._topics = contents.topics
        self._models: dict[str, str] = {}  # by topic
        self._decode = lru_cache(CHUNKS_KEPT)(self._entries)
        if self._places:
            self._find_runs()
        self.runs = list(self._runs.values())
        if not self.runs or self.at(0.0) is None:
            raise RecordingError(self.reason or "it has no samples")
        self.length = _clock(self._places[-1].end)

    @classmethod
    def open(cls, path: Path, check: bool = False) -> Self:
        """Open a recording; with `check`, verify the checksum of every byte.

        Raises RecordingError if it has another format or no sample.
        """
        with named(path):
            if is_stream(path):
                raise RecordingError("this is a device or a pipe; save it as a file")
            stream = path.open("rb")
            try:
                return cls(path, stream, read_contents(stream, check))
            except BaseException:
                stream.close()
                raise

    def close(self) -> None:
        self._stream.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def complete(self) -> bool:
        """Whether it was finished, and nothing is damaged."""
        return self.reason is None

    @cached_property
    def samples(self) -> int:
        """The number of samples that can be read."""
        return sum(1 for _ in self.samples_between())

    def at(self, clock: float) -> SamplePlace | None:
        """Return the last sample at or before that time, or else the first one."""
        later = bisect_right(self._places, _as_recorded(clock), key=attrgetter("start"))
        chunk = max(0, later - 1)
        entry = bisect_right(self._decode(chunk), round(clock, 9), key=attrgetter("clock"))
        return self.beside(SamplePlace(chunk, entry), -1) or self.beside(SamplePlace(0, -1), 1)

    def sample(self, place: SamplePlace) -> Entry:
        """Return a sample.  Raises RecordingError if the file has lost it since it was found."""
        entries = self._decode(place.chunk)
        if entries[-1].value is None:
            raise RecordingError(f"{self.path}: it was changed while being read.")
        return entries[place.entry]

    def beside(self, place: SamplePlace, direction: int) -> SamplePlace | None:
        """Return the next sample (1) or the one before (-1); None where there is none."""
        chunk, entry = place
        while 0 <= chunk < len(self._places):
            entries = self._decode(chunk)
            entry = min(entry, len(entries)) + direction
            while 0 <= entry < len(entries):
                if isinstance(entries[entry].value, Sample):
                    return SamplePlace(chunk, entry)
                entry += direction
            chunk += direction
            entry = -1 if direction > 0 else sys.maxsize  # before the first, or after the last
        return None

    def entries(self, start: float = 0.0, end: float = inf) -> Iterator[Entry]:
        """Yield samples, events and gaps from `start` to `end` [s], both included, in order."""
        start = round(start, 9)  # as files round
        end = round(min(end, self.length), 9)
        first_chunk = bisect_left(self._places, _as_recorded(start), key=attrgetter("end"))
        for chunk in range(first_chunk, len(self._places)):
            if self._places[chunk].start > _as_recorded(end):
                return
            for entry in self._decode(chunk):
                if start <= entry.clock <= end:
                    yield entry

    def samples_between(
        self, start: float = 0.0, end: float = inf
    ) -> Iterator[tuple[float, Sample]]:
        """Yield the samples from `start` to `end` [s], each with its clock."""
        for clock, value in self.entries(start, end):
            if isinstance(value, Sample):
                yield clock, value

    def run_of(self, number: int) -> Run:
        """Return the run of an entry."""
        return self._runs[number]

    def _find_runs(self) -> None:
        """Read all events, and the last sample of each run."""
        chunks_to_read: list[int] = []  # with a start, and the last
        for chunk, place in enumerate(self._places):
            if not place.may_have_events:
                continue
            for clock, event in self._entries(chunk, only_events=True):
                if isinstance(event, Event):
                    self.events.append((clock, event))
                    self._runs[event.run].add(clock, event)
                    if event.kind == "start":
                        chunks_to_read.append(chunk)
            if len(self.events) > MAX_EVENTS:
                raise RecordingError(f"it has more than {MAX_EVENTS} events")
        for chunk in dict.fromkeys([*chunks_to_read, len(self._places) - 1]):
            entries = self._decode(chunk)
            if last_before := self.beside(SamplePlace(chunk, 0), -1):
                entries = [self.sample(last_before), *entries]
            for clock, sample in entries:
                if isinstance(sample, Sample):
                    run = self._runs[sample.run]
                    run.end = clock
                    run.steps = sample.step
                    run.t = sample.t

    def _entries(self, chunk: int, only_events: bool = False) -> list[Entry]:
        """Return a chunk's entries, with a gap where those before it, or all of them, are lost."""
        place = self._places[chunk]
        gap = [Entry(_clock(place.start), None)]
        try:
            _, groups = read_chunk(self._stream, place.offset)
            if (groups[0].log_time, groups[-1].log_time) != (place.start, place.end):
                raise RecordingError("a chunk differs from its entry in the summary")
            entries = list(self._decoded(groups, only_events))
            if place.is_after_gap:
                return gap + entries
            return entries
        except (RecordingError, OSError) as error:
            self.damaged = True
            self.reason = self.reason or str(error)
            return gap

    def _decoded(self, groups: list[Group], only_events: bool) -> Iterator[Entry]:
        """Yield the entries of a chunk, without those of runs whose start is lost.

        Messages of unknown topics are skipped.  Raises RecordingError for impossible ones.
        """
        for _, log_time, channels, data in groups:
            clock = _clock(log_time)
            topics = tuple(self._topics.get(channel, "") for channel in channels)
            value: Event | Sample
            if topics == (EVENTS,):
                value = self._event(data[0], clock)
            elif topics[0] in self._models and not only_events:
                value = self._sample(data, topics)
            else:
                continue
            if value.run in self._runs:
                yield Entry(clock, value)
            else:
                self.lost_runs.add(value.run)

    def _event(self, data: bytes, clock: float) -> Event:
        """Return the event of a message; the first start of a run adds the run."""
        event = decode_event(data)
        if event.scene is not None and event.arithmetic and event.run not in self._runs:
            run = Run(event.run, event.scene, event.arithmetic, clock, clock)
            self._runs[event.run] = run
            self._models |= dict.fromkeys(run.topics, run.scene.model)
        return event

    def _sample(self, data: list[bytes], topics: tuple[str, ...]) -> Sample:
        sample = decode_readings(data, self._models[topics[0]])
        if sample.run in self._runs and topics != self._runs[sample.run].topics:
            raise RecordingError("a sample is incomplete")
        return sample


def _as_recorded(clock: float) -> int:
    """Return the log_time of a clock [s]: files round to nanoseconds."""
    return CLOCK_OFFSET + round(clock * 1e9)


def _clock(log_time: int) -> float:
    """Return the clock [s] of a log_time."""
    return (log_time - CLOCK_OFFSET) / 1e9
