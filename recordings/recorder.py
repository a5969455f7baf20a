"""Recorder: writes samples and events to a file, and loses at most the last second if the process is killed.

It writes to NAME.mcap.part, which becomes NAME.mcap when it is finished.
"""

import json
import os
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

from mcap.records import Channel, Metadata, Schema
from mcap.writer import CompressionType, Writer

from engine.methods.own import OwnMethod
from engine.run.lockstep import Sample
from engine.scenes import Scene
from recordings.errors import DiskError, NameTakenError, writing
from recordings.events import Event, Seal
from recordings.fields import SEAL_SCHEMA, event_schema, sample_schema, without_extremes
from recordings.format import (
    CLOCK_LIMIT,
    CLOCK_OFFSET,
    EVENTS,
    METADATA,
    OWN_METHOD,
    PROFILE,
    SEALS,
    encode_event,
    encode_readings,
    encode_seal,
    topic,
)
from recordings.library import hold, part_of
from recordings.summary import FUNCTIONS, Digest, WallClock, facts_of, program_version

FLUSH_EVERY = 0.8  # s of real time; with a slow frame's delay the loss at kill -9 stays below 1 s
FLUSH_FIRST = 0.2  # s; from there on the time between flushes doubles until it is FLUSH_EVERY
FLUSH_EVENTS_EVERY = 0.25  # s; a key held down gives 30 events a second
FLUSH_BYTES = 1 << 17  # of messages in one chunk, however dense the samples; the only limit in headless runs


class Recorder:
    """Writes one recording, which begins with a start.

    Clocks are in seconds since the recording began, pauses excluded.  Headless recordings have no
    `wall` clock: nothing in them depends on when or where they were made, so the same run gives the
    same bytes.  `facts` are the metadata of the recording that is copied, if one is.  A failing disk
    raises DiskError; after that, only `abandon` is of use.
    """

    def __init__(
        self,
        path: Path,
        wall: WallClock | None = time.time_ns,
        overwrite: bool = False,
        facts: Mapping[str, str] | None = None,
    ) -> None:
        self.path = path
        self.part = part_of(path)
        self.seconds = 0.0  # length so far
        self.bytes = 0  # size of the file so far
        self.samples = self.events = 0
        self._wall, self._facts = wall, facts
        self._flush_by_time = wall is not None and facts is None  # real time passes while it records
        self._last: Sample | None = None
        self._channels: dict[str, Channel] = {}
        self._declared: set[str] = set()  # names of channels, in the chunk being built
        self._schemas: dict[str, int] = {}
        self._topics: list[str] = []  # of the run's methods
        self._digest = Digest()
        self._log_time = self._publish_time = CLOCK_OFFSET
        self._paused = self._stopped = False
        self._event_waits = False
        self._now = self._began = 0.0 if wall is None else wall() / 1e9  # s, real time
        self._flushed_at, self._really_flushed_at, self._unflushed = 0.0, self._began, 0
        with writing(self.part):
            if path.exists() and not overwrite:
                raise NameTakenError("a file of this name exists already; choose another name", path)
            try:
                self._file = self.part.open("xb", buffering=1 << 20)
            except FileExistsError as error:
                why = "is in use by a running recording or left over from an unfinished one; choose another name"
                raise NameTakenError(why, self.part) from error
        hold(self._file)
        self._writer = Writer(self._file, chunk_size=1 << 62, compression=CompressionType.ZSTD, enable_data_crcs=True)
        self._writer.start(PROFILE, f"pendu-tui {program_version()}")

    def event(self, event: Event, clock: float) -> None:
        """Write an event; it is on disk within a quarter of a second."""
        if event.kind == "start":
            self._last = None  # or a recording that ends here would have a stop of the run before
        data = encode_event(event)
        if event.scene is not None:
            if not self._channels:
                self._begin(event.scene)
            self._declare(event.scene)
        self._add([(EVENTS, data)], clock)
        self.events += 1
        self._stopped = event.kind == "stop"
        self._paused = event.kind == "pause" or (self._paused and event.kind != "resume")
        self._event_waits = True
        self._flush_if_due(urgent=self._paused)

    def sample(self, sample: Sample, clock: float, encoded: Sequence[bytes] | None = None) -> None:
        """Write a sample, unless it was the last one written.  A copy passes the messages that it read as `encoded`.

        Steps ascend within a run.  Extremes are those since the previous sample, so a run's first has none.
        """
        last = self._last
        if last is None or last.run != sample.run:
            encoded = encode_readings(without_extremes(sample))
        elif last.step == sample.step:
            return
        elif last.step > sample.step:
            raise ValueError(f"step {sample.step} of run {sample.run} comes after step {last.step}")
        self._add(list(zip(self._topics, encoded or encode_readings(sample), strict=True)), clock)
        self.samples += 1
        self._last = sample
        self._flush_if_due(urgent=self._paused or last is None or last.run != sample.run)

    def flush(self, end: bool = False) -> None:
        """Seal everything so far and hand it to the system, where it survives the death of this process."""
        with writing(self.part):
            if self._unflushed or end:
                seal = encode_seal(Seal(self.samples, self.events, self._digest.sha256, end))
                self._write(SEALS, seal)
            self._writer.flush()  # type: ignore[no-untyped-call]
            if not os.path.samestat(self.part.stat(), os.fstat(self._file.fileno())):
                raise DiskError("the file was replaced", self.part)
        self.bytes = self._file.tell()
        self._flushed_at, self._really_flushed_at = self.seconds, self._now
        self._unflushed, self._event_waits = 0, False
        self._declared.clear()

    def close(self) -> None:
        """Finish the recording: a stop, the summary, and its final name.  Without a start, leave no file."""
        if self._file.closed:
            return
        if not self._channels:
            self.abandon()
            return
        try:
            if self._last is not None and not self._stopped:
                last = self._last
                self._add([(EVENTS, encode_event(Event("stop", last.run, last.step, last.t)))], self.seconds)
                self.events += 1
            self.flush(end=True)
            with writing(self.part):
                self._writer.finish()  # type: ignore[no-untyped-call]
                self._file.flush()
                os.fsync(self._file.fileno())
                self.bytes = self._file.tell()
                self.part.replace(self.path)  # still locked, until the name is right
                self._file.close()
        except DiskError:
            self.abandon()
            raise

    def abandon(self) -> None:
        """Leave the file as it is.  What was flushed stays in NAME.mcap.part; an empty one is removed."""
        if self._file.closed:
            return
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):
            if not self._channels:
                self.part.unlink()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, error: BaseException | None, traceback: object) -> None:
        if isinstance(error, DiskError):
            self.abandon()
        else:
            self.close()

    def _begin(self, scene: Scene) -> None:
        metadata = dict(self._facts) if self._facts is not None else facts_of(scene, self._wall)
        self._writer.add_metadata(METADATA, metadata)
        self._digest.record(Metadata(METADATA, metadata))
        for method in scene.cast:
            if isinstance(method, OwnMethod):
                own = {"method": method.key, "letter": method.letter, "sha256": method.sha256, "source": method.source}
                self._writer.add_metadata(OWN_METHOD, own)
                self._digest.record(Metadata(OWN_METHOD, own))
        facts = {name: metadata[name] for name in ("format", *FUNCTIONS) if name in metadata}
        self._register(EVENTS, event_schema(tuple(scene.parameters)), facts)
        self._register(SEALS, SEAL_SCHEMA)

    def _declare(self, scene: Scene) -> None:
        """Declare the channels of a run in its first chunk, so that it can be read even where those before are lost."""
        self._topics = [topic(method.key, scene.model) for method in scene.cast]
        for name in (EVENTS, SEALS, *self._topics):
            if name not in self._channels:
                self._register(name, sample_schema(scene.model))
            elif name not in self._declared:
                self._declared.add(name)
                self._writer._Writer__chunk_builder.add_channel(self._channels[name])  # type: ignore[attr-defined]
                self._digest.record(self._channels[name])

    def _register(self, name: str, schema: dict[str, Any], facts: Mapping[str, str] = MappingProxyType({})) -> None:
        """Make a channel, and its schema unless it is there already."""
        title = schema["title"]
        if title not in self._schemas:
            data = json.dumps(schema, separators=(",", ":")).encode()
            self._schemas[title] = self._writer.register_schema(title, "jsonschema", data)
            self._digest.record(Schema(self._schemas[title], data, "jsonschema", title))
        known, claims = self._schemas[title], dict(facts)
        number = self._writer.register_channel(name, "json", known, claims)
        self._channels[name] = Channel(number, name, "json", claims, known)
        self._digest.record(self._channels[name])
        self._declared.add(name)

    def _add(self, messages: list[tuple[str, bytes]], clock: float) -> None:
        """Hand messages to the writer.  All are checked first, because a rejected one spoils its chunk."""
        if not self._channels:
            raise ValueError("a recording begins with a start")
        if not 0 <= clock <= CLOCK_LIMIT:  # nor nan
            raise ValueError(f"{clock} is not a reading of a recording clock")
        self._log_time = max(self._log_time, CLOCK_OFFSET + round(clock * 1e9))
        self.seconds = max(self.seconds, clock)
        self._publish_time = self._log_time if self._wall is None else self._wall()
        self._now = self._publish_time / 1e9
        with writing(self.part):
            for name, data in messages:
                self._write(name, data)
                self._unflushed += len(data)

    def _write(self, name: str, data: bytes) -> None:
        channel, sequence = self._channels[name].id, self.samples % (1 << 32)
        self._writer.add_message(channel, self._log_time, data, self._publish_time, sequence)
        self._digest.message(channel, sequence, self._log_time, self._publish_time, data)

    def _flush_if_due(self, urgent: bool = False) -> None:
        age = max(self.seconds - self._flushed_at, self._now - self._really_flushed_at)  # a wall clock may be set back
        every = min(max(self._flushed_at, self._really_flushed_at - self._began, FLUSH_FIRST), FLUSH_EVERY)
        if self._event_waits:
            every = min(every, FLUSH_EVENTS_EVERY)
        urgent = urgent and self._facts is None  # a copy can be made again
        if urgent or (self._flush_by_time and age >= every) or self._unflushed > FLUSH_BYTES:
            self.flush()
