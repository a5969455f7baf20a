"""The summary at a file's end: what is where, so that opening and seeking need not read the rest."""

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import SEEK_END
from typing import BinaryIO, NamedTuple

from mcap.opcode import Opcode
from mcap.records import Channel, Statistics

from recordings.errors import RecordingError
from recordings.framing import CHANNEL_LIMIT, MAGIC, RECORD, read_record

SUMMARY_LIMIT = 1 << 25  # bytes; eight hours have 4 MB
CHUNK_LIMIT = 250_000  # a chunk a second for nearly three days
_FOOTER = struct.Struct("<QQI")  # summary start, summary offsets' start, CRC
_INDEX = struct.Struct("<QQQQI")  # start [ns], end [ns], offset, length, bytes of the map from channel to offset
_CHANNEL_OFFSET = struct.Struct("<HQ")
_DATA_END = struct.Struct("<BQI")


class ChunkIndex(NamedTuple):
    """Where a chunk is."""

    offset: int
    start: int  # ns, log_time
    end: int  # ns
    channels: frozenset[int]  # that have messages in it


@dataclass(slots=True)
class Summary:
    """What a summary says.  Its own checksum was right."""

    channels: dict[int, Channel] = field(default_factory=dict)
    statistics: Statistics | None = None
    chunks: list[ChunkIndex] = field(default_factory=list)
    metadata_offsets: list[int] = field(default_factory=list)


def read_summary(data: bytes, start: int) -> Summary | None:
    """The summary in `data`, what follows DataEnd up to the file's end, beginning at `start` of the file.

    None if it is cut off; RecordingError if it is damaged.
    """
    summary, at = Summary(), 0
    same: dict[frozenset[int], frozenset[int]] = {}  # nearly all chunks have the same channels
    for opcode, content in _records(data):
        at += RECORD.size + len(content)
        match opcode:
            case Opcode.CHANNEL:
                channel = read_record(opcode, content)
                assert isinstance(channel, Channel)
                summary.channels[channel.id] = channel
            case Opcode.STATISTICS:
                statistics = read_record(opcode, content)
                assert isinstance(statistics, Statistics)
                summary.statistics = statistics
            case Opcode.CHUNK_INDEX:
                index = _chunk_index(content)
                summary.chunks.append(index._replace(channels=same.setdefault(index.channels, index.channels)))
            case Opcode.METADATA_INDEX:
                summary.metadata_offsets.append(int.from_bytes(content[:8], "little"))
            case Opcode.FOOTER:
                break
        few = (summary.channels, summary.metadata_offsets)
        if len(summary.chunks) > CHUNK_LIMIT or max(map(len, few)) > CHANNEL_LIMIT:
            raise RecordingError("its summary lists more than any recording of ours has")
    else:
        return None
    if data[at:] != MAGIC:
        if MAGIC.startswith(data[at:]):
            return None
        raise RecordingError("it goes on after its end")
    if len(content) != _FOOTER.size or _FOOTER.unpack(content)[0] != start:
        raise RecordingError("its footer is damaged")
    crc = _FOOTER.unpack(content)[2]
    if crc == 0 or crc != zlib.crc32(data[: at - 4]):
        raise RecordingError("its summary is damaged")
    return summary


def find_summary(stream: BinaryIO) -> tuple[Summary, int, int] | None:
    """(summary, where DataEnd begins, CRC of all before it) by way of the footer; None if anything is amiss."""
    size = stream.seek(0, SEEK_END)
    tail = RECORD.size + _FOOTER.size + len(MAGIC)
    stream.seek(max(0, size - tail))
    footer = stream.read(tail)
    if len(footer) < tail or RECORD.unpack_from(footer) != (Opcode.FOOTER, _FOOTER.size):
        return None
    start = _FOOTER.unpack_from(footer, RECORD.size)[0]
    data_end = start - _DATA_END.size
    if not len(MAGIC) <= data_end < size - tail or size - start > SUMMARY_LIMIT:
        return None
    stream.seek(data_end)
    opcode, length, crc = _DATA_END.unpack(stream.read(_DATA_END.size))
    try:
        summary = read_summary(stream.read(SUMMARY_LIMIT), start)
    except RecordingError:
        return None
    return (summary, data_end, crc) if summary and (opcode, length) == (Opcode.DATA_END, 4) and crc else None


def _records(data: bytes) -> Iterator[tuple[int, bytes]]:
    at = 0
    while at + RECORD.size <= len(data):
        opcode, length = RECORD.unpack_from(data, at)
        at += RECORD.size
        if at + length > len(data):
            return
        yield opcode, data[at : at + length]
        at += length


def _chunk_index(content: bytes) -> ChunkIndex:
    try:
        start, end, offset, _, length = _INDEX.unpack_from(content)
        channels = frozenset(
            channel for channel, _ in _CHANNEL_OFFSET.iter_unpack(content[_INDEX.size : _INDEX.size + length])
        )
    except struct.error as error:
        raise RecordingError("its index is damaged") from error
    if len(channels) > CHANNEL_LIMIT or end < start:
        raise RecordingError("its index is damaged")
    return ChunkIndex(offset, start, end, channels)
