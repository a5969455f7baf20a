"""Reader: the chunks of an MCAP file, past any damage, and their entries.

mcap takes chunks apart.  A chunk is the unit that is intact or lost: its checksum covers all that
is in it.  A finished file ends with a summary of where its chunks are.  Without one, or if the
file's checksum is wrong, a search finds the intact chunks.  Sizes are bounded before anything is
decompressed: all work stays in proportion to the file's bytes.
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
_FOOTER = struct.Struct("<BQQQI8s")  # with the summary's start and checksum, and MAGIC
_INDEX = struct.Struct("<QQQQI")  # start [ns], end [ns], offset, length, bytes of the map behind
_INDEX_MAP = struct.Struct("<HQ")  # channel, offset of its index
_ZSTD = b"\x04\x00\x00\x00zstd"
_BEFORE_ZSTD = _RECORD.size + 28  # bytes of a chunk's record
_BLOCK = 1 << 12

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

    `damaged`: something was changed or lost, not only not finished; `reason`: the first thing
    wrong, a clause.
    """

    channels: dict[int, Channel] = field(default_factory=dict)
    places: list[Place] = field(default_factory=list)
    reason: str | None = None
    damaged: bool = False
    entries_lost: int = 0  # as far as the numbers of the others show

    def damage(self, reason: str) -> None:
        """Note that something is wrong."""
        self.damaged = True
        self.reason = self.reason or reason


def read_contents(
    stream: BinaryIO, check: bool = False, progress: ShowProgress | None = None
) -> Contents:
    """Find the chunks of a file by its summary, or by a search if that is missing or wrong.

    With `check`, the checksum of a file of any size is compared.
    """
    size = stream.seek(0, SEEK_END)
    if not size:
        raise RecordingError("the file is empty")
    summary = _read_summary(stream, size)
    if summary is None:
        return _search(stream, size, Contents(), progress)
    contents, data_end, crc = summary
    check_format(contents.channels)
    if data_end > MAX_CHECKED and not check:
        return contents
    if _checksum(stream, data_end, progress) == crc:
        return contents
    found = _search(stream, size, Contents(contents.channels), progress)
    found.damage("its checksum is wrong")
    return found


def _read_summary(stream: BinaryIO, size: int) -> tuple[Contents, int, int] | None:
    """Return what the summary of a finished file lists, the size of the data before it, and their
    checksum; None without a summary, or if it is damaged.
    """
    stream.seek(max(0, size - _FOOTER.size))
    try:
        opcode, _, start, _, crc, magic = _FOOTER.unpack(stream.read())
        if (opcode, magic) != (Opcode.FOOTER, MAGIC) or size - start > MAX_SUMMARY:
            return None
        stream.seek(start - 4)
        data = stream.read()
        data_crc = int.from_bytes(data[:4], "little")
        summary = data[4 : -_FOOTER.size]
        if not data_crc or zlib.crc32(data[4 : -4 - len(MAGIC)]) != crc:
            return None
        return _read_index(summary), start - 4 - _RECORD.size, data_crc
    except Exception:  # mcap and struct raise eight kinds on bytes that nobody wrote
        return None


def _read_index(data: bytes) -> Contents:
    """Unpack a summary; chunk indexes here and not by mcap, because a day has 108 000 of them."""
    contents = Contents()
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
    return contents


def check_format(channels: Mapping[int, Channel]) -> None:
    """Raise RecordingError unless these are the channels of a recording of this format."""
    found = [each.metadata.get("format") for each in channels.values() if each.topic == EVENTS]
    if not found:
        raise RecordingError("this is an MCAP file, but not a recording of pendu-tui")
    if found[0] != FORMAT_VERSION:
        maker = "0.1" if found[0] in ("1", "2") else "another version"
        raise RecordingError(f"it was made by {maker}; this version reads format {FORMAT_VERSION}")


def read_chunk(stream: BinaryIO, offset: int) -> tuple[dict[int, Channel], list[Message]]:
    """Return the channels declared in a chunk, and its messages; read up to its end.

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
            and size <= min(MAX_RECORD, SMALL_CHUNK + MAX_EXPANSION * len(chunk.data))
            and zstandard.frame_content_size(chunk.data) == size  # the one that is obeyed
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
    return {record.id: record for record in records if isinstance(record, Channel)}, messages


def _search(
    stream: BinaryIO, size: int, contents: Contents, progress: ShowProgress | None
) -> Contents:
    """Find the intact chunks of a file, and by their numbers what is lost between them."""
    sequence = 0  # the number of the next entry
    for offset, declared, messages in _intact_chunks(stream):
        if declared:
            contents.channels |= declared
            check_format(contents.channels)
        first, last = messages[0], messages[-1]
        missing = (first.sequence - sequence) % (1 << 32)
        sequence = last.sequence + 1
        if missing:
            contents.entries_lost += missing
            contents.damage(f"{missing} entries are lost")
        channels = (contents.channels.get(message.channel_id) for message in messages)
        has_events = any(channel and channel.topic == EVENTS for channel in channels)
        place = Place(offset, first.log_time, last.log_time, has_events, bool(missing))
        contents.places.append(place)
        if progress:
            progress(offset, size)
    stream.seek(0)
    start = stream.read(len(MAGIC))
    if start != MAGIC[: len(start)]:
        is_mcap = bool(contents.places)
        contents.damage("its first bytes are damaged" if is_mcap else "this is not an MCAP file")
    contents.reason = contents.reason or "its end is missing or damaged"
    return contents


def _intact_chunks(
    stream: BinaryIO,
) -> Iterator[tuple[int, dict[int, Channel], list[Message]]]:
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


def _checksum(stream: BinaryIO, size: int, progress: ShowProgress | None) -> int:
    """Return the checksum of a file's first bytes."""
    crc = 0
    stream.seek(0)
    for begin in range(0, size, MAX_RECORD):
        crc = zlib.crc32(stream.read(min(size - begin, MAX_RECORD)), crc)
        if progress:
            progress(begin, size)
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
