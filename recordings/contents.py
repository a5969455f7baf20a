"""Contents: what a file's channels are for, which chunks it has, and whether it is whole."""

import zlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.records import Channel, Metadata

from engine.methods import METHODS
from engine.run.lockstep import Reading, Sample
from recordings.errors import RecordingError, printable_items
from recordings.events import Entry
from recordings.format import CLOCK_OFFSET, EVENTS, FORMAT_VERSION, METADATA, decode_event, decode_reading, topic
from recordings.framing import Message, read_record, record_at
from recordings.summary import Chunks, find_summary

CHECK_LIMIT = 1 << 26  # bytes checked whenever a file is opened: the first two hours, in 50 ms
_BLOCK = 1 << 20


@dataclass(frozen=True, slots=True)
class Layout:
    """Which channel holds what.  All runs of a file have the same methods, in the order of METHODS."""

    events: int
    methods: tuple[str, ...]
    places: dict[int, int]  # channel -> place of its method
    version: int
    sin: str  # fingerprint of the sin it was made with

    def samples(self, messages: Mapping[int, int]) -> int:
        """How many samples so many messages of each channel make."""
        return max(messages.get(channel, 0) for channel in self.places)

    def entries(self, messages: Iterable[Message], only_events: bool = False) -> Iterator[tuple[list[Message], Entry]]:
        """The entries of a chunk, each with its messages.  Unknown channels are skipped.

        Raises RecordingError for an unexpected message or an incomplete sample.
        """
        parts: list[Message] = []  # of a sample
        readings: list[Reading] = []
        for message in messages:
            if message.channel == self.events and not readings:
                event = decode_event(message.data)
                if event.scene and tuple(method.key for method in event.scene.cast) != self.methods:
                    raise RecordingError("a run has other methods than the file")
                yield [message], Entry(clock_of(message), event)
            elif message.channel in self.places and not only_events:
                run, step, t, reading = decode_reading(message.data)
                if not readings:
                    head = run, step, t
                if self.places[message.channel] != len(readings) or (run, step, t) != head:
                    raise RecordingError("a sample is incomplete")
                parts.append(message)
                readings.append(reading)
                if len(readings) == len(self.methods):
                    yield parts, Entry(clock_of(parts[0]), Sample(*head, tuple(readings)))
                    parts, readings = [], []
            elif message.channel == self.events:
                raise RecordingError("a sample is incomplete")
        if readings:
            raise RecordingError("a sample is incomplete")


def layout_of(channels: Iterable[Channel]) -> Layout:
    """The layout that these channels declare.  Raises RecordingError if it is not ours, or of a newer format."""
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
    methods = tuple(method.key for method in METHODS if topic(method.key) in by_topic)
    if not methods:
        raise RecordingError("this version knows none of its methods")
    return Layout(
        events=by_topic[EVENTS].id,
        methods=methods,
        places={by_topic[topic(method)].id: place for place, method in enumerate(methods)},
        version=int(version),
        sin=facts.get("sin", ""),
    )


def clock_of(message: Message) -> float:
    """The recording clock [s]."""
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
    return Contents(layout, summary.chunks, samples, metadata, complete=True, damaged=False, reason=None)


def _crc(stream: BinaryIO, size: int) -> int:
    """The checksum of a file's first bytes."""
    crc = 0
    stream.seek(0)
    while size and (block := stream.read(min(size, _BLOCK))):
        crc = zlib.crc32(block, crc)
        size -= len(block)
    return crc
