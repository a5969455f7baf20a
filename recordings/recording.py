"""Recording: any moment of a file, without reading the rest.

An unfinished or damaged file opens with what is intact in it.
"""

import zlib
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from io import SEEK_END
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
from recordings.reader import Decoder, Place, Scan, ShowProgress, check_format, read_chunk, read_summary

MAX_EVENTS = 30_000  # 10 MB; a lesson has a few hundred
MAX_CHECKED = 1 << 26  # bytes that are checked whenever a file is opened: 50 ms
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

    `complete`: finished, and nothing is wrong; `damaged`: something was changed or lost; `reason`: what is
    wrong, a clause, or None.  Of a file too long to be checked at opening, damage may show only while it
    plays.  Clocks are in s, from 0 to `length`.
    """

    def __init__(self, path: Path, stream: BinaryIO, check: bool, progress: ShowProgress | None) -> None:
        self.path = path
        self.bytes = stream.seek(0, SEEK_END)
        self.complete = True
        self.damaged = False
        self.reason: str | None = None
        self.events: list[tuple[float, Event]] = []  # each with its clock [s], in the order of recording
        self.runs: list[Run] = []
        self._stream = stream
        self._lost = 0  # entries
        self._places = self._find_places(check, progress)
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
                return cls(path, stream, check, progress)
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
    def samples(self) -> int:
        """The number of samples."""
        try:
            last = read_chunk(self._stream, self._places[-1].offset).messages[-1]
        except (RecordingError, OSError, EOFError):
            return 0
        return last.sequence + 1 - self._lost - self._decoder.others

    def at(self, clock: float) -> SamplePlace | None:
        """Return the last sample at or before that time, or else the first; None if there are none."""
        clock, log_time = _as_recorded(clock)
        chunk = bisect_right(self._places, log_time, key=attrgetter("start")) - 1
        later = bisect_right(self._decode(chunk)[0], clock, key=_clock) if chunk >= 0 else 0
        return self.previous(SamplePlace(chunk, later)) or self.next(SamplePlace(0, -1))

    def sample(self, place: SamplePlace) -> Entry:
        """Return the sample there."""
        return self._decode(place.chunk)[0][place.entry]

    def next(self, place: SamplePlace) -> SamplePlace | None:
        """Return the next sample; None after the last."""
        chunk = place.chunk
        while (chunk := self._sampled.find(1, max(chunk, 0))) >= 0:
            samples = self._decode(chunk)[1]
            at = bisect_right(samples, place.entry) if chunk == place.chunk else 0
            if at < len(samples):
                return SamplePlace(chunk, samples[at])
            chunk += 1
        return None

    def previous(self, place: SamplePlace) -> SamplePlace | None:
        """Return the sample before; None before the first."""
        chunk = place.chunk
        while (chunk := self._sampled.rfind(1, 0, max(chunk, -1) + 1)) >= 0:
            samples = self._decode(chunk)[1]
            at = bisect_left(samples, place.entry) if chunk == place.chunk else len(samples)
            if at > 0:
                return SamplePlace(chunk, samples[at - 1])
            chunk -= 1
        return None

    def entries(self, start: float = 0.0, end: float = inf) -> Iterator[Entry]:
        """Yield all samples and events from `start` to `end` [s], both included, in order."""
        start, log_time = _as_recorded(start)
        end, last = _as_recorded(min(end, self.length))
        for chunk in range(bisect_left(self._places, log_time, key=attrgetter("end")), len(self._places)):
            if self._places[chunk].start > last:
                return
            for entry in self._decode(chunk)[0]:
                if start <= entry.clock <= end:
                    yield entry

    def samples_between(self, start: float = 0.0, end: float = inf) -> Iterator[tuple[float, Sample]]:
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

    def _find_places(self, check: bool, progress: ShowProgress | None) -> list[Place]:
        summary = None if check else read_summary(self._stream)
        if summary is not None:
            is_long = summary.data_end > MAX_CHECKED
            if is_long or _checksum(self._stream, summary.data_end) == summary.data_crc:
                check_format(summary.channels)
                self._decoder = Decoder(summary.channels)
                return summary.places
        scan = Scan(self._stream, progress)
        places = [place for place, _ in scan]
        self._decoder = Decoder(scan.channels)
        self._lost = scan.entries_lost
        self.complete = scan.complete
        self.damaged = scan.damaged
        self.reason = scan.reason
        return places

    def _find_runs(self) -> None:
        """Read all events, and the last sample of each run, which is the last before the next start."""
        starts: list[int] = []  # chunks
        for chunk, place in enumerate(self._places):
            for clock, event in self._entries(chunk, only_events=True) if place.has_events else ():
                assert isinstance(event, Event)
                if event.scene is not None and event.arithmetic is not None:
                    if self.runs and event.run <= self.runs[-1].number:
                        raise RecordingError("its runs are not in order")
                    self.runs.append(Run(event.run, event.scene, event.arithmetic, clock, clock))
                    starts.append(chunk)
                if len(self.events) == MAX_EVENTS:
                    raise RecordingError(f"it has more than {MAX_EVENTS} events")
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
            messages = read_chunk(self._stream, place.offset).messages
            if (messages[0].log_time, messages[-1].log_time) != (place.start, place.end):
                raise RecordingError("a chunk differs from its entry in the summary")
            return list(self._decoder.entries(messages, only_events))
        except (RecordingError, OSError, EOFError) as error:
            self.complete = False
            self.damaged = True
            self.reason = self.reason or str(error) or "a chunk is cut off"
            return []

    def _decode_chunk(self, chunk: int) -> tuple[list[Entry], list[int]]:
        """Return a chunk's entries, their clocks ascending, and where the samples among them are."""
        entries = self._entries(chunk)
        samples = [at for at, (_, value) in enumerate(entries) if isinstance(value, Sample)]
        self._sampled[chunk] = bool(samples)
        return entries, samples


_clock = attrgetter("clock")


def _checksum(stream: BinaryIO, size: int) -> int:
    """Return the checksum of a file's first bytes."""
    crc = 0
    stream.seek(0)
    while size and (block := stream.read(min(size, 1 << 20))):
        crc = zlib.crc32(block, crc)
        size -= len(block)
    return crc


def _as_recorded(clock: float) -> tuple[float, int]:
    """Return the nearest clock that a file can hold, in s and as log_time: files round to nanoseconds."""
    nanoseconds = round(max(clock, 0.0) * 1e9)
    return nanoseconds / 1e9, CLOCK_OFFSET + nanoseconds
