"""Recorder: samples and events to a file, of which a kill loses at most the last second.

It writes NAME.mcap.part, which becomes NAME.mcap when it is finished.
"""

import json
import os
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from threading import RLock, Thread
from typing import Any, Self

from mcap.writer import Writer

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.events import MAX_EVENTS, Event
from pendu_tui.recordings.files import (
    PROFILE,
    DiskError,
    NameTakenError,
    check_target,
    free_path,
    is_stream,
    part_of,
    printable,
    publish,
    writing,
)
from pendu_tui.recordings.format import (
    CLOCK_OFFSET,
    EVENT_SCHEMA,
    EVENTS,
    FORMAT_VERSION,
    encode_event,
    encode_readings,
    sample_schema,
    topics_of,
    without_extremes,
)
from pendu_tui.recordings.system import lock

FLUSH_EVERY = 0.5  # s; with a frame and the flush, a kill loses less than a second
MAX_WAIT = 2.0  # s, for another thread's flush
MAX_CHUNK = 1 << 17  # bytes of messages; the only reason to flush without a thread


class Recorder:
    """Writes one recording, which begins with a start.

    Clocks are in seconds since the recording began, pauses excluded, and never go back.  Raises
    DiskError if the disk fails; after that, call only `abandon`.
    """

    is_live = False

    def __init__(self, path: Path, overwrite: bool = False) -> None:
        self.path = path
        self.part = part_of(path)
        self.seconds = 0.0  # recorded so far
        self.samples = 0
        self._overwrite = overwrite
        self._last: Sample | None = None  # of this run; None: none, or a gap
        self._channels: dict[str, int] = {}  # numbers by topic
        self._schemas: dict[str, int] = {}  # numbers by title
        self._topics: tuple[str, ...] = ()  # of the run's methods
        self._entries = 0
        self._unflushed = 0  # bytes
        self._is_empty = True  # until something was flushed
        if is_stream(path):
            raise DiskError("is a device or a pipe; a recording needs a file", path)
        check_target(path, overwrite)
        with writing(self.path):
            try:
                self._file = self.part.open("xb")
            except FileExistsError as error:
                why = "is in use or left over from an unfinished recording; choose another name"
                raise NameTakenError(why, self.part) from error
        with suppress(OSError):  # some file systems have no locks
            lock(self._file)
        self._writer = Writer(self._file, enable_data_crcs=True)
        self._writer.start(PROFILE, f"pendu-tui {version('pendu-tui')}")

    def add(self, value: Sample | Event | None, clock: float) -> None:
        """Write an entry; None: samples are missing here.

        A sample is not written again after it or a later one.  Extremes are those since the
        previous sample, so the first sample of a run has none.  Finishes the recording and raises
        DiskError if it has as many events as may be read.
        """
        if value is None:
            self._last = None
        elif isinstance(value, Event):
            self._add_event(value, clock)
        elif self._last is None:
            self._add_sample(without_extremes(value), clock)
            self.flush()
        elif value.step > self._last.step:
            self._add_sample(value, clock)

    def _add_event(self, event: Event, clock: float) -> None:
        data = encode_event(event)
        if self._entries - self.samples == MAX_EVENTS - 1 and event.kind != "stop":
            self.close()
            raise DiskError("is full and was finished; restart the lab for another", self.path)
        if event.kind in ("start", "stop"):
            self._last = None
        if event.scene is not None:
            self._begin(event.scene)
        self._write([(EVENTS, data)], clock)

    def _add_sample(self, sample: Sample, clock: float) -> None:
        self._write(list(zip(self._topics, encode_readings(sample), strict=True)), clock)
        self.samples += 1
        self._last = sample

    def flush(self) -> None:
        """Hand everything to the system, where it survives this process."""
        with writing(self.path):
            self._writer.flush()  # type: ignore[no-untyped-call]
        self._unflushed = 0
        self._is_empty = False

    def close(self) -> None:
        """Finish the recording with a stop, the summary and its final name.

        Without a start, no file is left.  If the name was taken meanwhile, it keeps that of the
        unfinished file, and NameTakenError is raised.
        """
        if self._file.closed:
            return
        try:
            if self._channels:
                self._finish()
        finally:
            self.abandon()

    def keep_older(self) -> None:
        """Do not replace an older file, because this recording is not whole: choose a free name."""
        if os.path.lexists(self.path):
            self.path = free_path(self.path)
        self._overwrite = False

    def _finish(self) -> None:
        if (last := self._last) is not None:
            self._add_event(Event("stop", last.run, last.step, last.t), self.seconds)
        with writing(self.path):
            self._writer.finish()  # type: ignore[no-untyped-call]
            self._file.flush()
            os.fsync(self._file.fileno())
            self._file.close()  # Windows renames no open file
        publish(self.part, self.path, self._overwrite)

    def abandon(self, delete: bool = False) -> None:
        """Leave what was flushed in NAME.mcap.part, or delete the file if that is nothing."""
        if self._file.closed:
            return
        with suppress(OSError):
            self._file.close()  # Windows removes no open file
        with suppress(OSError):
            if delete or self._is_empty:
                self.part.unlink()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, error: BaseException | None, traceback: object) -> None:
        if isinstance(error, DiskError):
            self.abandon()
            return
        if error is not None:
            self.keep_older()
        self.close()

    def _begin(self, scene: Scene) -> None:
        """Register the channels of a run."""
        self._register(EVENTS, EVENT_SCHEMA, format=FORMAT_VERSION)
        self._topics = topics_of(scene)
        for topic in self._topics:
            self._register(topic, sample_schema(scene.model))

    def _register(self, topic: str, schema: dict[str, Any], **metadata: str) -> None:
        title = schema["title"]
        if title not in self._schemas:
            data = json.dumps(schema).encode()
            self._schemas[title] = self._writer.register_schema(title, "jsonschema", data)
        if topic not in self._channels:
            number = self._writer.register_channel(topic, "json", self._schemas[title], metadata)
            self._channels[topic] = number

    def _write(self, messages: Sequence[tuple[str, bytes]], clock: float) -> None:
        """Write the messages of one entry."""
        log_time = CLOCK_OFFSET + round(clock * 1e9)
        self.seconds = clock
        # that of a headless run is the same when it is recorded again
        publish_time = time.time_ns() if self.is_live else log_time
        with writing(self.path):
            for topic, data in messages:
                channel = self._channels[topic]
                self._writer.add_message(channel, log_time, data, publish_time, self._entries)
                self._unflushed += len(data)
        self._entries += 1
        if self._unflushed > MAX_CHUNK:
            self.flush()


class LiveRecorder(Recorder):
    """A recorder for the lab, which any thread may close; only `__init__` raises.

    A thread flushes it, whether frames come or not.  If the disk fails, the recording ends and the
    lab can go on.
    """

    is_live = True
    failed: str | None = None  # why the recording ended before the lab did, a sentence

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._lock = RLock()
        Thread(target=self._keep, daemon=True).start()

    def add(self, value: Sample | Event | None, clock: float) -> None:
        self._in_turn(super().add, value, clock)

    def close(self) -> None:
        self._in_turn(super().close)

    def _keep(self) -> None:
        while not self._file.closed:
            time.sleep(FLUSH_EVERY)
            if self._unflushed:
                self._in_turn(self.flush)

    def _in_turn(self, write: Callable[..., None], *arguments: Any) -> None:
        """Write, if that is possible, while other threads wait.

        A disk that blocks another thread for too long counts as failed.
        """
        if not self._lock.acquire(timeout=MAX_WAIT):
            self._fail(DiskError("the disk does not respond", self.part))
            return
        try:
            if self.failed is None and not self._file.closed:
                write(*arguments)
        except DiskError as error:
            self._fail(error)
            self.abandon()
        finally:
            self._lock.release()

    def _fail(self, error: DiskError) -> None:
        self.failed = printable(str(error))
