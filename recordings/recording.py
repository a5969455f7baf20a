"""Recording: any moment of a file, without reading the rest.

An unfinished or damaged file opens with what is intact in it.
"""

from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from functools import lru_cache
from io import SEEK_END
from itertools import groupby, islice, pairwise
from operator import attrgetter, itemgetter
from pathlib import Path
from typing import BinaryIO, NamedTuple, Self

from mcap.opcode import Opcode

from engine.run.lockstep import Sample
from recordings.contents import Contents, from_summary
from recordings.errors import RecordingError, named
from recordings.events import Entry, Event
from recordings.format import CLOCK_LIMIT, CLOCK_OFFSET
from recordings.framing import read_chunk, record_at
from recordings.library import open_file
from recordings.scan import Scan, ShowProgress
from recordings.timeline import Events, Runs

EVENT_LIMIT = 100_000  # in memory all at once, 30 MB; a lesson has a few hundred, but each step back repeats them
CHUNKS_KEPT = 2  # decoded; playing meets the same one thirty times, stepping to and fro about an edge two
_BEYOND = 1 << 62  # the last entry of any chunk


class SamplePlace(NamedTuple):
    """Where in a file a sample is.  Samples may share a clock: single steps while paused do not advance it."""

    chunk: int
    entry: int


class _Decoded(NamedTuple):
    """A chunk's entries, their clocks and runs ascending, and where the samples among them are."""

    entries: "tuple[Entry, ...]"
    samples: "array[int]"


class Recording:
    """A recording that is open for reading.

    `complete`: finished, and nothing is wrong; `damaged`: something was changed or lost; `reason`:
    what is wrong, a clause, or None; `sealed`: whether its digests are right, or None where it has none or they were
    not checked.  In a file too long to be checked at opening, damage may show
    only while it plays.  Clocks are in s, from 0 to `length`.
    """

    def __init__(self, path: Path, stream: BinaryIO, contents: Contents) -> None:
        self.path = path
        self.bytes = stream.seek(0, SEEK_END)
        self.metadata = contents.metadata
        self.version, self.functions = contents.layout.version, contents.layout.functions
        self.keys = tuple(contents.layout.methods.values())  # model and method of each topic
        self.methods = tuple(dict.fromkeys(method for _, method in self.keys))
        self.models = tuple(dict.fromkeys(model for model, _ in self.keys))
        self.samples, self.seal, self.sealed = contents.samples, contents.seal, contents.sealed
        self.complete, self.damaged, self.reason = contents.complete, contents.damaged, contents.reason
        self.length = (contents.chunks.ends[-1] - CLOCK_OFFSET) / 1e9 if contents.chunks else 0.0
        self._stream, self._layout, self._chunks = stream, contents.layout, contents.chunks
        self._decoded = lru_cache(CHUNKS_KEPT)(self._decode)
        self.methods_of = lru_cache(1)(self._methods_of)
        self._sampled = bytearray(b"\1" * len(self._chunks))  # 0 once a chunk turned out to hold no samples
        self.events = Events()
        starts: list[tuple[int, int]] = []  # chunk, run
        for chunk, clock, event in self._read_events():
            if event.kind == "start":
                starts.append((chunk, event.run))
            self.events.add(clock, event)
        if any(run >= following for (_, run), (_, following) in pairwise(starts)):
            raise RecordingError("its runs are not in order")
        if not starts:
            raise RecordingError("the starts of all its runs are lost")
        self._known = frozenset(run for _, run in starts)
        self.events.keep(self._known)
        self.runs = self._find_runs(starts)
        if self.events.cut:
            self.complete, self.reason = False, self.reason or "only the first of its texts are shown"

    @classmethod
    def open(cls, path: Path, check: bool = False, progress: ShowProgress | None = None) -> Self:
        """Open a recording; with `check`, check every byte of it.

        Raises RecordingError, a sentence, if it is not one of ours or has no run in it.
        """
        with named(path):
            stream = open_file(path)
            try:
                contents = None if check else from_summary(stream)
                return cls(path, stream, contents or Scan(stream, progress).contents())
            except BaseException:
                stream.close()
                raise

    def close(self) -> None:
        self._stream.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def at(self, clock: float) -> SamplePlace | None:
        """The last sample at or before that time, or else the first; None if there are no samples."""
        clock, log_time = _as_recorded(clock)
        chunk = bisect_right(self._chunks.starts, log_time) - 1
        entries = self._decoded(chunk).entries if chunk >= 0 else ()
        later = bisect_right(entries, clock, key=_clock)
        return self.previous(SamplePlace(chunk, later)) or self.next(SamplePlace(0, -1))

    def sample(self, place: SamplePlace) -> Entry:
        return self._decoded(place.chunk).entries[place.entry]

    def next(self, place: SamplePlace) -> SamplePlace | None:
        """The next sample; None after the last."""
        chunk, index = place.chunk, place.entry + 1
        while (chunk := self._sampled.find(1, max(chunk, 0))) >= 0:
            samples = self._decoded(chunk).samples
            at = bisect_left(samples, index)
            if at < len(samples):
                return SamplePlace(chunk, samples[at])
            chunk, index = chunk + 1, 0
        return None

    def previous(self, place: SamplePlace, after: int = 0) -> SamplePlace | None:
        """The sample before; None before the first, or before the chunk `after`."""
        chunk, index = place.chunk, place.entry
        while (chunk := self._sampled.rfind(1, after, max(chunk, -1) + 1)) >= 0:
            samples = self._decoded(chunk).samples
            at = bisect_left(samples, index if chunk == place.chunk else _BEYOND) - 1
            if at >= 0:
                return SamplePlace(chunk, samples[at])
            chunk -= 1
        return None

    def entries(self, start: float = 0.0, end: float = CLOCK_LIMIT, run: int = 0) -> Iterator[Entry]:
        """All samples and events from `start` to `end`, both included, in the order of recording; from `run` on."""
        (start, log_time), (end, _) = _as_recorded(start), _as_recorded(end)
        for chunk in range(bisect_left(self._chunks.ends, log_time), len(self._chunks)):
            if self._chunks.starts[chunk] > _as_recorded(end)[1]:
                return
            entries = self._decoded(chunk).entries
            first = max(bisect_left(entries, start, key=_clock), bisect_left(entries, run, key=_run) if run else 0)
            for entry in islice(entries, first, None):
                if entry.clock > end:
                    return
                yield entry

    def _methods_of(self, run: int) -> tuple[str, ...]:
        """The methods of a run, in its order."""
        scene = self.events.start_of(run)
        return tuple(method.key for method in scene.cast) if scene else ()

    def _read_entries(self, chunk: int, only_events: bool = False) -> tuple[Entry, ...]:
        """A chunk's entries; none if it turns out to be damaged."""
        try:
            record = record_at(self._stream, self._chunks.offsets[chunk])
            if record is None or record[0] != Opcode.CHUNK:
                raise RecordingError("a chunk is not where the summary puts it")
            read = read_chunk(record[1])
            if (read.start, read.end) != (self._chunks.starts[chunk], self._chunks.ends[chunk]):
                raise RecordingError("a chunk differs from its entry in the summary")
            entries = self._layout.entries(read.messages, self.events.start_of, only_events)
            return tuple(entry for _, entry in entries)
        except (RecordingError, OSError) as error:
            self.complete, self.damaged, self.reason = False, True, self.reason or str(error)
            return ()

    def _decode(self, chunk: int) -> _Decoded:
        """A chunk, without entries of runs whose start is lost, and of runs that were over."""
        entries, latest = [], 0
        for entry in self._read_entries(chunk):
            if entry.value.run in self._known and entry.value.run >= latest:
                latest = entry.value.run
                entries.append(entry)
        samples = array("L", (at for at, (_, value) in enumerate(entries) if isinstance(value, Sample)))
        self._sampled[chunk] = bool(samples)
        return _Decoded(tuple(entries), samples)

    def _read_events(self) -> Iterator[tuple[int, float, Event]]:
        """(chunk, clock, event) of all events; of too many, the first."""
        count = 0
        for chunk, eventful in enumerate(self._chunks.eventful):
            if not eventful:
                continue
            for clock, event in self._read_entries(chunk, only_events=True):
                if not isinstance(event, Event):
                    continue
                if count == EVENT_LIMIT:
                    self.complete, self.reason = False, self.reason or f"only its first {count} events are shown"
                    return
                yield chunk, clock, event
                count += 1

    def _find_runs(self, starts: list[tuple[int, int]]) -> Runs:
        """The runs, each up to the last sample before the next one's start.  Every chunk is read at most once."""
        runs, last, searched = Runs(self.events), None, 0
        kinds = self.events.starts()
        begun: int | None = None
        for chunk, group in groupby(starts, itemgetter(0)):
            last, searched = self._last_sample(searched, chunk) or last, chunk + 1
            entries = iter(self._decoded(chunk).entries)
            for _, run in group:
                for entry in entries:
                    if entry.value.run >= run:
                        break
                    if isinstance(entry.value, Sample):
                        last = entry
                if begun is not None:
                    runs.add(begun, last)
                begun = next(kinds)
            last = next((entry for entry in reversed(tuple(entries)) if isinstance(entry.value, Sample)), last)
        assert begun is not None
        runs.add(begun, self._last_sample(searched, len(self._chunks)) or last)
        return runs

    def _last_sample(self, first: int, end: int) -> Entry | None:
        place = self.previous(SamplePlace(end - 1, _BEYOND), first)
        return self.sample(place) if place else None


_clock = attrgetter("clock")


def _run(entry: Entry) -> int:
    return entry.value.run


def _as_recorded(clock: float) -> tuple[float, int]:
    """The nearest clock that a file can hold, in s and as log_time in ns: files round to nanoseconds."""
    nanoseconds = round(min(max(clock, 0.0), CLOCK_LIMIT) * 1e9)
    return nanoseconds / 1e9, CLOCK_OFFSET + nanoseconds
