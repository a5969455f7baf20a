"""Index: which chunks a file has and whether it is whole, from its summary or, failing that, from all of it."""

import zlib
from collections import deque
from dataclasses import dataclass
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.records import Metadata

from recordings.errors import RecordingError, printable_items
from recordings.format import METADATA
from recordings.framing import read_record, record_at
from recordings.layout import Layout, check_times, layout_of
from recordings.scan import Progress, Walk
from recordings.summary import Chunks, find_summary

CHECK_LIMIT = 1 << 26  # bytes checked whenever a file is opened: the first two hours, in 50 ms
_BLOCK = 1 << 20


@dataclass(frozen=True, slots=True)
class Index:
    """What is where.  `reason`: what is wrong, a clause; None if nothing is, or nothing was found so far."""

    layout: Layout
    chunks: Chunks
    samples: int
    metadata: dict[str, str]
    complete: bool
    damaged: bool
    reason: str | None


def index_of(stream: BinaryIO, check: bool, progress: Progress | None) -> Index:
    """The index of a file.  With `check` every byte is looked at; without, only where the summary does not hold."""
    index = None if check else _by_summary(stream)
    return index or _by_walk(stream, progress)


def _by_summary(stream: BinaryIO) -> Index | None:
    found = find_summary(stream)
    if found is None:
        return None
    summary, data_end, crc = found
    if summary.statistics is None or (data_end <= CHECK_LIMIT and _crc(stream, data_end) != crc):
        return None
    layout = layout_of(summary.channels.values())
    before = 0
    for start, end in zip(summary.chunks.starts, summary.chunks.ends, strict=True):
        check_times(before, start, before := end)
    try:
        metadata = _metadata(stream, summary.metadata_offsets)
    except RecordingError:
        return None
    return Index(
        layout=layout,
        chunks=summary.chunks,
        samples=layout.samples(summary.statistics.channel_message_counts),
        metadata=metadata,
        complete=True,
        damaged=False,
        reason=None,
    )


def _metadata(stream: BinaryIO, offsets: list[int]) -> dict[str, str]:
    metadata: dict[str, str] = {}
    for offset in offsets:
        record = record_at(stream, offset)
        match read_record(*record) if record and record[0] == Opcode.METADATA else None:
            case Metadata(name=name, metadata=found) if name == METADATA:
                metadata = printable_items(found)
    return metadata


def _by_walk(stream: BinaryIO, progress: Progress | None) -> Index:
    walk = Walk(stream, progress)
    deque(walk, maxlen=0)  # to its end
    layout = walk.layout
    if layout is None:
        raise walk.nothing("read")
    return Index(
        layout=layout,
        chunks=walk.chunks,
        samples=layout.samples(walk.messages),
        metadata=walk.metadata,
        complete=walk.complete,
        damaged=walk.damaged,
        reason=walk.reason,
    )


def _crc(stream: BinaryIO, size: int) -> int:
    crc = 0
    stream.seek(0)
    while size:
        block = stream.read(min(size, _BLOCK))
        if not block:
            break
        crc = zlib.crc32(block, crc)
        size -= len(block)
    return crc
