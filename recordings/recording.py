"""Recording: any moment of a file, without reading the rest.

An unfinished or damaged file opens with what is intact in it.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from io import SEEK_END
from itertools import islice
from math import inf
from operator import attrgetter
from pathlib import Path
from typing import BinaryIO, NamedTuple, Self

from engine.run.judgement import Milestone
from engine.run.lockstep import Sample
from engine.scenes import Scene
from recordings.arithmetic import Arithmetic
from recordings.errors import RecordingError, named
from recordings.events import NOT_DONE, Entry, Event
from recordings.format import CLOCK_OFFSET
from recordings.library import open_file
from recordings.reader import Contents, Decoder, ShowProgress, read_chunk, read_contents

MAX_EVENTS = 100_000  # 30 MB; a lesson has a few hundred
MAX_RUNS = 20_000
CHUNKS_KEPT = 3  # decoded; playing meets the same one thirty times, stepping about an edge two


class SamplePlace(NamedTuple):
    """Where in a file a sample is.  Samples may share a clock: single steps while paused."""

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
    t: float = 0.0  # s simulated, at its last sample
    events: list[tuple[float, Event]] = field(default_factory=list)  # each with its clock [s]

    @property
    def inputs(self) -> int:
        """How many things somebody did in it."""
        return sum(event.kind not in NOT_DONE for _, event in self.events)

    @property
    def milestones(self) -> list[Milestone]:
        """What the lab noticed, by step."""
        found = (event.milestone for _, event in self.events if event.milestone)
        return sorted(found, key=attrgetter("step"))


class Recording:
    """A recording that is open for reading.

    `complete`: finished, and nothing is wrong; `damaged`: something was changed or lost; `reason`:
    what is wrong, a clause, or None.  Of a file too long to be checked at opening, damage may show
    only while it plays.  Clocks are in s, from 0 to `length`.
    """

    def __init__(self, path: Path, stream: BinaryIO, contents: Contents) -> None:
        self.path = path
        self.bytes = stream.seek(0, SEEK_END)
        self.damaged = contents.damaged
        self.reason = contents.reason
        self.entries_lost = contents.entries_lost
        self.events: list[
            tuple[float, Event]
        ] = []  # each with its clock [s], in the order of recording
        self.runs: list[Run] = []
        self._stream = stream
        self._places = contents.places
        self._decoder = Decoder(contents.channels)
        self._decode = lru_cache(CHUNKS_KEPT)(self._decode_chunk)
        self._sampled = bytearray(b"\1" * len(self._places))  # 0: no samples in this chunk
        self._find_runs()
        self.about = self._decoder.about  # where and how it was made
        self.length = (self._places[-1].end - CLOCK_OFFSET) / 1e9
        self.models = tuple(dict.fromkeys(run.scene.model for run in self.runs))
        methods = (method.key for run in self.runs for method in run.scene.cast)
        self.methods = tuple(dict.fromkeys(methods))

    @classmethod
    def open(cls, path: Path, check: bool = False, progress: ShowProgress | None = None) -> Self:
        """Open a recording; with `check`, check every byte of it.

        Raises RecordingError, a sentence, if it is not one of this format or has no run in it.
        """
        with named(path):
            stream = open_file(path)
            try:
                return cls(path, stream, read_contents(stream, check, progress))
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
        """Whether it was finished, and nothing is wrong."""
        return self.reason is None

    @property
    def runs_lost(self) -> int:
        """The number of runs of which something was read, but not the start."""
        return len(self._decoder.lost_runs)

    @property
    def samples(self) -> int:
        """The number of samples."""
        try:
            last = read_chunk(self._stream, self._places[-1].offset)[1][-1]
        except (RecordingError, OSError, EOFError):
            return 0
        return last.sequence + 1 - self.entries_lost - self._decoder.others

    def at(self, clock: float) -> SamplePlace | None:
        """Return the last sample at or before that time, or else the first, if any."""
        chunk = bisect_right(self._places, _as_recorded(clock), key=attrgetter("start")) - 1
        entries = self._decode(chunk)[0] if chunk >= 0 else []
        later = bisect_right(entries, round(clock, 9), key=attrgetter("clock"))
        return self.previous(SamplePlace(chunk, later)) or self.next(SamplePlace(0, -1))

    def sample(self, place: SamplePlace) -> Entry:
        """Return the sample there."""
        return self._decode(place.chunk)[0][place.entry]

    def next(self, place: SamplePlace) -> SamplePlace | None:
        """Return the next sample; None after the last."""
        chunk = place.chunk
        while (chunk := self._sampled.find(1, max(chunk, 0))) >= 0:
            for index in self._decode(chunk)[1]:
                if (chunk, index) > place:
                    return SamplePlace(chunk, index)
            chunk += 1
        return None

    def previous(self, place: SamplePlace) -> SamplePlace | None:
        """Return the sample before; None before the first."""
        chunk = place.chunk
        while (chunk := self._sampled.rfind(1, 0, max(chunk, -1) + 1)) >= 0:
            for index in reversed(self._decode(chunk)[1]):
                if (chunk, index) < place:
                    return SamplePlace(chunk, index)
            chunk -= 1
        return None

    def chunks(self, start: float = 0.0, end: float = inf) -> Iterator[tuple[bool, list[Entry]]]:
        """Yield the entries of each chunk of that time, and whether it follows a gap."""
        first, last = _as_recorded(start), _as_recorded(min(end, self.length))
        begin = bisect_left(self._places, first, key=attrgetter("end"))
        for chunk, place in enumerate(islice(self._places, begin, None), begin):
            if place.start > last:
                return
            yield place.is_after_gap, self._decode(chunk)[0]

    def entries(self, start: float = 0.0, end: float = inf) -> Iterator[Entry]:
        """Yield all samples and events from `start` to `end` [s], both included, in order."""
        start, end = round(start, 9), round(end, 9)  # as files round
        for _, entries in self.chunks(start, end):
            for entry in entries:
                if start <= entry.clock <= end:
                    yield entry

    def samples_between(
        self, start: float = 0.0, end: float = inf
    ) -> Iterator[tuple[float, Sample]]:
        """Yield the samples of that time, each with its clock [s]."""
        for clock, value in self.entries(start, end):
            if isinstance(value, Sample):
                yield clock, value

    def run_of(self, number: int) -> Run | None:
        """Return the run of this number."""
        at = bisect_left(self.runs, number, key=attrgetter("number"))
        return self.runs[at] if self.runs[at : at + 1] and self.runs[at].number == number else None

    def methods_of(self, number: int) -> tuple[str, ...]:
        """Return the methods of a run, in its order."""
        run = self.run_of(number)
        return tuple(method.key for method in run.scene.cast) if run else ()

    def _find_runs(self) -> None:
        """Read all events, and the last sample of each run, the last before the next start."""
        starts: list[int] = []  # chunks
        for chunk, place in enumerate(self._places):
            for clock, event in self._entries(chunk, only_events=True) if place.has_events else ():
                assert isinstance(event, Event)
                if event.scene is not None and event.arithmetic is not None:
                    if self.runs and event.run <= self.runs[-1].number:
                        raise RecordingError("its runs are not in order")
                    self.runs.append(Run(event.run, event.scene, event.arithmetic, clock, clock))
                    starts.append(chunk)
                if len(self.events) == MAX_EVENTS or len(self.runs) > MAX_RUNS:
                    raise RecordingError(f"it has more than {MAX_EVENTS} events or {MAX_RUNS} runs")
                self.events.append((clock, event))
                if run := self.run_of(event.run):
                    run.events.append((clock, event))
        if not self.runs:
            raise RecordingError(self.reason or "it has no runs")
        places = {
            entry.value.run: SamplePlace(chunk, index)
            for chunk in dict.fromkeys(starts)
            for index, entry in enumerate(self._decode(chunk)[0])
            if isinstance(entry.value, Event) and entry.value.kind == "start"
        }
        ends = [places.get(run.number) for run in self.runs[1:]]
        for run, end in zip(self.runs, [*ends, SamplePlace(len(self._places), 0)], strict=True):
            if end is None:  # its chunk is damaged but for its events
                continue
            last = self.previous(end)
            clock, sample = self.sample(last) if last else (0.0, None)
            if isinstance(sample, Sample) and sample.run == run.number:
                run.end, run.steps, run.t = clock, sample.step, sample.t

    def _entries(self, chunk: int, only_events: bool = False) -> list[Entry]:
        """Return a chunk's entries; none if it turns out to be damaged."""
        place = self._places[chunk]
        try:
            _, messages = read_chunk(self._stream, place.offset)
            if (messages[0].log_time, messages[-1].log_time) != (place.start, place.end):
                raise RecordingError("a chunk differs from its entry in the summary")
            return list(self._decoder.entries(messages, only_events))
        except (RecordingError, OSError, EOFError) as error:
            self.damaged = True
            self.reason = self.reason or str(error) or "a chunk is cut off"
            return []

    def _decode_chunk(self, chunk: int) -> tuple[list[Entry], list[int]]:
        """Return a chunk's entries, and where the samples among them are."""
        entries = self._entries(chunk)
        samples = [at for at, (_, value) in enumerate(entries) if isinstance(value, Sample)]
        self._sampled[chunk] = bool(samples)
        return entries, samples


def _as_recorded(clock: float) -> int:
    """Return the log_time of a clock [s]: files round to nanoseconds."""
    return CLOCK_OFFSET + round(max(clock, 0.0) * 1e9)
