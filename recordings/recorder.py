"""Recorder: writes samples and events to a file, and loses at most the last second if it is killed.

It writes to NAME.mcap.part, which becomes NAME.mcap when it is finished.
"""

import json
import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from typing import Any, Self

from mcap.data_stream import RecordBuilder
from mcap.records import ChunkIndex
from mcap.writer import CompressionType, Writer

from engine.run.lockstep import Sample
from engine.scenes import Scene
from recordings.errors import DiskError, NameTakenError, writing
from recordings.events import MAX_EVENTS, Event
from recordings.fields import EVENT_SCHEMA, sample_schema, without_extremes
from recordings.files import check_target, is_stream, publish
from recordings.format import (
    CLOCK_OFFSET,
    EVENTS,
    FORMAT_VERSION,
    PROFILE,
    encode_event,
    encode_readings,
    topics_of,
)
from recordings.library import free_path, hold, part_of

FLUSH_EVERY = 0.7  # s of the recording clock; with a slow frame's delay kill -9 loses less than 1 s
MAX_CHUNK = 1 << 17  # bytes of messages; the only limit in headless runs

WallClock = Callable[[], int]  # ns since 1970


class _ChunkIndices:
    """The file's index as bytes; a list of mcap's objects would grow by 4 MB an hour."""

    def __init__(self) -> None:
        self._records = RecordBuilder()

    def append(self, index: ChunkIndex) -> None:
        index.write(self._records)

    def __iter__(self) -> Iterator[Self]:
        yield self

    def write(self, summary: RecordBuilder) -> None:
        summary.write(self._records.end())  # type: ignore[no-untyped-call]


class Recorder:
    """Writes one recording, which begins with a start.

    Clocks are in seconds since the recording began, pauses excluded.  A headless recording has no
    `wall` clock, so that the same run gives the same bytes.  A failing disk raises DiskError; after
    that, only `abandon` is of use.
    """

    def __init__(
        self,
        path: Path,
        wall: WallClock | None = time.time_ns,
        overwrite: bool = False,
    ) -> None:
        self.path = path
        self.part = part_of(path)
        self.seconds = 0.0  # length so far
        self.bytes = 0  # size of the file so far
        self.samples = 0
        self._wall = wall
        self._overwrite = overwrite
        self._last: Sample | None = None  # of the run
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        self._topics: tuple[str, ...] = ()  # of the run's methods
        self._entries = 0
        self._log_time = CLOCK_OFFSET
        self._paused = False
        self._flushed_at = 0.0  # s, on the recording clock
        self._unflushed = 0  # bytes
        if is_stream(path):
            raise DiskError("is a device or a pipe; a recording needs a file", path)
        check_target(path, overwrite)
        with writing(self.path):
            try:
                self._file = self.part.open("xb", buffering=1 << 20)
            except FileExistsError as error:
                why = "is in use or left over from an unfinished recording; choose another name"
                raise NameTakenError(why, self.part) from error
        hold(self._file)
        self._writer = Writer(
            self._file, chunk_size=1 << 62, compression=CompressionType.ZSTD, enable_data_crcs=True
        )
        vars(self._writer)["_Writer__chunk_indices"] = _ChunkIndices()
        self._writer.start(PROFILE, f"pendu-tui {version('pendu-tui')}")

    def event(self, event: Event, clock: float) -> None:
        """Write an event; a pause, and whatever is done while paused, is on disk at once.

        A recording that holds all the events that one may is finished, and raises DiskError.
        """
        data = encode_event(event)
        if self._entries - self.samples == MAX_EVENTS - 1 and event.kind != "stop":
            self.close()
            raise DiskError("is full and was finished; start the lab again for another", self.path)
        if event.kind in ("start", "stop"):
            self._last = None
        if event.scene is not None:
            self._begin(event.scene)
        self._add([(EVENTS, data)], clock)
        self._paused = event.kind == "pause" or (self._paused and event.kind != "resume")
        self._flush_if_due(urgent=self._paused)

    def sample(self, sample: Sample, clock: float) -> None:
        """Write a sample, unless it was the last one written.

        Extremes are those since the previous sample, so a run's first has none.
        """
        last = self._last
        if last is not None and last.step == sample.step:
            return
        messages = encode_readings(sample if last else without_extremes(sample))
        self._add(list(zip(self._topics, messages, strict=True)), clock)
        self.samples += 1
        self._last = sample
        self._flush_if_due(urgent=self._paused or last is None)

    def note_gap(self) -> None:
        """Note that samples of the run are missing here."""
        self._last = None

    def flush(self) -> None:
        """Hand everything so far to the system, where it survives the death of this process."""
        with writing(self.path):
            self._writer.flush()  # type: ignore[no-untyped-call]
            if not self._is_ours():
                raise DiskError("the file was replaced", self.path)
        self.bytes = self._file.tell()
        self._flushed_at = self.seconds
        self._unflushed = 0

    def close(self) -> None:
        """Finish the recording: a stop, the summary, and its final name.  Without a start, leave no
        file.

        If the name was taken meanwhile, the recording gets the next free one, `path`, and
        NameTakenError is raised.
        """
        if self._file.closed:
            return
        try:
            if self._channels:
                self._finish()
        finally:
            self.abandon()

    def _finish(self) -> None:
        if (last := self._last) is not None:
            self.event(Event("stop", last.run, last.step, last.t), self.seconds)
        self.flush()
        with writing(self.path):
            self._writer.finish()  # type: ignore[no-untyped-call]
            self._file.flush()
            os.fsync(self._file.fileno())
            self.bytes = self._file.tell()
        try:
            publish(self.part, self.path, self._overwrite)  # still locked, until the name is right
        except NameTakenError as error:
            wanted = self.path
            self.path = free_path(wanted)
            publish(self.part, self.path)
            why = f"its name was taken meanwhile; the recording is saved as {self.path.name}"
            raise NameTakenError(why, wanted) from error

    def abandon(self, delete: bool = False) -> None:
        """Leave what was flushed in NAME.mcap.part; an empty file is deleted."""
        if self._file.closed:
            return
        with suppress(OSError):
            if self._is_ours() and (delete or not self.bytes):
                self.part.unlink()
        with suppress(OSError):
            self._file.close()

    def _is_ours(self) -> bool:
        return os.path.samestat(self.part.stat(), os.fstat(self._file.fileno()))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, error: BaseException | None, traceback: object) -> None:
        if isinstance(error, DiskError):
            self.abandon()
        else:
            self.close()

    def _begin(self, scene: Scene) -> None:
        """Register the channels of a run."""
        self._register(EVENTS, EVENT_SCHEMA)
        self._topics = topics_of(scene)
        for name in self._topics:
            self._register(name, sample_schema(scene.model))

    def _register(self, name: str, schema: dict[str, Any]) -> None:
        title = schema["title"]
        if title not in self._schemas:
            data = json.dumps(schema, separators=(",", ":")).encode()
            self._schemas[title] = self._writer.register_schema(title, "jsonschema", data)
        if name not in self._channels:
            facts = {"format": FORMAT_VERSION} if name == EVENTS else {}
            number = self._writer.register_channel(name, "json", self._schemas[title], facts)
            self._channels[name] = number

    def _add(self, messages: Sequence[tuple[str, bytes]], clock: float) -> None:
        """Write the messages of one entry."""
        self._log_time = max(self._log_time, CLOCK_OFFSET + round(clock * 1e9))
        self.seconds = max(self.seconds, clock)
        publish_time = self._log_time if self._wall is None else self._wall()
        number = self._entries % (1 << 32)
        with writing(self.path):
            for name, data in messages:
                channel = self._channels[name]
                self._writer.add_message(channel, self._log_time, data, publish_time, number)
                self._unflushed += len(data)
        self._entries += 1

    def _flush_if_due(self, urgent: bool = False) -> None:
        is_late = self._wall is not None and self.seconds >= self._flushed_at + FLUSH_EVERY
        if urgent or is_late or self._unflushed > MAX_CHUNK:
            self.flush()


class LiveRecorder(Recorder):
    """Records the lab, which goes on if its disk fails: raises nothing once it is there.

    `failed` is a sentence on why the recording ended before the lab did, or None.
    """

    failed: str | None = None

    def event(self, event: Event, clock: float) -> None:
        self._try(lambda: super(LiveRecorder, self).event(event, clock))

    def sample(self, sample: Sample, clock: float) -> None:
        self._try(lambda: super(LiveRecorder, self).sample(sample, clock))

    def close(self) -> None:
        self._try(super().close)

    def _try(self, write: Callable[[], None]) -> None:
        if self.failed is None and not self._file.closed:
            try:
                write()
            except NameTakenError:
                pass  # at the end: it has another name then
            except DiskError as error:
                self.failed = str(error)
                self.abandon()
