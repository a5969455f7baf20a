"""Reader: the chunks of an MCAP file, past any damage, and their entries.

mcap takes records and chunks apart.  A chunk is the unit that is intact or lost: its checksum
covers all that is in it.  A finished file ends with a summary of where its chunks are; without one,
or to check every byte, a scan reads the file from its start and searches for intact chunks behind
damage. Sizes are bounded before anything is decompressed: all work stays in proportion to the
file's bytes.
"""

import json
import struct
import zlib
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from io import SEEK_END, BytesIO
from itertools import groupby
from operator import attrgetter
from typing import BinaryIO, NamedTuple

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Message
from mcap.stream_reader import breakup_chunk

from engine.run.lockstep import Sample
from engine.run.stepping import Stepping
from engine.scenes import Scene, SceneError
from recordings.errors import RecordingError, printable
from recordings.events import Entry, Event
from recordings.format import (
    ABOUT,
    CLOCK_OFFSET,
    EVENTS,
    FORMAT_VERSION,
    decode_event,
    decode_reading,
    keys_of,
)

MAGIC = b"\x89MCAP0\r\n"
MAX_RECORD = 1 << 22  # bytes of a chunk, and of what it decompresses to; a recorder's have 200 kB
MAX_EXPANSION = 128  # times its compressed size, besides SMALL_CHUNK; a recorder's reach 69
SMALL_CHUNK = 1 << 14  # bytes
MAX_SUMMARY = 1 << 26  # bytes; four days
MAX_CHECKED = 1 << 26  # bytes that are checked whenever a file is opened: 50 ms
_RECORD = struct.Struct("<BQ")  # opcode, length of what follows
_DATA_END = struct.Struct("<BQI")  # with the checksum of all before it
_FOOTER = struct.Struct("<BQQQI8s")  # with the summary's start and checksum, and MAGIC
_INDEX = struct.Struct("<QQQQI")  # start [ns], end [ns], offset, length, bytes of the map behind
_INDEX_MAP = struct.Struct("<HQ")  # channel, offset of its index
_ZSTD = b"\x04\x00\x00\x00zstd"
_BEFORE_ZSTD = 28  # bytes of a chunk's content
_BLOCK = 1 << 20
_BROKEN = (
    McapError,
    zstandard.ZstdError,
    struct.error,
    ValueError,
    LookupError,
    OverflowError,
    MemoryError,
)
"""What mcap and zstandard raise on bytes that nobody wrote."""

ShowProgress = Callable[[int, int], None]
"""Called with how much is done and how much there is: bytes, or samples."""


class Place(NamedTuple):
    """Where a chunk is in a file, and on the clock."""

    offset: int
    start: int  # ns, log_time of its first message
    end: int  # ns, of its last
    has_events: bool
    is_after_gap: bool = False  # entries before it are lost


@dataclass(slots=True)
class Contents:
    """The intact chunks of a file.

    `complete`: finished by the recorder, and nothing is wrong; `damaged`: something was changed or
    lost, not only not finished; `reason`: the first thing wrong, a clause.
    """

    channels: dict[int, Channel] = field(default_factory=dict)
    places: list[Place] = field(default_factory=list)
    reason: str | None = None
    damaged: bool = False
    entries_lost: int = 0  # as far as the numbers of the others show
    data_end: int = 0  # where the data before the summary end in the file
    data_crc: int = 0  # their checksum

    def damage(self, reason: str) -> None:
        """Note that something is wrong."""
        self.damaged = True
        self.reason = self.reason or reason


def read_contents(stream: BinaryIO, check: bool, progress: ShowProgress | None) -> Contents:
    """Find the chunks of a file by its summary, or with `check` or without a summary by a scan."""
    summary = read_summary(stream)
    if summary is not None:
        check_format(summary.channels)
        is_long = summary.data_end > MAX_CHECKED
        if not check and (is_long or _checksum(stream, summary.data_end) == summary.data_crc):
            return summary
    return _scan(stream, summary, progress or (lambda done, size: None))


def read_summary(stream: BinaryIO) -> Contents | None:
    """Return what the summary of a finished file says; None without one, or if it is damaged."""
    size = stream.seek(0, SEEK_END)
    stream.seek(max(0, size - _FOOTER.size))
    try:
        *head, start, _, crc, magic = _FOOTER.unpack(stream.read())
        data_end = start - _DATA_END.size
        if head != [Opcode.FOOTER, 20] or magic != MAGIC or size - data_end > MAX_SUMMARY:
            return None
        stream.seek(data_end)
        data = stream.read()[: -len(MAGIC)]
        *head, data_crc = _DATA_END.unpack_from(data)
        is_right = zlib.crc32(data[_DATA_END.size : -4]) == crc and data_crc
        if head != [Opcode.DATA_END, 4] or not is_right:
            return None
        contents = Contents(data_end=data_end, data_crc=data_crc)
        _read_index(data[_DATA_END.size :], contents)
    except _BROKEN:
        return None
    return contents


def _read_index(data: bytes, contents: Contents) -> None:
    """Unpack a summary; chunk indexes here and not by mcap, because a day has 108 000 of them."""
    channels = contents.channels
    at = 0
    while at < len(data):
        opcode, length = _RECORD.unpack_from(data, at)
        begin = at + _RECORD.size
        at = begin + length
        if opcode == Opcode.CHANNEL:
            channel = Channel.read(ReadDataStream(BytesIO(data[begin:at])))
            channels[channel.id] = channel
        elif opcode == Opcode.CHUNK_INDEX:
            start, end, offset, _, map_length = _INDEX.unpack_from(data, begin)
            begin += _INDEX.size
            indexed = _INDEX_MAP.iter_unpack(data[begin : begin + map_length])
            has_events = any(channels[number].topic == EVENTS for number, _ in indexed)
            contents.places.append(Place(offset, start, end, has_events))


def check_format(channels: Mapping[int, Channel]) -> None:
    """Raise RecordingError unless these are the channels of a recording of this format."""
    found = [each.metadata.get("format") for each in channels.values() if each.topic == EVENTS]
    if not found:
        raise RecordingError("this is an MCAP file, but not a recording of pendu-tui")
    if found[0] != FORMAT_VERSION:
        maker = "0.1" if found[0] in ("1", "2") else "another version"
        raise RecordingError(f"it was made by {maker}; this version reads format {FORMAT_VERSION}")


def read_chunk(stream: BinaryIO, offset: int) -> tuple[dict[int, Channel], list[Message]]:
    """Return the channels declared in a chunk, and its messages.

    Raises RecordingError if it is damaged, EOFError if it is cut off.
    """
    opcode, content = _read_record(stream, offset)
    if opcode != Opcode.CHUNK:
        raise RecordingError("there is no chunk where one should be")
    try:
        chunk = Chunk.read(ReadDataStream(BytesIO(content)))
        size = chunk.uncompressed_size
        is_possible = (
            chunk.compression == "zstd"
            and chunk.uncompressed_crc  # 0 would not be checked
            and len(content) == _BEFORE_ZSTD + len(_ZSTD) + 8 + len(chunk.data)
            and size <= min(MAX_RECORD, SMALL_CHUNK + MAX_EXPANSION * len(chunk.data))
            and zstandard.frame_content_size(chunk.data) == size  # the one that is obeyed
        )
        if not is_possible:
            raise ValueError
        records = breakup_chunk(chunk, validate_crc=True)
    except _BROKEN as error:
        raise RecordingError("a chunk is damaged") from error
    messages = [record for record in records if isinstance(record, Message)]
    times = [message.log_time for message in messages]
    header = [chunk.message_start_time, chunk.message_end_time]
    if times != sorted(times) or [*times[:1], *times[-1:]] != header:
        raise RecordingError("a chunk's times are wrong")
    return {record.id: record for record in records if isinstance(record, Channel)}, messages


def _read_record(stream: BinaryIO, offset: int) -> tuple[int, bytes]:
    stream.seek(offset)
    head = stream.read(_RECORD.size)
    if len(head) < _RECORD.size:
        raise EOFError
    opcode, length = _RECORD.unpack(head)
    if length > MAX_RECORD:
        raise RecordingError(f"unexpected record of {length} bytes")
    content = stream.read(length)
    if len(content) < length:
        raise EOFError
    return opcode, content


def _scan(stream: BinaryIO, summary: Contents | None, progress: ShowProgress) -> Contents:
    """Read a file from its first byte to its last, past any damage, and check everything."""
    size = stream.seek(0, SEEK_END)
    if not size:
        raise RecordingError("the file is empty")
    contents = Contents(dict(summary.channels) if summary else {})
    stream.seek(0)
    start = stream.read(len(MAGIC))
    if start != MAGIC[: len(start)]:
        contents.damage("its first bytes are damaged" if summary else "this is not an MCAP file")
    offset = intact_end = len(MAGIC)
    sequence = 0  # the number of the next entry
    crc = zlib.crc32(MAGIC)
    while True:
        progress(offset, size)
        try:
            opcode, content = _read_record(stream, offset)
            if opcode == Opcode.CHUNK:
                sequence = _take_chunk(stream, offset, sequence, contents)
                intact_end = offset + _RECORD.size + len(content)
            elif opcode == Opcode.DATA_END:
                if content != crc.to_bytes(4, "little"):
                    contents.damage("its checksum is wrong")
                if summary is None or summary.data_end != offset:
                    contents.reason = contents.reason or "its summary is cut off or damaged"
                return contents
            elif opcode not in (Opcode.HEADER, Opcode.MESSAGE_INDEX):
                raise RecordingError("there is no record where one should begin")
        except (RecordingError, EOFError) as error:
            following = _search(stream, intact_end)
            if following is not None or not isinstance(error, EOFError):
                contents.damage(str(error) or "a record's length is wrong")
            if following is None:
                contents.reason = contents.reason or "the recording was not finished"
                return contents
            offset = following
            continue
        crc = zlib.crc32(content, zlib.crc32(_RECORD.pack(opcode, len(content)), crc))
        offset += _RECORD.size + len(content)


def _take_chunk(stream: BinaryIO, offset: int, sequence: int, contents: Contents) -> int:
    """Add a chunk to the contents; return the number of the next entry."""
    channels, messages = read_chunk(stream, offset)
    contents.channels |= channels
    if channels:
        check_format(contents.channels)
    first, last = messages[0], messages[-1]
    missing = (first.sequence - sequence) % (1 << 32)
    if missing:
        contents.entries_lost += missing
        contents.damage(f"{missing} entries are lost")
    known = contents.channels
    numbers = {message.channel_id for message in messages} & known.keys()
    has_events = any(known[number].topic == EVENTS for number in numbers)
    contents.places.append(Place(offset, first.log_time, last.log_time, has_events, bool(missing)))
    return (last.sequence + 1) % (1 << 32)


def _search(stream: BinaryIO, offset: int) -> int | None:
    """Return where the next intact chunk from `offset` on begins."""
    before = _RECORD.size + _BEFORE_ZSTD
    while True:
        stream.seek(offset)
        block = stream.read(_BLOCK)
        at = block.find(_ZSTD, before)
        while at >= 0:
            try:
                read_chunk(stream, offset + at - before)
            except (RecordingError, EOFError):
                at = block.find(_ZSTD, at + 1)
            else:
                return offset + at - before
        if len(block) < _BLOCK:
            return None
        offset += len(block) - before - len(_ZSTD) + 1


def _checksum(stream: BinaryIO, size: int) -> int:
    """Return the checksum of a file's first bytes."""
    crc = 0
    stream.seek(0)
    while size and (block := stream.read(min(size, _BLOCK))):
        crc = zlib.crc32(block, crc)
        size -= len(block)
    return crc


class Decoder:
    """Turns messages into entries, and checks that they fit their runs."""

    def __init__(self, channels: Mapping[int, Channel]) -> None:
        self._channels = channels
        self.scenes: dict[int, Scene] = {}  # of the runs whose start was read
        self.lost_runs: set[int] = set()  # those of the others
        self.about: dict[str, str] = {}  # where and how the recording was made
        self.others = 0  # entries that are no samples, in the chunks with events

    def entries(self, messages: Collection[Message], only_events: bool = False) -> Iterator[Entry]:
        """Yield the entries of a chunk, without those of runs whose start is lost.

        Messages of unknown topics are skipped.  Raises RecordingError for anything impossible.
        """
        for _, group in groupby(messages, attrgetter("sequence")):
            parts = [part for part in group if part.channel_id in self._channels]
            topics = [self._channels[part.channel_id].topic for part in parts]
            keys = [keys for name in topics if (keys := keys_of(name))]
            value: Event | Sample | None = None
            if topics == [EVENTS]:
                value = self._event(decode_event(parts[0].data))
            elif topics == [ABOUT]:
                self.about = _texts(parts[0].data)
            elif keys and not only_events:
                value = self._sample(parts, keys)
            self.others += only_events and not keys
            if value is not None and value.run in self.scenes:
                yield Entry((parts[0].log_time - CLOCK_OFFSET) / 1e9, value)
            elif value is not None:
                self.lost_runs.add(value.run)

    def _event(self, event: Event) -> Event:
        if event.scene is not None:
            if event.step or event.t:
                raise RecordingError(f"run {event.run} does not begin at its start")
            self.scenes.setdefault(event.run, event.scene)
        scene = self.scenes.get(event.run)
        if scene is not None and event.h is not None:
            try:
                Stepping(event.h, event.equal_cost, scene.cast).check(scene.w0)
            except SceneError as error:
                why = f"run {event.run} cannot have been recorded: {error}"
                raise RecordingError(why) from error
        if scene is not None and (milestone := event.milestone) is not None:
            others = {milestone.method, milestone.other} - {*scene.cast, None}
            if others:
                raise RecordingError("a milestone is of a method that the run does not have")
        return event

    def _sample(self, parts: list[Message], keys: list[tuple[str, str]]) -> Sample:
        if len(keys) < len(parts):
            raise RecordingError("a sample is incomplete")
        decoded = [
            decode_reading(part.data, model) for part, (model, _) in zip(parts, keys, strict=True)
        ]
        run, step, t, _ = decoded[0]
        scene = self.scenes.get(run)
        is_whole = scene is None or keys == [(scene.model, each.key) for each in scene.cast]
        if not is_whole or any(each[:3] != (run, step, t) for each in decoded):
            raise RecordingError("a sample is incomplete")
        return Sample(run, step, t, tuple(reading for *_, reading in decoded))


def _texts(data: bytes) -> dict[str, str]:
    try:
        texts = json.loads(data)
        return {printable(name): printable(str(value)) for name, value in texts.items()}
    except (ValueError, AttributeError, RecursionError) as error:
        raise RecordingError("a message is not JSON") from error
