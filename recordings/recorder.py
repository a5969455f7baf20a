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

from mcap.writer import CompressionType, Writer

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
        self._paused = False
        self._is_empty = True  # until something was flushed
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
        with suppress(OSError):  # some file systems have no locks
            lock(self._file)
        self._writer = Writer(
            self._file, chunk_size=1 << 62, compression=CompressionType.ZSTD, enable_data_crcs=True
        )
        self._writer.start(PROFILE, f"pendu-tui {version('pendu-tui')}")

    def event(self, event: Event, clock: float) -> None:
        """Write an event, during a pause at once to disk.

        Finishes the recording and raises DiskError if it has as many events as may be read.
        """
        data = encode_event(event)
        if self._entries - self.samples == MAX_EVENTS - 1 and event.kind != "stop":
            self.close()
            raise DiskError("is full and was finished; start the lab again for another", self.path)
        if event.kind in ("start", "stop"):
            self._last = None
        if event.scene is not None:
            self._begin(event.scene)
        if event.kind in ("pause", "resume"):
            self._paused = event.kind == "pause"
        self._add([(EVENTS, data)], clock)

    def sample(self, sample: Sample, clock: float) -> None:
        """Write a sample, unless it or a later one of its run is the last one written.

        Extremes are those since the previous sample, so the first sample of a run has none.
        """
        last = self._last
        if last is None:
            sample = without_extremes(sample)
        elif sample.step <= last.step:
            return
        messages = zip(self._topics, encode_readings(sample), strict=True)
        self._add(list(messages), clock, urgent=last is None)
        self.samples += 1
        self._last = sample

    def note_gap(self) -> None:
        """Note that samples of the run are missing here."""
        self._last = None

    def flush(self) -> None:
        """Hand everything to the system, where it survives this process."""
        with writing(self.path):
            self._writer.flush()  # type: ignore[no-untyped-call]
            if not self._is_ours():
                raise DiskError("the file was replaced", self.path)
        self._is_empty = False
        self._unflushed = 0

    def close(self) -> None:
        """Finish the recording with a stop, the summary and its final name.

        Without a start, no file is left.  If the name was taken meanwhile, `path` becomes the next
        free one, and NameTakenError is raised.
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
        if self._overwrite and os.path.lexists(self.path):
            self.path = free_path(self.path)
        self._overwrite = False

    def _finish(self) -> None:
        if (last := self._last) is not None:
            stop = Event("stop", last.run, last.step, last.t)
            self._add([(EVENTS, encode_event(stop))], self.seconds)
        self.flush()
        with writing(self.path):
            self._writer.finish()  # type: ignore[no-untyped-call]
            self._file.flush()
            os.fsync(self._file.fileno())
            self._file.close()  # Windows renames no open file
        try:
            publish(self.part, self.path, self._overwrite)
        except NameTakenError as error:
            wanted = self.path
            self.path = free_path(wanted)
            publish(self.part, self.path)
            why = f"its name was taken meanwhile; the recording is saved as {self.path.name}"
            raise NameTakenError(why, wanted) from error

    def abandon(self, delete: bool = False) -> None:
        """Leave what was flushed in NAME.mcap.part, or delete the file if that is nothing."""
        if self._file.closed:
            return
        is_left = True
        with suppress(OSError):
            is_left = not (self._is_ours() and (delete or self._is_empty))
        with suppress(OSError):
            self._file.close()  # Windows removes no open file
        with suppress(OSError):
            if not is_left:
                self.part.unlink()

    def _is_ours(self) -> bool:
        return os.path.samestat(self.part.stat(), os.fstat(self._file.fileno()))

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
            data = json.dumps(schema, separators=(",", ":")).encode()
            self._schemas[title] = self._writer.register_schema(title, "jsonschema", data)
        if topic not in self._channels:
            number = self._writer.register_channel(topic, "json", self._schemas[title], metadata)
            self._channels[topic] = number

    def _add(
        self, messages: Sequence[tuple[str, bytes]], clock: float, urgent: bool = False
    ) -> None:
        """Write the messages of one entry."""
        log_time = CLOCK_OFFSET + round(clock * 1e9)
        self.seconds = clock
        publish_time = self._publish_time(log_time)
        number = self._entries % (1 << 32)
        with writing(self.path):
            for topic, data in messages:
                channel = self._channels[topic]
                self._writer.add_message(channel, log_time, data, publish_time, number)
                self._unflushed += len(data)
        self._entries += 1
        if urgent or self._paused or self._unflushed > MAX_CHUNK:
            self.flush()

    def _publish_time(self, log_time: int) -> int:
        """Return a time [ns] that is the same when the same run is recorded again."""
        return log_time


class LiveRecorder(Recorder):
    """A recorder for the lab, which any thread may close; only `__init__` raises.

    A thread flushes it, whether frames come or not.  If the disk fails, the recording ends and the
    lab can go on.
    """

    failed: str | None = None  # why the recording ended before the lab did, a sentence

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._lock = RLock()
        Thread(target=self._keep, name="recorder", daemon=True).start()

    def event(self, event: Event, clock: float) -> None:
        self._in_turn(super().event, event, clock)

    def sample(self, sample: Sample, clock: float) -> None:
        self._in_turn(super().sample, sample, clock)

    def close(self) -> None:
        self._in_turn(super().close)

    def _publish_time(self, log_time: int) -> int:
        return time.time_ns()

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
            self._fail(DiskError("the disk does not answer", self.part))
            return
        try:
            if self.failed is None and not self._file.closed:
                write(*arguments)
        except NameTakenError:
            pass  # `close` has found another name
        except DiskError as error:
            self._fail(error)
            self.abandon()
        finally:
            self._lock.release()

    def _fail(self, error: DiskError) -> None:
        self.failed = self.failed or printable(str(error), 500)
