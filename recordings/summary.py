"""A file's account of itself.

Summary: the index at its end, so that opening and seeking need not read the rest.

Digest: the SHA-256 of all that it holds.  The last message of every chunk is a seal, with the
digest of all records in chunks before it and of the metadata, in the order of the file, so an unfinished file is
covered up to its last chunk.  It shows what was changed, left out or added by somebody who did not recompute it;
against one who did it proves nothing.

Fingerprints: checksums of the library functions that its bits depend on, as they were where it was made.
"""

import hashlib
import math
import platform
import struct
import time
import zlib
from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import version
from io import SEEK_END, BytesIO
from typing import Any, BinaryIO

from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Channel, Statistics

from engine.scenes import Scene
from recordings.errors import RecordingError
from recordings.fields import numbers_in
from recordings.format import CLOCK_LIMIT, CLOCK_OFFSET, EVENTS, FORMAT_VERSION
from recordings.framing import CHANNEL_LIMIT, MAGIC, RECORD, SMALL_LIMIT, read_record, record_at

CHUNK_LIMIT = 2_300_000  # a chunk every 0.8 s for three weeks; 58 MB of Chunks
OTHER_LIMIT = 4 * CHANNEL_LIMIT  # records in a summary besides chunk indexes; ours have 15
_FOOTER = struct.Struct("<QQI")  # summary start, summary offsets' start, CRC
_INDEX = struct.Struct("<QQQQI")  # start [ns], end [ns], offset, length, bytes of the map from channel to offset
_CHANNEL_OFFSET = struct.Struct("<HQ")
_DATA_END = struct.Struct("<BQI")


@dataclass(slots=True)
class Chunks:
    """Where the chunks of a file are, in columns: 25 bytes per chunk, where objects would take 200."""

    offsets: "array[int]" = field(default_factory=lambda: array("Q"))
    starts: "array[int]" = field(default_factory=lambda: array("Q"))  # ns, log_time
    ends: "array[int]" = field(default_factory=lambda: array("Q"))  # ns
    eventful: bytearray = field(default_factory=bytearray)  # 0 where no events are in it, 1 where some may be

    def __len__(self) -> int:
        return len(self.offsets)

    def add(self, offset: int, start: int, end: int, eventful: bool) -> None:
        """Add the next one.  Raises RecordingError if its times cannot follow, or if there are too many."""
        if len(self) == CHUNK_LIMIT:
            raise RecordingError("it has unexpectedly many chunks")
        before = self.ends[-1] if self.ends else CLOCK_OFFSET
        if not before <= start <= end <= CLOCK_OFFSET + CLOCK_LIMIT * 1e9:
            raise RecordingError("its clock runs backwards or for centuries")
        self.offsets.append(offset)
        self.starts.append(start)
        self.ends.append(end)
        self.eventful.append(eventful)


@dataclass(slots=True)
class Summary:
    """A summary whose checksum was right."""

    data_end: int  # where the data before it end in the file,
    data_crc: int  # and their checksum
    channels: dict[int, Channel] = field(default_factory=dict)
    statistics: Statistics | None = None
    chunks: Chunks = field(default_factory=Chunks)
    metadata_offsets: list[int] = field(default_factory=list)

    def take(self, opcode: int, content: bytes) -> None:
        """Take in a record.  Raises RecordingError for one that is damaged."""
        if opcode == Opcode.CHUNK_INDEX:
            self._take_index(content)
        elif opcode == Opcode.METADATA_INDEX:
            self.metadata_offsets.append(int.from_bytes(content[:8], "little"))
        elif opcode in (Opcode.CHANNEL, Opcode.STATISTICS):
            record = read_record(opcode, content)
            if isinstance(record, Channel):
                self.channels[record.id] = record
            elif isinstance(record, Statistics):
                self.statistics = record

    def _take_index(self, content: bytes) -> None:
        try:
            start, end, offset, _, length = _INDEX.unpack_from(content)
            channels = [at[0] for at in _CHANNEL_OFFSET.iter_unpack(content[_INDEX.size : _INDEX.size + length])]
        except struct.error as error:
            raise RecordingError("its index is damaged") from error
        if len(content) > SMALL_LIMIT:
            raise RecordingError("its index is damaged")
        known = self.channels  # all of them: every writer puts channels before chunk indexes
        eventful = not channels or any(channel not in known or known[channel].topic == EVENTS for channel in channels)
        self.chunks.add(offset, start, end, eventful)


def read_summary(stream: BinaryIO, data_end: int) -> Summary | None:
    """The summary after the DataEnd record at this offset; it must end with the file.

    None if it is cut off; RecordingError if it is damaged.
    """
    offset = data_end + _DATA_END.size
    stream.seek(data_end)
    opcode, length, data_crc = _DATA_END.unpack(stream.read(_DATA_END.size).ljust(_DATA_END.size))
    if (opcode, length) != (Opcode.DATA_END, 4) or data_crc == 0:
        raise RecordingError("its data do not end where the summary begins")
    summary, start, crc, others = Summary(data_end, data_crc), offset, 0, 0
    while record := record_at(stream, offset):
        opcode, content = record
        header = RECORD.pack(opcode, len(content))
        if opcode == Opcode.FOOTER:
            break
        summary.take(opcode, content)
        others += opcode != Opcode.CHUNK_INDEX
        if others > OTHER_LIMIT:
            raise RecordingError("its summary is unexpectedly long")
        crc = zlib.crc32(content, zlib.crc32(header, crc))
        offset += len(header) + len(content)
    else:
        return None
    after = stream.read(len(MAGIC) + 1)
    if after != MAGIC:
        if MAGIC.startswith(after):
            return None
        raise RecordingError("data follows its end")
    if len(content) != _FOOTER.size or _FOOTER.unpack(content)[0] != start:
        raise RecordingError("its footer is damaged")
    expected = _FOOTER.unpack(content)[2]
    if expected == 0 or expected != zlib.crc32(content[:-4], zlib.crc32(header, crc)):
        raise RecordingError("its summary is damaged")
    return summary


def find_summary(stream: BinaryIO) -> Summary | None:
    """The summary, by way of the footer; None if anything is wrong."""
    footer = stream.seek(0, SEEK_END) - RECORD.size - _FOOTER.size - len(MAGIC)
    try:
        record = record_at(stream, max(0, footer))
        if record is None or record[0] != Opcode.FOOTER:
            return None
        data_end = int.from_bytes(record[1][:8], "little") - _DATA_END.size
        return read_summary(stream, data_end) if len(MAGIC) <= data_end < footer else None
    except RecordingError:
        return None


WallClock = Callable[[], int]  # ns since 1970

FUNCTIONS = ("sin", "sqrt")
"""What the simulation takes from this machine's libraries, besides + - * /, which are the same everywhere."""


_MESSAGE = struct.Struct("<BQHIQQ")  # opcode, length; channel, sequence, log_time [ns], publish_time [ns]
MESSAGE_SIZE = _MESSAGE.size  # bytes of a message's record before its data


class Digest:
    """The SHA-256 of records, in the order of the file."""

    def __init__(self) -> None:
        self._hash = hashlib.sha256()
        self._waiting = BytesIO()

    def message(self, channel: int, sequence: int, log_time: int, publish_time: int, data: bytes) -> None:
        head = _MESSAGE.pack(Opcode.MESSAGE, MESSAGE_SIZE - 9 + len(data), channel, sequence, log_time, publish_time)
        self._waiting.write(head)
        self._waiting.write(data)

    def record(self, record: Any) -> None:
        """Add one of mcap's records."""
        builder = RecordBuilder()
        record.write(builder)
        self._waiting.write(builder.end())  # type: ignore[no-untyped-call]

    def add(self, data: "bytes | memoryview") -> None:
        self._hash.update(data)

    @property
    def sha256(self) -> str:
        """Of everything so far."""
        self._hash.update(self._waiting.getbuffer())
        self._waiting = BytesIO()
        return self._hash.hexdigest()


@cache
def fingerprint(function: str) -> str:
    """A checksum of this machine's sin or sqrt from 1e-8 to 1e8, at 4096 places: where it differs, so do runs' bits.

    Another libm, or the same one on another processor, rounds one sine in 1400 the other way.
    """
    arguments = ((-1) ** i * 10 ** (i / 256 - 8) * 1.1 for i in range(4096))
    if function == "sqrt":
        arguments = (abs(x) for x in arguments)
    values = map(getattr(math, function), arguments)
    return hashlib.sha256(struct.pack("<4096d", *values)).hexdigest()[:16]


def fingerprints() -> dict[str, str]:
    """The fingerprints of FUNCTIONS here."""
    return {function: fingerprint(function) for function in FUNCTIONS}


def other_functions(recorded: Mapping[str, str]) -> tuple[str, ...]:
    """The FUNCTIONS that this machine computes differently, by their fingerprints; format 1 has that of sin only."""
    here = fingerprints()
    return tuple(name for name in dict.fromkeys(("sin", *recorded)) if recorded.get(name) != here[name])


@cache
def program_version() -> str:
    """The version of this program."""
    return version("pendu-tui")


def facts_of(scene: Scene, wall: WallClock | None) -> dict[str, str]:
    """For people.  Verification needs only the fingerprints, and takes them from the events' channel."""
    metadata = {
        "format": str(FORMAT_VERSION),
        **fingerprints(),
        "pendu-tui": program_version(),
        "scene": scene.name,
        "model": scene.model,
    }
    metadata |= {f"{name}.hex": value.hex() for name, value in numbers_in(scene).items()}
    if wall is not None:
        metadata["started"] = time.strftime("%Y-%m-%dT%H:%M:%S%z", time.localtime(wall() / 1e9))
        metadata["python"] = platform.python_version()
        metadata["platform"] = f"{platform.system()} {platform.machine()}"
    return metadata
