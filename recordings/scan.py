"""Scan: read a file from its first byte to its last, past any damage, and check everything."""

import zlib
from collections import Counter, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import SEEK_END
from operator import eq, ge
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.records import Channel, DataEnd, Header, Metadata

from engine.scenes import Scene
from recordings.contents import Contents, Layout, layout_of, seal_of
from recordings.errors import RecordingError, printable_items
from recordings.events import Entry, Event, Seal
from recordings.format import METADATA, PROFILE
from recordings.framing import CHANNEL_LIMIT, MAGIC, RECORD, Chunk, Message, Search, read_chunk, read_record, record_at
from recordings.summary import MESSAGE_SIZE, Chunks, Digest, Summary, find_summary, read_summary

ShowProgress = Callable[[int, int], None]
"""Called with how much is done and how much there is: bytes, or samples."""

ALTERED = "something was changed, added or left out after it was recorded"


@dataclass(frozen=True, slots=True)
class Gap:
    """An unreadable stretch of a file."""

    offset: int


@dataclass(frozen=True, slots=True)
class Intact:
    """A chunk as it was written."""

    offset: int
    end: int
    layout: Layout
    chunk: Chunk


class Scan:
    """The intact chunks of a file and the gaps between them, in order.  Its attributes are final at the end.

    Raises RecordingError for a file that is not one of ours, and for chunks whose clock runs backwards.

    `complete`: finished by the recorder, and every checksum right.  `damaged`: something was changed or
    lost; a recording that was only not finished is not.  `reason`: the first thing wrong, a clause.
    `sealed`: whether the digests are right, up to where it is first damaged; None for a file without any.
    """

    def __init__(self, stream: BinaryIO, progress: ShowProgress | None = None) -> None:
        self.complete = self.damaged = False
        self.reason: str | None = None
        self._profile = PROFILE
        self.metadata: dict[str, str] = {}
        self.size = stream.seek(0, SEEK_END)
        self._stream, self._progress = stream, progress
        stream.seek(0)
        start = stream.read(len(MAGIC))
        if not start:
            raise RecordingError("the file is empty")
        if sum(map(eq, start, MAGIC)) < len(start) / 2:  # fewer wrong bytes are damage, which the scan finds
            raise RecordingError("this is not an MCAP file")
        self._begins_right = start == MAGIC[: len(start)]
        self.summary = find_summary(stream)
        self.chunks = Chunks()  # the intact ones so far
        self.messages: Counter[int] = Counter()  # in them, by channel
        self.samples = 0  # in them
        self.sealed: bool | None = None
        self.seal: Seal | None = None  # the last right one
        self._starts: dict[int, Scene] = {}  # of the last run
        self._digest: Digest | None = Digest()  # None after a gap
        self.layout: Layout | None = None  # once a chunk was met
        self.channels = dict(self.summary.channels) if self.summary else {}

    def progress_within(self, piece: Intact) -> Callable[[float], None] | None:
        """A callback that shows the share done of the work on this chunk."""
        progress = self._progress
        if progress is None:
            return None
        return lambda share: progress(round(piece.offset + share * (piece.end - piece.offset)), self.size)

    def nothing(self, done: str) -> RecordingError:
        """Why nothing in it can be read, verified or saved."""
        if self._profile != PROFILE:
            return RecordingError("this is an MCAP file, but not a recording of pendu-tui")
        return RecordingError(f"nothing in it can be {done}: {self.reason or 'it has no samples'}")

    def entries(self, piece: Intact) -> Iterator[tuple[list[Message], Entry]]:
        """The entries of an intact chunk, each with its messages.  Raises RecordingError for unexpected ones.

        Of a run whose start was not in the chunk or before, samples have one reading.
        """
        for parts, entry in piece.layout.entries(piece.chunk.messages, self._starts.get):
            if isinstance(entry.value, Event) and entry.value.scene is not None:
                self._starts = {entry.value.run: entry.value.scene}
            yield parts, entry

    def contents(self) -> Contents:
        """What the file holds, by a scan to its end.  Raises RecordingError if nothing in it can be read."""
        deque(self, maxlen=0)
        if self.layout is None:
            raise self.nothing("read")
        return Contents(
            layout=self.layout,
            chunks=self.chunks,
            samples=max(self.samples, self.layout.samples(self.messages)),
            metadata=self.metadata,
            complete=self.complete,
            damaged=self.damaged or self.sealed is False,
            reason=self.reason,
            seal=self.seal,
            sealed=self.sealed,
        )

    def __iter__(self) -> Iterator[Intact | Gap]:
        offset, crc = len(MAGIC), zlib.crc32(MAGIC)
        search = Search(self._stream)
        if not self._begins_right:
            self._damage("its first bytes are damaged")
        while True:
            if self._progress:
                self._progress(offset, self.size)
            chunk = None
            try:
                record = record_at(self._stream, offset)
                if record is None:
                    if search.next_chunk(offset + 1) is None:
                        self.reason = self.reason or "the recording was not finished"
                        if offset < self.size:
                            yield Gap(offset)
                        return
                    raise RecordingError("a record's length is wrong")
                opcode, content = record
                if opcode == Opcode.CHUNK:
                    chunk = read_chunk(content)
                    self._declare(chunk.channels)
                else:
                    match read_record(opcode, content):
                        case Channel() as channel:
                            self._declare([channel])
                        case Metadata(name=name, metadata=metadata):
                            if name == METADATA:
                                self.metadata = printable_items(metadata)
                            if self._digest:
                                self._digest.add(RECORD.pack(opcode, len(content)) + content)
                        case Header(profile=profile):
                            self._profile = profile
                        case DataEnd(data_section_crc=expected):
                            self._end(offset, expected == crc)
                            return
            except RecordingError as error:
                following = search.next_chunk(offset + 1)
                self._damage(f"{error} (at byte {offset})")
                self._digest = None
                yield Gap(offset)
                if following is None:
                    return
                offset = following
                continue
            if chunk:
                if self.layout is None:
                    if self.damaged and not self.channels:  # they were declared in what is lost
                        yield Gap(offset)
                        offset += RECORD.size + len(content)
                        continue
                    self.layout = layout_of(self.channels.values())
                found = Counter(message.channel for message in chunk.messages)
                self.messages += found
                self.samples += self.layout.samples_in(chunk.messages)
                self.chunks.add(offset, chunk.start, chunk.end, self.layout.events in found)
                self._check_seal(chunk, self.layout)
                yield Intact(offset, offset + RECORD.size + len(content), self.layout, chunk)
            crc = zlib.crc32(content, zlib.crc32(RECORD.pack(opcode, len(content)), crc))
            offset += RECORD.size + len(content)

    def _declare(self, channels: list[Channel]) -> None:
        for channel in channels:
            self.channels[channel.id] = channel
            self.layout = None
        if len(self.channels) > CHANNEL_LIMIT:
            raise RecordingError("unexpectedly many channels")

    def _check_seal(self, chunk: Chunk, layout: Layout) -> None:
        """Compare a chunk's seal with all bytes so far; after a wrong one the others count as wrong, too."""
        if layout.version == 1 or self._digest is None or self.sealed is False:
            return
        seal, end = seal_of(chunk, layout), len(chunk.data) - len(chunk.messages[-1].data) - MESSAGE_SIZE
        self._digest.add(memoryview(chunk.data)[:end])
        self.sealed = seal is not None and seal.sha256 == self._digest.sha256 and not (self.seal and self.seal.end)
        self._digest.add(memoryview(chunk.data)[end:])
        if self.sealed:
            self.seal = seal
        else:
            self.reason = self.reason or f"its digest does not match from byte {self.chunks.offsets[-1]} on: {ALTERED}"

    def _end(self, offset: int, right: bool) -> None:
        """Check what follows the data.  Damage there leaves no gap."""
        if self.sealed and self._digest and not (self.seal and self.seal.end):
            self.sealed = False
            self.reason = self.reason or f"its end is not the recorder's: {ALTERED}"
        if not right:
            self._damage("its checksum is wrong")
        elif self.summary is None or offset != self.summary.data_end:
            try:
                if read_summary(self._stream, offset):
                    self._damage("its summary is not where its footer says")
                self.reason = self.reason or "the file ends within its summary"
            except RecordingError as error:
                self._damage(str(error))
        elif not self._agrees(self.summary):
            self._damage("its summary contradicts what is in it")
        self.complete = self.reason is None

    def _damage(self, reason: str) -> None:
        self.damaged, self.reason = True, self.reason or reason

    def _agrees(self, summary: Summary) -> bool:
        statistics = summary.statistics
        return (
            statistics is not None
            and statistics.message_count == self.messages.total()
            and Counter(statistics.channel_message_counts) == self.messages
            and (summary.chunks.offsets, summary.chunks.starts, summary.chunks.ends)
            == (self.chunks.offsets, self.chunks.starts, self.chunks.ends)
            and all(map(ge, summary.chunks.eventful, self.chunks.eventful))
            and summary.channels == self.channels
        )
