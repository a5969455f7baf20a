"""Hostile files: small ones that claim much, and large ones of odd shapes.

python -m tests.recordings.hostile FOLDER
"""

import hashlib
import json
import random
import sys
import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Channel, ChunkIndex, DataEnd, Header, Schema, Statistics

from engine.run.lockstep import Lockstep, Sample
from engine.run.observer import Milestone
from engine.scenes import MOST_METHODS
from recordings.events import Event, Seal, method_named, noticed
from recordings.format import CLOCK_OFFSET, EVENTS, SEALS, encode_event, encode_readings, encode_seal, topic
from recordings.framing import CHANNEL_LIMIT, MAGIC, MESSAGE, RECORD, RECORD_LIMIT, ZSTD
from recordings.summary import Digest, fingerprints
from tests.recordings.examples import METHOD_KEYS, SCENE, start

Message = tuple[int, float, bytes]
"""Channel, clock [s], data."""

EVENT_CHANNEL, SEAL_CHANNEL, FOREIGN = 1, 2, 99
SEAL_ROOM = 200  # bytes
WIDE = "字" * 130
MANY = tuple(f"method_{n}" for n in range(CHANNEL_LIMIT - 2))
YEARS = 9.4e8  # s, 30 years


def message(channel: int, clock: float, data: bytes) -> bytes:
    """A message's record."""
    time = CLOCK_OFFSET + round(clock * 1e9)
    return RECORD.pack(Opcode.MESSAGE, MESSAGE.size + len(data)) + MESSAGE.pack(channel, 0, time, time) + data


def event(value: Event, clock: float = 0.0) -> list[Message]:
    return [(EVENT_CHANNEL, clock, encode_event(value))]


def sample(value: Sample, clock: float = 0.0) -> list[Message]:
    return [(SEAL_CHANNEL + 1 + place, clock, data) for place, data in enumerate(encode_readings(value))]


def first_sample(run: int = 1) -> Sample:
    return Lockstep(SCENE, run).sample()


def wide(number: int) -> str:
    """A long text of wide characters that no other number has, and that cannot be compressed to nothing."""
    return hashlib.sha256(number.to_bytes(8)).hexdigest() + WIDE


def packed(entries: Iterable[list[Message]]) -> Iterator[list[Message]]:
    """The messages of entries in lists that each fill a chunk."""
    size, chunk = 0, []
    for messages in entries:
        more = sum(RECORD.size + MESSAGE.size + len(data) for _, _, data in messages)
        if size + more > RECORD_LIMIT - SEAL_ROOM:
            yield chunk
            size, chunk = 0, []
        size += more
        chunk += messages
    yield chunk


class File:
    """Writes a finished recording of ready chunks, every checksum and digest right."""

    def __init__(self, path: Path, methods: Iterable[str] = METHOD_KEYS) -> None:
        self._stream = path.open("wb")
        self._digest = Digest()
        self._crc = 0
        self._count: Counter[int] = Counter()
        self._indexes: list[ChunkIndex] = []
        channel = partial(Channel, message_encoding="json", schema_id=1)
        facts = {"format": "2", **fingerprints()}
        topics = [EVENTS, SEALS, *map(topic, methods)]
        self._channels = [channel(id=n, topic=name, metadata=facts) for n, name in enumerate(topics, EVENT_CHANNEL)]
        self._schema = Schema(data=b'{"type": "object"}', encoding="jsonschema", id=1, name="x")
        self._write(MAGIC)
        self._add(Header(profile="pendu", library="forger"), self._schema, *self._channels)

    def chunk(self, messages: list[Message], times: int = 1, end: bool = False) -> None:
        """Add a chunk of messages, or of the same ones many times."""
        data = b"".join(message(*each) for each in messages) * times
        self._digest.add(data)
        seal = message(SEAL_CHANNEL, messages[-1][1], encode_seal(Seal(0, 0, self._digest.sha256, end)))
        self._digest.add(seal)
        data += seal
        compressed = zstandard.compress(data)
        (_, first, _), (_, last, _) = messages[0], messages[-1]
        start, end = (CLOCK_OFFSET + round(clock * 1e9) for clock in (first, last))
        head = b"".join(
            number.to_bytes(size, "little")
            for number, size in ((start, 8), (end, 8), (len(data), 8), (zlib.crc32(data), 4))
        )
        content = head + ZSTD + len(compressed).to_bytes(8, "little") + compressed
        found = Counter(channel for channel, _, _ in messages)
        self._count += Counter({channel: number * times for channel, number in found.items()} | {SEAL_CHANNEL: 1})
        found[SEAL_CHANNEL] = 1
        self._clock = messages[-1][1]
        self._indexes.append(
            ChunkIndex(
                chunk_length=RECORD.size + len(content),
                chunk_start_offset=self._stream.tell(),
                compression="zstd",
                compressed_size=len(compressed),
                message_end_time=end,
                message_index_length=0,
                message_index_offsets=dict.fromkeys(found, 0),
                message_start_time=start,
                uncompressed_size=len(data),
            )
        )
        self._write(RECORD.pack(Opcode.CHUNK, len(content)) + content)

    def done(self) -> None:
        self.chunk(event(Event("stop", 1, 0, 0.0), self._clock), end=True)
        self._add(DataEnd(data_section_crc=self._crc))
        begin, self._crc = self._stream.tell(), 0
        statistics = Statistics(
            attachment_count=0,
            channel_count=len(self._channels),
            channel_message_counts=dict(self._count),
            chunk_count=len(self._indexes),
            message_count=self._count.total(),
            message_end_time=self._indexes[-1].message_end_time,
            message_start_time=self._indexes[0].message_start_time,
            metadata_count=0,
            schema_count=1,
        )
        self._add(self._schema, *self._channels, statistics, *self._indexes)
        footer = RECORD.pack(Opcode.FOOTER, 20) + begin.to_bytes(8, "little") + bytes(8)
        self._write(footer)
        self._write(self._crc.to_bytes(4, "little") + MAGIC)
        self._stream.close()

    def _add(self, *records: object) -> None:
        for record in records:
            builder = RecordBuilder()
            record.write(builder)
            self._write(builder.end())

    def _write(self, data: bytes) -> None:
        self._crc = zlib.crc32(data, self._crc)
        self._stream.write(data)


Write = Callable[[Path, float], None]
"""Writes a file, or so large a share of it."""


def of(entries: Callable[[int], Iterator[list[Message]]], count: int, methods: Iterable[str] = METHOD_KEYS) -> Write:
    """A file of so many entries, in chunks as large as can be."""

    def write(path: Path, share: float = 1.0) -> None:
        file = File(path, methods)
        for chunk in packed(entries(round(count * share))):
            file.chunk(chunk)
        file.done()

    return write


def repeated(chunks: int, times: int, one: Message) -> Write:
    """A file of one run of one sample, and of chunks that hold one message many times."""

    def write(path: Path, share: float = 1.0) -> None:
        file = File(path)
        file.chunk([*event(start()), *sample(first_sample())])
        for _ in range(chunks):
            file.chunk([one], round(times * share))
        file.done()

    return write


def starts(count: int, samples: bool = False) -> Iterator[list[Message]]:
    """Many runs with wide names, no two alike."""
    for run in range(1, count + 1):
        yield event(start(run, replace(SCENE, name=wide(run), watch=wide(-run % 2**32))))
        if samples:
            yield sample(first_sample(run))


def marks(count: int) -> Iterator[list[Message]]:
    """One run, and many marks with wide texts, no two alike."""
    yield event(start())
    yield sample(first_sample())
    for number in range(count):
        yield event(Event("mark", 1, 0, 0.0, text=wide(number)), number * 1e-3)


def changes(count: int) -> Iterator[list[Message]]:
    """Runs that all change the step size many times, each after one sample."""
    for number in range(count):
        run = 1 + number // 1000
        if number % 1000 == 0:
            yield event(start(run), number * 1e-3)
            yield sample(first_sample(run), number * 1e-3)
        yield event(Event("set_h", run, 0, 0.0, h=0.05 + 1e-9 * number), number * 1e-3)


def casts(count: int) -> Iterator[list[Message]]:
    """Runs of many methods that this version does not know, no two in the same order."""
    cast, chance = [method_named(key) for key in MANY], random.Random(1)
    for run in range(1, count + 1):
        yield event(start(run, replace(SCENE, cast=tuple(chance.sample(cast, MOST_METHODS)))))


def milestones(count: int) -> Iterator[list[Message]]:
    """One run, of which much was noticed."""
    yield event(start())
    yield sample(first_sample())
    for number in range(count):
        said = Milestone("verdict", SCENE.cast[number % 4], number, number * 0.1, 1e-9 * number, "grows")
        yield event(noticed(1, said), number * 1e-3)


def far(_: int, step: int) -> Iterator[list[Message]]:
    """A run whose second sample claims to be many steps later."""
    yield event(start())
    yield sample(first_sample())
    yield sample(first_sample()._replace(step=step, t=step * SCENE.h), 1.0)


def late(count: int) -> Iterator[list[Message]]:
    """Samples that are years apart, on the clock and in simulated time."""
    yield event(start())
    for number in range(count):
        clock = number * YEARS / count
        yield sample(first_sample()._replace(step=number * 10_000, t=clock), clock)


def flips(count: int) -> Iterator[list[Message]]:
    """Samples, many steps apart, that are below the pivot and over the top by turns."""
    yield event(start())
    for number in range(count):
        value = first_sample()._replace(step=number * 20_000, t=number * 2000.0)
        readings = [each._replace(theta=each.theta + 2.0 * (number % 2)) for each in value.readings]
        yield sample(value._replace(readings=tuple(readings)), number / 30)


FILES: dict[str, Write] = {
    "4 million tiny events": repeated(40, 100_000, *event(Event("mark", 1, 0, 0.0))),
    "7.5 million foreign messages": repeated(30, 250_000, (FOREIGN, 0.0, b"")),
    "99 000 runs": of(starts, 99_000),
    "50 000 runs with samples": of(partial(starts, samples=True), 50_000),
    "99 000 marks": of(marks, 99_000),
    "50 000 changes of h": of(changes, 50_000),
    "99 000 casts": of(casts, 99_000, MANY),
    "99 000 milestones": of(milestones, 99_000),
    "step 10^9": of(partial(far, step=10**9), 1),
    "step 10^10": of(partial(far, step=10**10), 1),
    "30 years": of(late, 2_000),
    "20 000 times over the top": of(flips, 20_000),
}
"""What is in it -> writes it."""


def file_name(name: str) -> str:
    return name.replace(" ", "-").replace("^", "") + ".mcap"


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for name, write in FILES.items():
        write(folder / file_name(name), 1.0)
    print(json.dumps({name: file_name(name) for name in FILES}))
