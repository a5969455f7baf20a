"""Reader: the chunks of an MCAP file, past any damage, and their entries.

mcap takes records and chunks apart.  A chunk is the unit that is intact or lost: its checksum covers all
that is in it.  A finished file ends with a summary of where its chunks are; without one, or to check
every byte, `Scan` reads the file from its start and searches for intact chunks behind damage.
Sizes are bounded before anything is decompressed: all work stays in proportion to the file's bytes.
"""

import json
import struct
import zlib
from collections.abc import Callable, Collection, Iterator, Mapping
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


class Summary(NamedTuple):
    """The summary of a finished file; its checksum was right."""

    channels: dict[int, Channel]
    places: list[Place]
    data_end: int  # where the data before it end in the file
    data_crc: int  # their checksum


def read_summary(stream: BinaryIO) -> Summary | None:
    """Return the summary of a file; None if it has none, or one with a wrong checksum."""
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
        if head != [Opcode.DATA_END, 4] or zlib.crc32(data[_DATA_END.size : -4]) != crc or not data_crc:
            return None
        return Summary(*_read_index(data[_DATA_END.size :]), data_end, data_crc)
    except _BROKEN:
        return None


def _read_index(data: bytes) -> tuple[dict[int, Channel], list[Place]]:
    """Return the channels and chunks that a summary lists.

    Chunk indexes are unpacked here because a day has 108 000 of them.
    """
    channels: dict[int, Channel] = {}
    places: list[Place] = []
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
            places.append(Place(offset, start, end, has_events))
    return channels, places


def check_format(channels: Mapping[int, Channel]) -> None:
    """Raise RecordingError unless these are the channels of a recording of this format."""
    found = [each.metadata.get("format") for each in channels.values() if each.topic == EVENTS]
    if not found:
        raise RecordingError("this is an MCAP file, but not a recording of pendu-tui")
    if found[0] != FORMAT_VERSION:
        maker = "0.1" if found[0] in ("1", "2") else "another version"
        raise RecordingError(f"it was made by {maker}; this version reads format {FORMAT_VERSION}")


class OpenChunk(NamedTuple):
    """What is in an intact chunk."""

    channels: dict[int, Channel]  # declared in it
    messages: list[Message]


def read_chunk(stream: BinaryIO, offset: int) -> OpenChunk:
    """Read the chunk there.  Raises RecordingError if it is damaged, EOFError if it is cut off."""
    opcode, content = _read_record(stream, offset)
    if opcode != Opcode.CHUNK:
        raise RecordingError("there is no chunk where one should be")
    return _open_chunk(content)


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


def _open_chunk(content: bytes) -> OpenChunk:
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
    channels = {record.id: record for record in records if isinstance(record, Channel)}
    return OpenChunk(channels, messages)


class Scan:
    """The intact chunks of a file, in order.

    Its attributes are final after the last chunk.  `complete`: finished by the recorder, and every checksum
    right.  `damaged`: something was changed or lost; a recording that was only not finished is not.
    `reason`: the first thing wrong, a clause.
    """

    def __init__(self, stream: BinaryIO, progress: ShowProgress | None = None) -> None:
        self.complete = False
        self.damaged = False
        self.reason: str | None = None
        self.entries_lost = 0  # as far as the numbers of the others show
        self.size = stream.seek(0, SEEK_END)
        if not self.size:
            raise RecordingError("the file is empty")
        self._stream = stream
        self._progress = progress or (lambda done, size: None)
        self._summary = read_summary(stream)
        self.channels: dict[int, Channel] = {}
        if self._summary:
            self.channels |= self._summary.channels
            check_format(self.channels)
        self._sequence = 0  # the number of the next entry

    def __iter__(self) -> Iterator[tuple[Place, list[Message]]]:
        self._stream.seek(0)
        start = self._stream.read(len(MAGIC))
        if start != MAGIC[: len(start)]:
            self._damage("its first bytes are damaged" if self.channels else "this is not an MCAP file")
        offset = intact_end = len(MAGIC)
        crc = zlib.crc32(MAGIC)
        while True:
            self._progress(offset, self.size)
            chunk = None
            try:
                opcode, content = _read_record(self._stream, offset)
                if opcode == Opcode.CHUNK:
                    chunk = _open_chunk(content)
                elif opcode == Opcode.DATA_END:
                    self._check_end(offset, content, crc)
                    return
                elif opcode not in (Opcode.HEADER, Opcode.MESSAGE_INDEX):
                    raise RecordingError("there is no record where one should begin")
            except (RecordingError, EOFError) as error:
                following = self._search(intact_end)
                if following is not None or not isinstance(error, EOFError):
                    self._damage(str(error) or "a record's length is wrong")
                if following is None:
                    self.reason = self.reason or "the recording was not finished"
                    return
                offset = following
                continue
            crc = zlib.crc32(content, zlib.crc32(_RECORD.pack(opcode, len(content)), crc))
            if chunk:
                yield self._take(offset, chunk), chunk.messages
                intact_end = offset + _RECORD.size + len(content)
            offset += _RECORD.size + len(content)

    def _take(self, offset: int, chunk: OpenChunk) -> Place:
        self.channels |= chunk.channels
        if chunk.channels:
            check_format(self.channels)
        first = chunk.messages[0]
        last = chunk.messages[-1]
        missing = (first.sequence - self._sequence) % (1 << 32)
        if missing:
            self.entries_lost += missing
            self._damage(f"{missing} entries are lost")
        self._sequence = (last.sequence + 1) % (1 << 32)
        numbers = {message.channel_id for message in chunk.messages}
        events = {number for number, each in self.channels.items() if each.topic == EVENTS}
        return Place(offset, first.log_time, last.log_time, bool(numbers & events))

    def _check_end(self, offset: int, content: bytes, crc: int) -> None:
        """Check all that follows the data."""
        if content != crc.to_bytes(4, "little"):
            self._damage("its checksum is wrong")
        if self._summary is None or self._summary.data_end != offset:
            self.reason = self.reason or "its summary is cut off or damaged"
        self.complete = self.reason is None

    def _damage(self, reason: str) -> None:
        self.damaged = True
        self.reason = self.reason or reason

    def _search(self, offset: int) -> int | None:
        """Return where the next intact chunk from `offset` on begins."""
        before = _RECORD.size + _BEFORE_ZSTD
        while True:
            self._stream.seek(offset)
            block = self._stream.read(_BLOCK)
            at = block.find(_ZSTD, before)
            while at >= 0:
                try:
                    read_chunk(self._stream, offset + at - before)
                except (RecordingError, EOFError):
                    at = block.find(_ZSTD, at + 1)
                else:
                    return offset + at - before
            if len(block) < _BLOCK:
                return None
            offset += len(block) - before - len(_ZSTD) + 1


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
        decoded = [decode_reading(part.data, model) for part, (model, _) in zip(parts, keys, strict=True)]
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
