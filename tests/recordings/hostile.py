"""Files with right checksums and contents that no recorder writes."""

import struct
from collections.abc import Iterable
from pathlib import Path

import zstandard
from mcap.writer import CompressionType, Writer

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.recordings.events import Event
from pendu_tui.recordings.format import (
    CLOCK_OFFSET,
    EVENTS,
    FORMAT_VERSION,
    encode_event,
    encode_readings,
    topics_of,
)
from tests.recordings.examples import SCENE, start

Entry = list[tuple[str, float, bytes]]
"""Messages: topic, clock [s], data."""


def write(path: Path, entries: Iterable[Entry]):
    """Write entries as a finished file."""
    with path.open("wb") as stream:
        writer = Writer(
            stream, chunk_size=1 << 28, compression=CompressionType.ZSTD, enable_data_crcs=True
        )
        writer.start("pendu", "forger")
        schema = writer.register_schema("x", "jsonschema", b'{"type": "object"}')
        metadata = {"format": FORMAT_VERSION}
        channels = {
            topic: writer.register_channel(topic, "json", schema, metadata)
            for topic in (EVENTS, "/somebody/else", *topics_of(SCENE))
        }
        for number, messages in enumerate(entries):
            for topic, clock, data in messages:
                time = CLOCK_OFFSET + round(clock * 1e9)
                writer.add_message(channels[topic], time, data, time, number)
        writer.finish()


def encoded(value: Event | Sample, clock: float = 0.0):
    """The messages of an event or a sample."""
    if isinstance(value, Event):
        return [(EVENTS, clock, encode_event(value))]
    messages = zip(topics_of(SCENE), encode_readings(value), strict=True)
    return [(topic, clock, data) for topic, data in messages]


def first_sample(run: int = 1):
    return Lockstep(SCENE, run).sample()


def begun(*entries: Entry):
    """A run with its first sample, and more."""
    return [encoded(start()), encoded(first_sample()), *entries]


def false_head(packed: int = 4_000_000):
    """The head of a chunk that claims to have so many bytes, and 4 MB of contents."""
    frame = zstandard.ZstdCompressor().compress(bytes(4_000_000))[:18]
    numbers = (6, packed + 44, 1, 2, 4_000_000, 1, b"\x04\x00\x00\x00zstd", packed)
    return struct.pack("<BQQQQI8sQ", *numbers) + frame
