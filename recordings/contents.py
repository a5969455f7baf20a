"""Contents: the purpose of a file's channels, its chunks, and whether it is whole."""

import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.records import Channel, Metadata

from engine.run.lockstep import Reading, Sample
from engine.run.observer import Milestone
from engine.scenes import Scene
from recordings.errors import RecordingError, printable, printable_items
from recordings.events import Entry, Seal
from recordings.fields import extra_names
from recordings.format import (
    CLOCK_OFFSET,
    EVENTS,
    FORMAT_VERSION,
    METADATA,
    SEALS,
    decode_event,
    decode_reading,
    decode_seal,
    keys_of,
)
from recordings.framing import Chunk, Message, read_chunk, read_record, record_at
from recordings.summary import FUNCTIONS, Chunks, find_summary

CHECK_LIMIT = 1 << 26  # bytes checked whenever a file is opened: the first two hours, in 50 ms
_BLOCK = 1 << 20


StartOf = Callable[[int], Scene | None]
"""The scene that a run started with; None if its start is not known."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Which channel holds what."""

    events: int
    seals: int | None  # none in format 1
    methods: dict[int, tuple[str, str]]  # channel -> model, method
    channels: dict[tuple[str, str], int]  # the other way round
    version: int
    functions: dict[str, str]  # fingerprints of those it was made with

    def samples(self, messages: Mapping[int, int]) -> int:
        """The least number of samples in so many messages of each channel: runs may have different methods."""
        return max((messages.get(channel, 0) for channel in self.methods), default=0)

    def samples_in(self, messages: Iterable[Message]) -> int:
        """The number of samples in a chunk: the messages of a sample share a sequence number."""
        return len({message.sequence for message in messages if message.channel in self.methods})

    def channels_of(self, scene: Scene) -> list[int]:
        """The channels of a run's methods, in their order.  Raises RecordingError if one has none."""
        try:
            return [self.channels[scene.model, method.key] for method in scene.cast]
        except KeyError as error:
            raise RecordingError("a run has other methods than the file") from error

    def _has_methods_of(self, milestone: Milestone) -> bool:
        known = {key for _, key in self.channels}
        return milestone.method.key in known and (milestone.other is None or milestone.other.key in known)

    def entries(
        self, messages: Iterable[Message], start_of: StartOf, only_events: bool = False
    ) -> Iterator[tuple[list[Message], Entry]]:
        """The entries of a chunk, each with its messages.  Unknown channels are skipped.

        Of a run whose start is not known, samples have one reading.  Raises RecordingError for an unexpected message
        or an incomplete sample.
        """
        parts: list[Message] = []  # of a sample
        readings: list[Reading] = []
        run_before, expected = -1, [0]
        for message in messages:
            if message.channel == self.events and not readings:
                event = decode_event(message.data)
                if event.scene is not None:
                    run_before, expected = event.run, self.channels_of(event.scene)
                elif event.milestone and not self._has_methods_of(event.milestone):
                    raise RecordingError("a milestone is of a method that the file does not have")
                yield [message], Entry(clock_of(message), event)
            elif message.channel in self.methods and not only_events:
                run, step, t, reading = decode_reading(message.data, extra_names(self.methods[message.channel][0]))
                if not readings:
                    head = run, step, t
                    if run != run_before:
                        scene = start_of(run)
                        run_before, expected = (run, self.channels_of(scene)) if scene else (-1, [message.channel])
                if expected[len(readings)] != message.channel or (run, step, t) != head:
                    raise RecordingError("a sample is incomplete")
                parts.append(message)
                readings.append(reading)
                if len(readings) == len(expected):
                    yield parts, Entry(clock_of(parts[0]), Sample(*head, tuple(readings)))
                    parts, readings = [], []
            elif message.channel == self.events:
                raise RecordingError("a sample is incomplete")
        if readings:
            raise RecordingError("a sample is incomplete")


def layout_of(channels: Iterable[Channel]) -> Layout:
    """The layout that these channels declare.  Raises RecordingError if it is not ours, or of a newer format."""
    channels = list(channels)
    by_topic = {channel.topic: channel for channel in channels}
    if EVENTS not in by_topic:
        raise RecordingError("this is an MCAP file, but not a recording of pendu-tui")
    facts = by_topic[EVENTS].metadata
    version = facts.get("format", "")
    if not version.isdecimal() or not version.isascii() or len(version) > 9:
        raise RecordingError("this is not a recording of pendu-tui, or its format version is missing")
    if int(version) > FORMAT_VERSION:
        raise RecordingError(
            f"it has format {version}, this pendu-tui reads formats up to {FORMAT_VERSION}; install a newer version"
        )
    methods = {channel.id: keys for channel in channels if (keys := keys_of(channel.topic))}
    return Layout(
        events=by_topic[EVENTS].id,
        seals=by_topic[SEALS].id if int(version) > 1 and SEALS in by_topic else None,
        methods=methods,
        channels={keys: channel for channel, keys in methods.items()},
        version=int(version),
        functions={name: printable(facts[name]) for name in FUNCTIONS if name in facts},
    )


def clock_of(message: Message) -> float:
    """The recording clock of a message [s]."""
    return (message.log_time - CLOCK_OFFSET) / 1e9


@dataclass(frozen=True, slots=True)
class Contents:
    """What is where in a file.  `reason`: what is wrong, a clause; None if nothing wrong was found so far."""

    layout: Layout
    chunks: Chunks
    samples: int
    metadata: dict[str, str]
    complete: bool
    damaged: bool
    reason: str | None
    seal: Seal | None = None  # the last one, if its digest was right
    sealed: bool | None = None  # whether all seals are right; None: it has none, or they were not checked


def from_summary(stream: BinaryIO) -> Contents | None:
    """The contents by a file's summary; None if that cannot be trusted, and a `Scan` is needed."""
    summary = find_summary(stream)
    if summary is None or summary.statistics is None:
        return None
    if summary.data_end <= CHECK_LIMIT and _crc(stream, summary.data_end) != summary.data_crc:
        return None
    layout = layout_of(summary.channels.values())
    metadata: dict[str, str] = {}
    try:
        for offset in summary.metadata_offsets:
            record = record_at(stream, offset)
            match read_record(*record) if record and record[0] == Opcode.METADATA else None:
                case Metadata(name=name, metadata=found_there) if name == METADATA:
                    metadata = printable_items(found_there)
    except RecordingError:
        return None
    samples = layout.samples(summary.statistics.channel_message_counts)
    if layout.version > 1:
        seal = _end(stream, layout, summary.chunks)
        if seal is None:
            return None
        samples = seal.samples
    return Contents(layout, summary.chunks, samples, metadata, complete=True, damaged=False, reason=None)


def seal_of(chunk: Chunk, layout: Layout) -> Seal | None:
    """The seal that ends a chunk."""
    last = chunk.messages[-1]
    try:
        return decode_seal(last.data) if last.channel == layout.seals else None
    except RecordingError:
        return None


def _end(stream: BinaryIO, layout: Layout, chunks: Chunks) -> Seal | None:
    """The seal at the end of a recording that was finished."""
    try:
        record = record_at(stream, chunks.offsets[-1]) if chunks else None
        seal = seal_of(read_chunk(record[1]), layout) if record and record[0] == Opcode.CHUNK else None
    except RecordingError:
        return None
    return seal if seal and seal.end else None


def _crc(stream: BinaryIO, size: int) -> int:
    """The checksum of a file's first bytes."""
    crc = 0
    stream.seek(0)
    while size and (block := stream.read(min(size, _BLOCK))):
        crc = zlib.crc32(block, crc)
        size -= len(block)
    return crc
