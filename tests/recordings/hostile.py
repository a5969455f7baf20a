"""Hostile files, with right checksums and contents that no recorder writes."""

import json
import struct
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

import zstandard
from mcap.writer import CompressionType, Writer

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.recordings.events import Event
from pendu_tui.recordings.files import MAGIC
from pendu_tui.recordings.format import (
    CLOCK_OFFSET,
    EVENTS,
    FORMAT_VERSION,
    encode_event,
    encode_readings,
    topics_of,
)
from tests.recordings.examples import SCENE, start

FOREIGN = "/somebody/else"
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
            for topic in (EVENTS, FOREIGN, *topics_of(SCENE))
        }
        for number, messages in enumerate(entries):
            for topic, clock, data in messages:
                time = CLOCK_OFFSET + round(clock * 1e9)
                writer.add_message(channels[topic], time, data, time, number)
        writer.finish()


def event(value: Event, clock: float = 0.0, **changes: object):
    data = encode_event(value)
    if changes:
        data = json.dumps(json.loads(data) | changes).encode()
    return [(EVENTS, clock, data)]


def sample(value: Sample, clock: float = 0.0):
    messages = zip(topics_of(SCENE), encode_readings(value), strict=True)
    return [(topic, clock, data) for topic, data in messages]


def first_sample(run: int = 1):
    return Lockstep(SCENE, run).sample()


def begun(*entries: Entry):
    """A run with its first sample, and more."""
    yield event(start())
    yield sample(first_sample())
    yield from entries


def changed_h(h: float):
    yield from begun(event(Event("set_h", 1, 0, 0.0, h=h), 0.5))
    for step in range(1, 40):
        yield sample(first_sample()._replace(step=step), 0.5 + step / 30)


def false_head(packed: int = 4_000_000):
    """The head of a chunk that claims to have so many bytes, and 4 MB of contents."""
    frame = zstandard.ZstdCompressor().compress(bytes(4_000_000))[:18]
    numbers = (6, packed + 44, 1, 2, 4_000_000, 1, b"\x04\x00\x00\x00zstd", packed)
    return struct.pack("<BQQQQI8sQ", *numbers) + frame


def false_heads(count: int):
    """Such heads, a hundred bytes apart."""
    return MAGIC + count * false_head().ljust(100, b"\0")


FILES: dict[str, Callable[[], Iterable[Entry]]] = {
    "a huge message": lambda: begun([(EVENTS, 1.0, b'{"text": "' + b"x" * (1 << 27) + b'"}')]),
    "h of 0": partial(changed_h, 0.0),
}
"""Entries by what is hostile in them."""
