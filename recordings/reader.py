"""Reader: the intact chunks of an MCAP file, past any damage.

A chunk is intact or lost, as its checksum covers all that is in it; mcap unpacks it.  A finished
file ends with a summary of where its chunks are.  Without a summary, or if the file's checksum is
wrong, the intact chunks are searched for.  All work is proportional to the file's size.
"""

import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from io import SEEK_END, BytesIO
from typing import BinaryIO, NamedTuple

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Message
from mcap.stream_reader import breakup_chunk

from pendu_tui.recordings.errors import RecordingError
from pendu_tui.recordings.format import EVENTS, FORMAT_VERSION
from pendu_tui.recordings.library import MAGIC

MAX_RECORD = 1 << 22  # bytes of a chunk and of its contents; the recorder's have 200 kB
MAX_EXPANSION = 128  # times the compressed size with its head; the recorder's reach 69
MAX_SUMMARY = 1 << 26  # bytes; enough for four days
_RECORD = struct.Struct("<BQ")  # opcode, length of what follows
_FOOTER = struct.Struct("<BQQQI8s")  # with the summary's start and checksum, and MAGIC
_INDEX = struct.Struct("<QQQQI")  # start [ns], end [ns], offset, length, bytes of the map after it
_INDEX_MAP = struct.Struct("<HQ")  # channel, offset of its index
_ZSTD = b"\x04\x00\x00\x00zstd"
_BEFORE_ZSTD = _RECORD.size + 28  # bytes of a chunk's record
_BLOCK = 1 << 12

ShowProgress = Callable[[int, int], None]
"""Called with the bytes done and those in all."""


class Place(NamedTuple):
    """The place of a chunk in a file and in time."""

    offset: int
    start: int  # ns, log_time of its first message
    end: int  # ns, log_time of its last message
    has_events: bool
    is_after_gap: bool = False  # entries before it are lost


@dataclass(slots=True)
class Contents:
    """The intact chunks of a file."""

    topics: dict[int, str] = field(default_factory=dict)  # by channel
    places: list[Place] = field(default_factory=list)
    reason: str | None = None  # the first thing that is wrong, a clause
    damaged: bool = False  # something was changed or lost; an unfinished file is not damaged
    entries_lost: int = 0  # as far as sequence numbers show

    def damage(self, reason: str) -> None:
        self.damaged = True
        self.reason = self.reason or reason

    def add(self, channel: Channel) -> None:
        """Add a channel.  Raises RecordingError if the file is of another format."""
        version = channel.metadata.get("format")
        if channel.topic == EVENTS and version != FORMAT_VERSION:
            maker = "0.1" if version in ("1", "2") else "another version"
            raise RecordingError(
                f"it was made by {maker}; this version reads format {FORMAT_VERSION}"
            )
        self.topics[channel.id] = channel.topic


def read_contents(
    stream: BinaryIO, check: bool = False, progress: ShowProgress | None = None
) -> Contents:
    """Find the chunks of a file by its summary, or by a search if that is missing or wrong.

    With `check`, the checksum of the whole file is verified.
    """
    size = stream.seek(0, SEEK_END)
    if not size:
        raise RecordingError("the file is empty")
    summary = _read_summary(stream, size)
    if summary is None:
        contents = _search(stream, size, {}, progress)
    else:
        contents, data_end, crc = summary
        if check and _checksum(stream, data_end) != crc:
            contents = _search(stream, size, contents.topics, progress)
            contents.damage("its checksum is wrong")
    if EVENTS not in contents.topics.values() and not contents.reason:
        raise RecordingError("this is an MCAP file, but not a recording of pendu-tui")
    return contents


def _read_summary(stream: BinaryIO, size: int) -> tuple[Contents, int, int] | None:
    """Return the contents that the summary lists, the size of the data before it and its checksum.

    Return None if there is no summary, or if it is damaged.
    """
    stream.seek(max(0, size - _FOOTER.size))
    try:
        opcode, _, start, _, crc, magic = _FOOTER.unpack(stream.read())
        if (opcode, magic) != (Opcode.FOOTER, MAGIC) or size - start > MAX_SUMMARY:
            return None
        stream.seek(start - 4)
        data = stream.read()
        data_crc = int.from_bytes(data[:4], "little")
        if not data_crc or zlib.crc32(data[4 : -4 - len(MAGIC)]) != crc:
            return None
        return _read_index(data[4 : -_FOOTER.size]), start - 4 - _RECORD.size, data_crc
    except RecordingError:
        raise
    except Exception:  # mcap and struct raise eight kinds of exceptions on arbitrary bytes
        return None


def _read_index(data: bytes) -> Contents:
    """Unpack a summary, chunk indexes without mcap because a day has 108 000 of them."""
    contents = Contents()
    at = 0
    while at < len(data):
        opcode, length = _RECORD.unpack_from(data, at)
        begin = at + _RECORD.size
        at = begin + length
        if opcode == Opcode.CHANNEL:
            contents.add(Channel.read(ReadDataStream(BytesIO(data[begin:at]))))
        elif opcode == Opcode.CHUNK_INDEX:
            start, end, offset, _, map_length = _INDEX.unpack_from(data, begin)
            begin += _INDEX.size
            indexed = _INDEX_MAP.iter_unpack(data[begin : begin + map_length])
            has_events = any(contents.topics[number] == EVENTS for number, _ in indexed)
            contents.places.append(Place(offset, start, end, has_events))
    return contents


def read_chunk(stream: BinaryIO, offset: int) -> tuple[list[Channel], list[Message]]:
    """Return the channels declared in a chunk, and its messages; leave the stream at its end.

    Raises RecordingError if there is no intact chunk.
    """
    stream.seek(offset)
    try:
        opcode, length = _RECORD.unpack(stream.read(_RECORD.size))
        if opcode != Opcode.CHUNK or length > MAX_RECORD:
            raise ValueError
        chunk = Chunk.read(ReadDataStream(BytesIO(stream.read(length))))
        size = chunk.uncompressed_size
        is_possible = (
            chunk.compression == "zstd"
            and chunk.uncompressed_crc  # 0 would not be checked
            and _RECORD.size + length == _BEFORE_ZSTD + len(_ZSTD) + 8 + len(chunk.data)
            and size <= min(MAX_RECORD, MAX_EXPANSION * (length + 128))
            and zstandard.frame_content_size(chunk.data) == size  # what zstandard allocates
        )
        if not is_possible:
            raise ValueError
        records = breakup_chunk(chunk, validate_crc=True)
        messages = [record for record in records if isinstance(record, Message)]
        times = [message.log_time for message in messages]
        limits = (times[0], times[-1])
        if times != sorted(times) or limits != (chunk.message_start_time, chunk.message_end_time):
            raise ValueError
    except Exception as error:  # see _read_summary
        raise RecordingError("a chunk is damaged") from error
    return [record for record in records if isinstance(record, Channel)], messages


def _search(
    stream: BinaryIO, size: int, topics: dict[int, str], progress: ShowProgress | None
) -> Contents:
    """Find the intact chunks of a file, and by their sequence numbers what is lost between them."""
    contents = Contents(topics)
    sequence = 0  # of the next entry
    for offset, channels, messages in _intact_chunks(stream):
        for channel in channels:
            contents.add(channel)
        first, last = messages[0], messages[-1]
        missing = (first.sequence - sequence) % (1 << 32)
        sequence = last.sequence + 1
        if missing:
            contents.entries_lost += missing
            contents.damage(f"{missing} entries are lost")
        channel_ids = {message.channel_id for message in messages}
        has_events = any(contents.topics.get(number) == EVENTS for number in channel_ids)
        place = Place(offset, first.log_time, last.log_time, has_events, bool(missing))
        contents.places.append(place)
        if progress:
            progress(offset, size)
    stream.seek(0)
    start = stream.read(len(MAGIC))
    if start != MAGIC[: len(start)]:
        reason = "this is not an MCAP file"
        if contents.places:
            reason = "its first bytes are damaged"
        contents.damage(reason)
    contents.reason = contents.reason or "its end is missing or damaged"
    return contents


def _intact_chunks(stream: BinaryIO) -> Iterator[tuple[int, list[Channel], list[Message]]]:
    """Yield offset, channels and messages of each intact chunk."""
    offset = 0
    while True:
        stream.seek(offset)
        block = stream.read(_BLOCK)
        at = block.find(_ZSTD, _BEFORE_ZSTD)
        if at < 0:
            if len(block) < _BLOCK:
                return
            offset += _BLOCK - _BEFORE_ZSTD - len(_ZSTD) + 1
            continue
        offset += at - _BEFORE_ZSTD
        try:
            channels, messages = read_chunk(stream, offset)
        except RecordingError:
            offset += 1
            continue
        end = stream.tell()
        yield offset, channels, messages
        offset = end


def _checksum(stream: BinaryIO, size: int) -> int:
    """Return the checksum of a file's first bytes."""
    crc = 0
    stream.seek(0)
    for begin in range(0, size, MAX_RECORD):
        crc = zlib.crc32(stream.read(min(size - begin, MAX_RECORD)), crc)
    return crc
