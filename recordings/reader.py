"""Reader: the intact chunks of an MCAP file, past any damage.

A chunk is intact or lost, as its checksum covers all that is in it.  A finished file ends with a
summary of where its chunks are.  Without a summary, or if the file's checksum is
wrong, the intact chunks are searched for.  All work is proportional to the file's size.
"""

import mmap
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import SEEK_END, BytesIO
from itertools import chain
from typing import BinaryIO, NamedTuple

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel

from pendu_tui.recordings.files import MAGIC, RecordingError
from pendu_tui.recordings.format import EVENTS, FORMAT_VERSION

MAX_RECORD = 1 << 22  # bytes of a chunk and of its contents; the recorder's have 200 kB
MAX_EXPANSION = 128  # times the compressed size with its head; the recorder's reach 69
MAX_SUMMARY = 1 << 26  # bytes, read in a second; those of 570 000 chunks, five days
MAX_TIME = (1 << 63) - 1  # ns, of log_time
_RECORD = struct.Struct("<BQ")  # opcode, length of what follows
_MESSAGE = struct.Struct("<BQHIQQ")  # a message's head, to its log and publish time [ns]
_FOOTER = struct.Struct("<BQQQI8s")  # with the summary's start and checksum, and MAGIC
_INDEX = struct.Struct("<QQQQI")  # start, end [ns], offset, size, that of its map
_IN_MAP = 10  # bytes of a channel's number, of which the lowest is the first, and its offset
# opcode, length, start, end [ns], size, CRC, _ZSTD, packed size
_CHUNK = struct.Struct("<BQQQQI8sQ")
_ZSTD = b"\x04\x00\x00\x00zstd"
_BEFORE_ZSTD = 37  # bytes of a chunk's record
_MAX_HEAD = _CHUNK.size + 18  # with the largest head of a zstd frame


class Group(NamedTuple):
    """Messages of one sequence number and time: an event, or a sample of all methods."""

    sequence: int
    log_time: int  # ns
    channels: list[int]
    data: list[bytes]


class Place(NamedTuple):
    """The place of a chunk in a file and in time."""

    offset: int
    start: int  # ns, log_time of its first message
    end: int  # ns, log_time of its last message
    may_have_events: bool
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
            raise RecordingError(f"it has another format; this version reads {FORMAT_VERSION}")
        self.topics[channel.id] = channel.topic


def read_contents(stream: BinaryIO, check: bool) -> Contents:
    """Find the chunks of a file by its summary, or by a search if that is missing or wrong.

    With `check`, the checksum of the whole file is verified.
    """
    size = stream.seek(0, SEEK_END)
    summary = _read_summary(stream, size)
    if summary is None:
        contents = _search(stream, {})
        contents.reason = contents.reason or "its end is missing or damaged"
    else:
        contents, data_end, crc = summary
        if check and _checksum(stream, data_end) != crc:
            contents = _search(stream, contents.topics)
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
        _, _, start, _, crc, magic = _FOOTER.unpack(stream.read())
        if magic != MAGIC or size - start > MAX_SUMMARY:
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
    chunk_index = int(Opcode.CHUNK_INDEX)
    events: set[int] = set()  # channels; a recorder opens them first, so each number is a byte
    chunks_end = 0  # chunks that overlap could take for ever
    at = 0
    while at < len(data):
        opcode, length = _RECORD.unpack_from(data, at)
        begin = at + _RECORD.size
        at = begin + length
        if opcode == chunk_index:
            start, end, offset, size, map_size = _INDEX.unpack_from(data, begin)
            if offset < chunks_end:
                raise ValueError
            chunks_end = offset + size
            begin += _INDEX.size
            may_have_events = not events.isdisjoint(data[begin : begin + map_size : _IN_MAP])
            contents.places.append(Place(offset, start, end, may_have_events))
        elif opcode == Opcode.CHANNEL:
            channel = _channel(data[begin:at])
            contents.add(channel)
            if channel.topic == EVENTS:
                events.add(channel.id)
    return contents


def read_chunk(stream: BinaryIO, offset: int) -> tuple[list[Channel], list[Group]]:
    """Return the channels declared in a chunk, and its messages in groups.

    Raises RecordingError if there is no intact chunk.
    """
    try:
        stream.seek(offset)
        packed, checksum = _sizes_in(stream.read(_MAX_HEAD))
        stream.seek(offset + _CHUNK.size)
        data = zstandard.ZstdDecompressor().decompress(stream.read(packed))
        if zlib.crc32(data) != checksum:
            raise ValueError
        return _records(data)
    except Exception as error:  # see _read_summary
        raise RecordingError("a chunk is damaged") from error


def _sizes_in(head: bytes) -> tuple[int, int]:
    """Return the compressed size of a chunk's contents, and their checksum, from its head.

    Raises ValueError, ZstdError or struct.error if its numbers cannot be those of a chunk.
    """
    opcode, length, _, _, size, checksum, compression, packed = _CHUNK.unpack_from(head)
    is_possible = (
        opcode == Opcode.CHUNK
        and compression == _ZSTD
        and length == _CHUNK.size - _RECORD.size + packed
        and length <= MAX_RECORD
        and size <= min(MAX_RECORD, MAX_EXPANSION * (length + 128))
    )
    # what zstandard allocates
    if not is_possible or zstandard.frame_content_size(head[_CHUNK.size :]) != size:
        raise ValueError
    return packed, checksum


def _records(data: bytes) -> tuple[list[Channel], list[Group]]:
    """Return the channels and messages in a chunk's contents, without mcap for speed."""
    message = int(Opcode.MESSAGE)
    declared = []
    groups: list[Group] = []
    latest = 0  # ns
    current = -1  # sequence number
    at = 0
    while at < len(data):
        opcode, length, channel, sequence, log_time, _ = _MESSAGE.unpack_from(data, at)
        end = at + _RECORD.size + length
        if opcode == message:
            if not latest <= log_time <= MAX_TIME:
                raise ValueError("time runs backwards, or is too late")
            if sequence != current:
                latest = log_time
                current = sequence
                channels: list[int] = []
                messages: list[bytes] = []
                groups.append(Group(sequence, log_time, channels, messages))
            channels.append(channel)
            messages.append(data[at + _MESSAGE.size : end])
        elif opcode == Opcode.CHANNEL:
            declared.append(_channel(data[at + _RECORD.size : end]))
        at = end
    if not groups:
        raise ValueError("no messages")
    return declared, groups


def _channel(data: bytes) -> Channel:
    channel: Channel = Channel.read(ReadDataStream(BytesIO(data)))
    return channel


def _search(stream: BinaryIO, topics: dict[int, str]) -> Contents:
    """Find the intact chunks of a file, and by their sequence numbers what is lost between them."""
    contents = Contents(topics)
    sequence = 0  # of the next entry
    for offset, channels, groups in _intact_chunks(stream):
        for channel in channels:
            contents.add(channel)
        first = groups[0]
        last = groups[-1]
        missing = first.sequence - sequence
        sequence = last.sequence + 1
        if missing > 0:
            contents.entries_lost += missing
            contents.damage(f"{missing} entries are lost")
        elif missing < 0:
            contents.damage("its entries are out of order")
        used = chain.from_iterable(group.channels for group in groups)
        has_events = any(contents.topics.get(number) == EVENTS for number in used)
        place = Place(offset, first.log_time, last.log_time, has_events, bool(missing))
        contents.places.append(place)
    stream.seek(0)
    start = stream.read(len(MAGIC))
    if start != MAGIC[: len(start)]:
        contents.damage("its first bytes are not those of an MCAP file")
    return contents


def _intact_chunks(stream: BinaryIO) -> Iterator[tuple[int, list[Channel], list[Group]]]:
    """Yield offset, channels and messages of each intact chunk in a file.

    It ends early when as many bytes as the file has were read for chunks that are not intact.
    """
    in_vain = 0
    at = 0
    if not stream.seek(0, SEEK_END):  # which has no map
        return
    with mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data:
        while in_vain <= len(data) and (found := data.find(_ZSTD, at + _BEFORE_ZSTD)) >= 0:
            at = found - _BEFORE_ZSTD
            packed = 0
            try:
                packed, _ = _sizes_in(data[at : at + _MAX_HEAD])
                channels, groups = read_chunk(stream, at)
            except (ValueError, struct.error, zstandard.ZstdError, RecordingError):
                in_vain += packed
                at += 1
            else:
                yield at, channels, groups
                at += _CHUNK.size + packed


def _checksum(stream: BinaryIO, size: int) -> int:
    """Return the checksum of a file's first bytes."""
    crc = 0
    stream.seek(0)
    for begin in range(0, size, MAX_RECORD):
        crc = zlib.crc32(stream.read(min(size - begin, MAX_RECORD)), crc)
    return crc
