"""Hostile files, with right checksums and contents that no recorder writes."""

import hashlib
import json
import struct
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import zstandard
from mcap.writer import CompressionType, Writer

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.verdicts import Milestone
from pendu_tui.recordings.events import Event, noticed
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

Part = tuple[str, float, bytes]
"""Topic, clock [s], data."""

FOREIGN = "/somebody/else"
ESCAPES = "\x1b[2J\x1b]0;x\x07 [bold]"


def write_file(path: Path, name: str, many: int) -> None:
    """Write one of FILES."""
    chunk_size = 1 << 20
    if name == "a huge message":
        chunk_size = 1 << 28
    write(path, FILES[name](many), chunk_size)


def write(path: Path, entries: Iterator[list[Part]], chunk_size: int = 1 << 20) -> None:
    """Write entries as a finished file."""
    with path.open("wb") as stream:
        writer = Writer(
            stream, chunk_size=chunk_size, compression=CompressionType.ZSTD, enable_data_crcs=True
        )
        writer.start("pendu", "forger")
        schema = writer.register_schema("x", "jsonschema", b'{"type": "object"}')
        topics = (EVENTS, FOREIGN, *topics_of(SCENE))
        metadata = {"format": FORMAT_VERSION}
        channels = {
            topic: writer.register_channel(topic, "json", schema, metadata) for topic in topics
        }
        for number, parts in enumerate(entries):
            for topic, clock, data in parts:
                time = CLOCK_OFFSET + round(clock * 1e9)
                writer.add_message(channels[topic], time, data, time, number)
        writer.finish()


def event(value: Event, clock: float = 0.0, **changes: object) -> list[Part]:
    data = encode_event(value)
    if changes:
        data = json.dumps(json.loads(data) | changes).encode()
    return [(EVENTS, clock, data)]


def sample(value: Sample, clock: float = 0.0) -> list[Part]:
    messages = zip(topics_of(SCENE), encode_readings(value), strict=True)
    return [(topic, clock, data) for topic, data in messages]


def first_sample(run: int = 1) -> Sample:
    return Lockstep(SCENE, run).sample()


def begun() -> Iterator[list[Part]]:
    yield event(start())
    yield sample(first_sample())


def cut_run(run: int) -> Iterator[list[Part]]:
    """A run with a sample that lacks a method."""
    yield event(start(run))
    yield sample(first_sample(run))[:-1]


def raw(data: bytes, name: str = EVENTS) -> Iterator[list[Part]]:
    """One run, and a message of these bytes."""
    yield from begun()
    yield [(name, 1.0, data)]


def far(step: int) -> Iterator[list[Part]]:
    """A run whose second sample claims to be many steps later."""
    yield from begun()
    yield sample(first_sample()._replace(step=step, t=step * SCENE.h), 1.0)


def changed_h(h: float) -> Iterator[list[Part]]:
    yield from begun()
    yield event(Event("set_h", 1, 0, 0.0, h=h), 0.5)
    for step in range(1, 40):
        yield sample(first_sample()._replace(step=step), 0.5 + step / 30)


def late(count: int) -> Iterator[list[Part]]:
    """Samples that are years apart."""
    yield event(start())
    for number in range(count):
        clock = number * 9.4e8 / count
        yield sample(first_sample()._replace(step=number * 10_000, t=clock), clock)


def unlike(number: int) -> str:
    """A long text of its own for each number, which cannot be compressed to nothing."""
    return hashlib.sha256(number.to_bytes(8)).hexdigest() + "字" * 130


def runs(count: int) -> Iterator[list[Part]]:
    for run in range(1, count + 1):
        yield event(start(run, replace(SCENE, name=unlike(run))))
        yield sample(first_sample(run))


def noted(values: Iterator[Event]) -> Iterator[list[Part]]:
    """One run, and these events in it."""
    yield from begun()
    for number, value in enumerate(values):
        yield event(value, number * 1e-3)


def marks(count: int) -> Iterator[list[Part]]:
    return noted(Event("mark", 1, 0, 0.0, text=unlike(number)) for number in range(count))


def milestones(count: int) -> Iterator[list[Part]]:
    cast = SCENE.cast
    made = (Milestone("verdict", cast[n % 4], n, n * 0.1, 1e-9, "grows") for n in range(count))
    return noted(noticed(1, milestone) for milestone in made)


def at(clock: float) -> Iterator[list[Part]]:
    yield from begun()
    yield sample(first_sample()._replace(step=1), clock)


def false_heads(count: int) -> bytes:
    """Heads of chunks of 4 MB, a hundred bytes apart."""
    frame = zstandard.ZstdCompressor().compress(bytes(4_000_000))[:18]
    numbers = (6, 4_000_044, 1, 2, 4_000_000, 1, b"\x04\x00\x00\x00zstd", 4_000_000)
    head = struct.pack("<BQQQQI8sQ", *numbers) + frame
    return MAGIC + count * head.ljust(100, b"\0")


def foreign(count: int) -> Iterator[list[Part]]:
    yield from begun()
    for _ in range(count):
        yield [(FOREIGN, 0.0, b"")]


FILES: dict[str, Callable[[int], Iterator[list[Part]]]] = {
    "deep JSON": lambda n: raw(b"[" * 100_000),
    "a huge message": lambda n: raw(b'{"text": "' + b"x" * (1 << 27) + b'"}'),
    "escapes": lambda n: iter(
        [
            event(start(), scene=ESCAPES, watch=ESCAPES),
            sample(first_sample()),
            event(Event("mark", 1, 0, 0.0, text="x"), text=ESCAPES),
        ]
    ),
    "a path as method": lambda n: iter([event(start(), methods=["../../etc/passwd"])]),
    "h of 0": lambda n: changed_h(0.0),
    "h of 5e-324": lambda n: changed_h(5e-324),
    "h of 1e300": lambda n: changed_h(1e300),
    "step 10^9": lambda n: far(10**9),
    "step 10^15": lambda n: far(10**15),
    "30 years": lambda n: late(n // 50),
    "570 years": lambda n: at(1.8e10),  # beyond 2^63 ns
    "many runs": runs,
    "many marks": marks,
    "many milestones": milestones,
    "many foreign messages": lambda n: foreign(10 * n),
    "many tiny events": lambda n: (event(Event("mark", 1, 0, 0.0)) for _ in range(10 * n)),
}
"""Entries by what is hostile in them; the argument is how many are many."""
