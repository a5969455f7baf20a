"""Recording: any moment of a file, without reading the rest.

An unfinished or damaged file opens with what is intact in it.
"""

from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from io import SEEK_END
from pathlib import Path
from typing import BinaryIO, NamedTuple, Self

from mcap.opcode import Opcode

from engine.run.lockstep import Sample
from engine.scenes import Scene
from recordings.contents import Contents, from_summary
from recordings.errors import RecordingError, named
from recordings.events import Entry, Event
from recordings.format import CLOCK_LIMIT, CLOCK_OFFSET
from recordings.framing import read_chunk, record_at
from recordings.lock import open_file
from recordings.scan import Scan, ShowProgress

EVENT_LIMIT = 100_000  # in memory all at once, 30 MB; a lesson has a few hundred, but each step back repeats them
CHUNKS_KEPT = 2  # decoded; playing meets the same one thirty times, stepping to and fro about an edge two
_BEYOND = 1 << 62  # the last entry of any chunk


class SamplePlace(NamedTuple):
    """Where in a file a sample is.  Samples may share a clock: single steps while paused do not advance it."""

    chunk: int
    entry: int


@dataclass(frozen=True, slots=True)
class Run:
    """One run of a recording."""

    number: int
    scene: Scene
    begin: float  # s of the recording clock
    end: float  # s, at its last sample
    steps: int  # at its last sample
    t: float  # s simulated, at its last sample
    events: int  # besides start and stop


class Recording:
    """A recording that is open for reading.

    `complete`: finished, and nothing is wrong; `damaged`: something was changed or lost; `reason`:
    what is wrong, a clause, or None.  In a file too long to be checked at opening, damage may show
    only while it plays.  Clocks are in s, from 0 to `length`.
    """

    def __init__(self, path: Path, stream: BinaryIO, contents: Contents) -> None:
        self.path = path
        self.bytes = stream.seek(0, SEEK_END)
        self.metadata = contents.metadata
        self.version, self.methods, self.sin = contents.layout.version, contents.layout.methods, contents.layout.sin
        self.samples = contents.samples
        self.complete, self.damaged, self.reason = contents.complete, contents.damaged, contents.reason
        self.length = (contents.chunks.ends[-1] - CLOCK_OFFSET) / 1e9 if contents.chunks else 0.0
        self._stream, self._layout, self._chunks = stream, contents.layout, contents.chunks
        self._entries = lru_cache(CHUNKS_KEPT)(self._known_entries)
        events = list(self._read_events())
        starts = {event.run: (chunk, clock, event) for chunk, clock, event in events if event.kind == "start"}
        if list(starts) != sorted(starts):
            raise RecordingError("its runs are not in order")
        if not starts:
            raise RecordingError("the starts of all its runs are lost")
        self.events: tuple[tuple[float, Event], ...] = tuple(
            (clock, event) for _, clock, event in events if event.run in starts
        )
        self._known = frozenset(starts)
        self.runs = tuple(self._runs(list(starts.values())))

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
        entries = self._entries(chunk) if chunk >= 0 else ()
        later = bisect_right(entries, clock, key=lambda entry: entry.clock)
        return self.previous(SamplePlace(chunk, later)) or self.next(SamplePlace(0, -1))

    def sample(self, place: SamplePlace) -> Entry:
        return self._entries(place.chunk)[place.entry]

    def next(self, place: SamplePlace) -> SamplePlace | None:
        """The next sample; None after the last."""
        index = place.entry + 1
        for chunk in range(place.chunk, len(self._chunks)):
            entries = self._entries(chunk)
            for at in range(index, len(entries)):
                if isinstance(entries[at].value, Sample):
                    return SamplePlace(chunk, at)
            index = 0
        return None

    def previous(self, place: SamplePlace) -> SamplePlace | None:
        """The sample before; None before the first."""
        index = place.entry
        for chunk in range(min(place.chunk, len(self._chunks) - 1), -1, -1):
            entries = self._entries(chunk)
            for at in range(min(index, len(entries)) - 1, -1, -1):
                if isinstance(entries[at].value, Sample):
                    return SamplePlace(chunk, at)
            index = _BEYOND
        return None

    def entries(self, start: float = 0.0, end: float = CLOCK_LIMIT) -> Iterator[Entry]:
        """All samples and events from `start` to `end`, both included, in the order of recording."""
        (start, log_time), (end, _) = _as_recorded(start), _as_recorded(end)
        for chunk in range(bisect_left(self._chunks.ends, log_time), len(self._chunks)):
            for entry in self._entries(chunk):
                if entry.clock > end:
                    return
                if entry.clock >= start:
                    yield entry

    def _read_entries(self, chunk: int, only_events: bool = False) -> tuple[Entry, ...]:
        """A chunk's entries; none if it turns out to be damaged."""
        try:
            record = record_at(self._stream, self._chunks.offsets[chunk])
            if record is None or record[0] != Opcode.CHUNK:
                raise RecordingError("a chunk is not where the summary puts it")
            read = read_chunk(record[1])
            if (read.start, read.end) != (self._chunks.starts[chunk], self._chunks.ends[chunk]):
                raise RecordingError("a chunk differs from its entry in the summary")
            return tuple(entry for _, entry in self._layout.entries(read.messages, only_events))
        except (RecordingError, OSError) as error:
            self.complete, self.damaged, self.reason = False, True, self.reason or str(error)
            return ()

    def _known_entries(self, chunk: int) -> tuple[Entry, ...]:
        """A chunk's entries, except those of runs whose start is lost."""
        return tuple(entry for entry in self._read_entries(chunk) if entry.value.run in self._known)

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

    def _runs(self, starts: list[tuple[int, float, Event]]) -> Iterator[Run]:
        made = Counter(event.run for _, event in self.events if event.kind not in ("start", "stop"))
        for (_, begin, start), following in zip(starts, [*starts[1:], None], strict=True):
            chunk, entry = len(self._chunks) - 1, _BEYOND
            if following:
                chunk = following[0]
                entries = enumerate(self._entries(chunk))
                entry = next((at for at, (_, value) in entries if value.run == following[2].run), 0)
            last = self.previous(SamplePlace(chunk, entry))
            end, sample = self.sample(last) if last else (begin, None)
            if not isinstance(sample, Sample) or sample.run != start.run:
                end, step, t = begin, start.step, start.t
            else:
                step, t = sample.step, sample.t
            assert start.scene is not None
            yield Run(start.run, start.scene, begin, end, step, t, made[start.run])


def _as_recorded(clock: float) -> tuple[float, int]:
    """The nearest clock that a file can hold, in s and as log_time in ns: files round to nanoseconds."""
    nanoseconds = round(min(max(clock, 0.0), CLOCK_LIMIT) * 1e9)
    return nanoseconds / 1e9, CLOCK_OFFSET + nanoseconds
