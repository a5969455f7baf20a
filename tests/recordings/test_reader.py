"""The reader: what it refuses of a chunk, a summary or a whole file, and where its limits lie."""

import struct
import zlib
from pathlib import Path

import pytest

from pendu_tui.recordings import reader, recording
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.recording import Recording
from tests.recordings.examples import record, two_runs

HEAD = struct.Struct("<BQQQQI8sQ")  # opcode, length, start [ns], end [ns], size, crc, zstd, packed
FOOTER = struct.Struct("<BQQQI8s")  # opcode, length, start of the summary, offsets, crc, magic
INDEX = struct.Struct("<BQQQQ")  # opcode, length, start [ns], end [ns], offset


@pytest.fixture
def path(tmp_path) -> Path:
    return record(tmp_path / "a.mcap", two_runs())


def heads(data: bytes) -> list[tuple]:
    """Return the heads of the chunks, which begin 37 bytes before the name of their compression."""
    pieces = data.split(b"\x04\x00\x00\x00zstd")[:-1]
    ends = [sum(map(len, pieces[: n + 1])) + 8 * n for n in range(len(pieces))]
    return [HEAD.unpack_from(data, end - 37) for end in ends if data[end - 37] == 6]


def is_whole(path: Path) -> bool:
    try:
        with Recording.open(path, check=True) as read:
            return read.complete and None not in [value for _, value in read.entries()]
    except RecordingError:
        return False


def limits(data: bytes) -> dict[str, int]:
    """Return the limits that just let this file pass."""
    _, _, start, *_ = FOOTER.unpack(data[-FOOTER.size :])
    return {
        "MAX_RECORD": max(head[4] for head in heads(data)),
        "MAX_EXPANSION": max(-(-head[4] // (head[1] + 128)) for head in heads(data)),
        "MAX_SUMMARY": len(data) - start,
        "MAX_TIME": max(head[3] for head in heads(data)),
        "MAX_EVENTS": 10,  # that they are, with the stop
    }


LIMITS = ("MAX_RECORD", "MAX_EXPANSION", "MAX_SUMMARY", "MAX_TIME", "MAX_EVENTS")


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_is_met_on_both_sides(path, monkeypatch, name):
    limit = limits(path.read_bytes())[name]
    module = recording if name == "MAX_EVENTS" else reader
    for value, passes in ((limit, True), (limit - 1, False)):
        monkeypatch.setattr(module, name, value)
        assert is_whole(path) == passes


def test_a_recording_of_the_lab_stays_far_below_the_limits(path):
    data = path.read_bytes()
    assert all(limit <= getattr(reader, name, 50_000) / 2 for name, limit in limits(data).items())


@pytest.mark.parametrize("field", [2, 3], ids=["start", "end"])
@pytest.mark.parametrize("later", [-1, 1])
def test_a_chunk_whose_times_are_not_those_of_its_messages_is_lost(path, field, later):
    data = bytearray(path.read_bytes())
    at = data.index(b"\x04\x00\x00\x00zstd") - 37
    head = list(HEAD.unpack_from(data, at))
    head[field] += later
    HEAD.pack_into(data, at, *head)
    path.write_bytes(data)
    for check in (False, True):
        with Recording.open(path, check) as read:
            assert read.damaged
            assert [run.number for run in read.runs] == [2]  # the first start is in that chunk


@pytest.mark.parametrize(("field", "later"), [(2, -1), (3, 1)], ids=["start", "end"])
def test_a_summary_whose_times_are_not_those_of_a_chunk_is_damage(path, field, later):
    data = bytearray(path.read_bytes())
    footer = list(FOOTER.unpack(data[-FOOTER.size :]))
    at = footer[2]
    while data[at] != 8:  # an index of a chunk
        at += 9 + int.from_bytes(data[at + 1 : at + 9], "little")
    index = list(INDEX.unpack_from(data, at))
    index[field] += later
    INDEX.pack_into(data, at, *index)
    footer[4] = zlib.crc32(data[footer[2] : -12])
    FOOTER.pack_into(data, len(data) - FOOTER.size, *footer)
    path.write_bytes(data)
    with Recording.open(path) as read:
        assert "summary" in read.reason
        assert read.damaged
        assert [run.number for run in read.runs] == [2]  # the first start is in that chunk
