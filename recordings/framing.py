"""MCAP as bytes: where its records lie, whether they are intact, and what a chunk holds.

The one place where untrusted files are taken apart.  Sizes are bounded before anything is read or
decompressed, and whatever is wrong becomes a RecordingError.  mcap's own readers are of no use here:
without a summary they return nothing, and they decompress whatever size a file declares.
"""

import struct
import zlib
from collections.abc import Callable
from io import BytesIO
from typing import BinaryIO, NamedTuple

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, DataEnd, Header, McapRecord, Metadata, Schema, Statistics

from recordings.errors import RecordingError

MAGIC = b"\x89MCAP0\r\n"
RECORD_LIMIT = 1 << 23  # bytes of a record, and of what a chunk decompresses to; ours have 1 MB at most
EXPANSION = 128  # times its compressed size, and
SMALL_CHUNK = 1 << 14  # bytes more: what a chunk may decompress to; ours reach 4 times, and 69 where nothing moves
SMALL_LIMIT = 1 << 16  # bytes of a record that is neither chunk nor index; ours have 1 kB
CHANNEL_LIMIT = 64  # ours are the methods, the events and the seals
RECORD = struct.Struct("<BQ")  # opcode, length of what follows
_CHUNK = struct.Struct("<QQQI")  # start [ns], end [ns], uncompressed size, its CRC
MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, log_time [ns], publish_time [ns]
ZSTD = b"\x04\x00\x00\x00zstd"
CHUNK_HEADER = _CHUNK.size + len(ZSTD) + 8
_LAST_OPCODE = max(Opcode)
_SEARCH_BLOCK = 1 << 16
SEARCH_LIMIT = 1 << 30  # bytes in false chunks, a second's work; that many damaged ones in a row are hours

_READERS: dict[Opcode, Callable[[ReadDataStream], McapRecord]] = {
    Opcode.HEADER: Header.read,
    Opcode.SCHEMA: Schema.read,
    Opcode.CHANNEL: Channel.read,
    Opcode.METADATA: Metadata.read,
    Opcode.STATISTICS: Statistics.read,
    Opcode.DATA_END: DataEnd.read,
}


class Message(NamedTuple):
    """A message as stored in a chunk."""

    channel: int
    sequence: int
    log_time: int  # ns
    publish_time: int  # ns
    data: bytes


class Chunk(NamedTuple):
    """An intact chunk."""

    start: int  # ns, log_time of the first message
    end: int  # ns, of the last
    channels: list[Channel]  # declared in it
    messages: list[Message]
    data: bytes  # all its records


def read_chunk(content: bytes) -> Chunk:
    """The chunk of a record's content.  Raises RecordingError if any bit of it is wrong."""
    if len(content) < CHUNK_HEADER:
        raise RecordingError("a chunk is too short")
    start, end, size, crc = _CHUNK.unpack_from(content)
    if content[_CHUNK.size : _CHUNK.size + len(ZSTD)] != ZSTD:
        raise RecordingError("a chunk is not compressed with zstd")
    if len(content) - CHUNK_HEADER != int.from_bytes(content[CHUNK_HEADER - 8 : CHUNK_HEADER], "little"):
        raise RecordingError("a chunk's length is wrong")
    if not _is_plausible(size, len(content) - CHUNK_HEADER):
        raise RecordingError(f"{len(content)} bytes of a chunk claim to be {size} bytes")
    compressed = content[CHUNK_HEADER:]
    try:
        if zstandard.frame_content_size(compressed) not in (-1, size):  # decompress() would obey the frame
            raise RecordingError("a chunk declares two different sizes")
        decompressor = zstandard.ZstdDecompressor(max_window_size=RECORD_LIMIT)
        data = decompressor.decompress(compressed, max_output_size=size, allow_extra_data=False)
    except (zstandard.ZstdError, MemoryError) as error:
        raise RecordingError("a chunk cannot be decompressed") from error
    if crc == 0 or zlib.crc32(data) != crc:
        raise RecordingError("a chunk's checksum is wrong")
    channels, messages = _records(data)
    if not messages or messages[0].log_time != start or messages[-1].log_time != end:
        raise RecordingError("a chunk's times are wrong")
    return Chunk(start, end, channels, messages, data)


def _is_plausible(size: int, compressed: int) -> bool:
    """Whether a chunk can have such sizes.  All work on a file so stays in proportion to its bytes."""
    return size <= min(RECORD_LIMIT, SMALL_CHUNK + EXPANSION * compressed)


def _records(data: bytes) -> tuple[list[Channel], list[Message]]:
    channels, messages = [], []
    at, log_time = 0, 0
    while at < len(data):
        try:
            opcode, length = RECORD.unpack_from(data, at)
            at += RECORD.size
            if opcode == Opcode.MESSAGE and length >= MESSAGE.size:
                message = Message._make((*MESSAGE.unpack_from(data, at), data[at + MESSAGE.size : at + length]))
                if message.log_time < log_time:
                    raise RecordingError("the clock runs backwards")
                log_time = message.log_time
                messages.append(message)
            elif opcode == Opcode.CHANNEL:
                channel = read_record(opcode, data[at : at + length])
                assert isinstance(channel, Channel)
                channels.append(channel)
        except struct.error as error:
            raise RecordingError("a record in a chunk is cut short") from error
        at += length
        if len(channels) > CHANNEL_LIMIT:
            raise RecordingError("unexpectedly many channels in a chunk")
    if at != len(data):
        raise RecordingError("a record in a chunk is cut short")
    return channels, messages


def read_record(opcode: int, content: bytes) -> McapRecord | None:
    """The record of this content; None for an index, of which only the form is checked.

    Records other than chunks have no checksum of their own, but their lengths must agree.
    """
    if opcode == Opcode.MESSAGE_INDEX:
        if len(content) < 6 or len(content) != 6 + int.from_bytes(content[2:6], "little"):
            raise RecordingError("an index is damaged")
        return None
    if len(content) > SMALL_LIMIT:
        raise RecordingError(f"unexpected record of {len(content)} bytes")
    stream = ReadDataStream(BytesIO(content))
    try:
        record = _READERS[Opcode(opcode)](stream)
    except KeyError as error:
        raise RecordingError("unexpected kind of record") from error
    except (McapError, ValueError, OverflowError, struct.error) as error:
        raise RecordingError("a record is damaged") from error
    if stream.count != len(content):
        raise RecordingError("a record's length is wrong")
    return record


def record_at(stream: BinaryIO, offset: int) -> tuple[int, bytes] | None:
    """(opcode, content) of the record there; None if the file ends within it.

    Raises RecordingError for anything that cannot be a record.
    """
    stream.seek(offset)
    header = stream.read(RECORD.size)
    if len(header) < RECORD.size:
        return None
    opcode, length = RECORD.unpack(header)
    if not 0 < opcode <= _LAST_OPCODE:
        raise RecordingError("there is no record where one should begin")
    if length > RECORD_LIMIT:
        raise RecordingError(f"unexpected record of {length} bytes")
    content = stream.read(length)
    return (opcode, content) if len(content) == length else None


class Search:
    """Looks for intact chunks past damage, and gives up on a file that is full of false ones."""

    def __init__(self, stream: BinaryIO) -> None:
        self._stream, self._left = stream, SEARCH_LIMIT

    def next_chunk(self, offset: int) -> int | None:
        """Where the first intact chunk from `offset` on begins."""
        before = RECORD.size + _CHUNK.size  # of a chunk's record lie before the name of its compression
        while True:
            self._stream.seek(offset)
            block = self._stream.read(_SEARCH_BLOCK)
            found = block.find(ZSTD, before)
            while found >= 0:
                if block[found - before] == Opcode.CHUNK and self._is_chunk(offset + found - before):
                    return offset + found - before
                if self._left < 0:
                    return None
                found = block.find(ZSTD, found + 1)
            if len(block) < _SEARCH_BLOCK:
                return None
            offset += len(block) - before - len(ZSTD) + 1

    def _is_chunk(self, offset: int) -> bool:
        self._stream.seek(offset)
        header = self._stream.read(RECORD.size + CHUNK_HEADER)
        if len(header) < RECORD.size + CHUNK_HEADER:
            return False
        length = RECORD.unpack_from(header)[1]
        size = _CHUNK.unpack_from(header, RECORD.size)[2]
        compressed = int.from_bytes(header[-8:], "little")
        if length != CHUNK_HEADER + compressed or length > RECORD_LIMIT or not _is_plausible(size, compressed):
            return False
        try:
            record = record_at(self._stream, offset)
            if record is not None and read_chunk(record[1]):
                return True
        except RecordingError:
            pass
        self._left -= length + size
        return False
