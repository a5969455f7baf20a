"""The reader: its limits, and what is read and saved of a damaged file."""

import os
import random
import struct
import zlib
from contextlib import suppress
from dataclasses import replace
from unittest.mock import Mock

import pytest

from pendu_tui.engine.methods import GENERAL
from pendu_tui.engine.scenes import MAX_METHODS
from pendu_tui.recordings import reader, recording
from pendu_tui.recordings.events import Entry, Event, simulate
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.format import without_extremes
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover, verify
from tests.recordings.examples import SCENE, false_head, record, samples_of, start, two_runs

FOOTER = reader._FOOTER
INDEX = struct.Struct("<BQQQQ")  # opcode, length, start [ns], end [ns], offset
CHANCE = random.Random(1)


@pytest.fixture
def path(tmp_path):
    return record(tmp_path / "a.mcap", two_runs())


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out.mcap"


def places_in(path):
    with path.open("rb") as stream:
        return reader.read_contents(stream, check=True).places


def is_whole(path):
    try:
        with Recording.open(path, check=True) as read:
            return read.complete and None not in [value for _, value in read.entries()]
    except RecordingError:
        return False


def limits(path):
    """Return the limits that just let this file pass."""
    data = path.read_bytes()
    heads = [reader._CHUNK.unpack_from(data, place.offset) for place in places_in(path)]
    return {
        "MAX_RECORD": max(head[4] for head in heads),
        "MAX_EXPANSION": max(-(-head[4] // (head[1] + 128)) for head in heads),
        "MAX_SUMMARY": len(data) - FOOTER.unpack(data[-FOOTER.size :])[2],
        "MAX_TIME": max(head[3] for head in heads),
        "MAX_EVENTS": 10,  # that they are, with the stop
    }


def test_each_limit_is_met_on_both_sides(path, monkeypatch):
    for name, limit in limits(path).items():
        module = recording if name == "MAX_EVENTS" else reader
        for more, passes in ((-1, False), (0, True)):
            monkeypatch.setattr(module, name, limit + more)
            assert is_whole(path) == passes, name


@pytest.mark.parametrize(
    ("right", "wrong"),
    [((1 << 22) - 44, (1 << 22) - 43), (31_078, 31_077)],  # 4 MB at once, 4 MB of a 128th
)
def test_a_chunk_that_claims_more_bytes_than_recorders_write_is_none(right, wrong):
    assert reader._sizes_in(false_head(right))
    with pytest.raises(ValueError, match=r"^$"):
        reader._sizes_in(false_head(wrong))
    for at in (0, 1, 25, 37):  # opcode, length, size of its contents, compression
        head = bytearray(false_head(right))
        head[at] ^= 1
        with pytest.raises(ValueError, match=r"^$"):
            reader._sizes_in(bytes(head))
    with pytest.raises(ValueError, match="messages"):
        reader._records(b"")


@pytest.mark.parametrize(
    ("at", "cut", "reason"),
    [
        (-1, None, "its checksum is wrong"),
        (0, None, "its first bytes are not those of an MCAP file"),
        (0, -20, "its first bytes are not those of an MCAP file"),
    ],
)
def test_a_change_outside_of_chunks_is_damage_where_all_is_checked(path, at, cut, reason):
    data = bytearray(path.read_bytes()[:cut])
    data[at and places_in(path)[1].offset + at] ^= 1
    path.write_bytes(data)
    with Recording.open(path) as unchecked, Recording.open(path, check=True) as checked:
        assert unchecked.complete == (cut is None)
        assert (checked.damaged, checked.reason) == (True, reason)
        assert checked.samples == unchecked.samples
    assert not verify(path).identical


def test_without_its_last_bytes_or_a_checksum_a_file_counts_as_unfinished(path, out):
    whole = path.read_bytes()
    summary = FOOTER.unpack(whole[-FOOTER.size :])[2]
    for begin, end in ((summary - 4, summary), (len(whole) - 1, len(whole))):
        path.write_bytes(whole[:begin] + bytes(end - begin) + whole[end:])
        with Recording.open(path, check=True) as read:
            assert (read.damaged, read.reason) == (False, "its end is missing or damaged")
    out.touch()
    assert not recover(path, out, overwrite=True)["damaged"]


def test_a_chunk_that_is_there_twice_is_damage_and_no_loss(path):
    data = path.read_bytes()
    begin, end = (place.offset for place in places_in(path)[1:3])
    path.write_bytes(data[:end] + data[begin:end])
    with Recording.open(path) as read:
        assert (read.damaged, read.entries_lost) == (True, 0)
        assert None in [value for _, value in read.entries()]
        assert read.reason == "its entries are out of order"


def test_even_a_recording_of_rest_which_zstd_shrinks_most_stays_far_below_the_limits(out):
    with Recorder(out) as recorder:
        scene = replace(SCENE, theta=0.0, cast=GENERAL[:MAX_METHODS])
        list(simulate(scene, 50.0, recorder.add, sample_every=1))
    found = limits(out)
    assert found["MAX_EXPANSION"] > 30
    assert all(limit <= getattr(reader, name, 50_000) / 2 for name, limit in found.items())


def test_a_chunk_in_which_time_runs_back_or_lasts_for_centuries_is_lost(out):
    for clocks, passes in (
        ((2.0,), True),
        ((3.0, 2.0, 3.0), False),
        ((9e9,), True),
        ((1e10,), False),
    ):
        marks = [(clock, Event("mark", 1, 0, 0.0)) for clock in (2.0, *clocks)]
        with Recorder(out, overwrite=True) as recorder:
            for clock, value in (*two_runs()[:2], *marks):
                recorder.add(value, clock)
        assert is_whole(out) == passes


def change_index(path, number, field, more):
    """Add to a field of a chunk's index in the summary, which keeps a right checksum."""
    data = bytearray(path.read_bytes())
    footer = list(FOOTER.unpack(data[-FOOTER.size :]))
    places = []
    at = footer[2]
    while at < len(data) - FOOTER.size:
        if data[at] == 8:  # an index of a chunk
            places.append(at)
        at += 9 + int.from_bytes(data[at + 1 : at + 9], "little")
    index = list(INDEX.unpack_from(data, places[number]))
    index[field] += more
    INDEX.pack_into(data, places[number], *index)
    footer[4] = zlib.crc32(data[footer[2] : -12])
    FOOTER.pack_into(data, len(data) - FOOTER.size, *footer)
    path.write_bytes(data)


@pytest.mark.parametrize(("field", "later"), [(2, -1), (3, 1)])
def test_a_summary_whose_times_are_not_those_of_a_chunk_is_damage(path, field, later):
    change_index(path, 0, field, later)
    with Recording.open(path) as read:
        assert "summary" in read.reason
        assert read.damaged
        assert [run.number for run in read.runs] == [2]  # the first start is in that chunk
        list(read.entries())
        assert read.lost_runs == {1}


def test_a_summary_whose_chunks_overlap_is_not_used(path):
    path.unlink()
    offsets = [place.offset for place in places_in(ten_seconds(path))]
    change_index(path, 1, 4, offsets[0] - offsets[1])
    assert [place.offset for place in places_in(path)] == offsets


def ten_seconds(path):
    """Ten samples a second; a chunk every second or so."""
    entries = [Entry(0.0, start())]
    return record(path, [*entries, *(Entry(sample.t, sample) for sample in simulate(SCENE, 10.0))])


def spoil(path, *numbers):
    """Change a byte in each of these chunks."""
    data = bytearray(path.read_bytes())
    for number in numbers:
        data[places_in(path)[number].offset + 80] ^= 0xFF
    path.write_bytes(data)
    return path


def values(path):
    with Recording.open(path) as recording:
        return [value for _, value in samples_of(recording)]


def test_lost_chunks_cost_their_samples_and_the_extremes_of_the_next_one(path, out):
    path.unlink()
    whole = values(ten_seconds(path))
    recovery = recover(spoil(path, 3, 6), out)
    verified = verify(path)  # up to the first loss
    assert (verified.identical, verified.first_difference) == (False, None)
    kept = values(out)
    lost = len(whole) - len(kept)
    assert recovery == {
        "file": str(path),
        "out": str(out),
        "damaged": True,
        "reason": f"{lost // 2} entries are lost",  # the first of two equal chunks
        "samples_kept": len(kept),
        "entries_lost": lost,
        "runs_lost": 0,
    }
    after_gaps = [sample for sample in kept if sample not in whole]
    assert len(after_gaps) == 2
    assert after_gaps == [without_extremes(sample) for sample in after_gaps]
    assert verify(out).identical


def test_without_its_first_chunk_a_later_run_is_recovered_and_else_no_file_is_left(
    path, out, monkeypatch
):
    assert recover(spoil(path, 0), out)["runs_lost"] == 1
    with Recording.open(out) as read:
        assert [run.number for run in read.runs] == [2]
    out.unlink()
    with monkeypatch.context() as interrupted:
        interrupted.setattr(Recorder, "close", Mock(side_effect=KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            recover(path, out)
    assert [*out.parent.iterdir()] == [path]
    path.unlink()
    with pytest.raises(RecordingError, match="are lost"):
        recover(spoil(ten_seconds(path), 0), out)
    assert [*out.parent.iterdir()] == [path]


class Whole:
    """A recording, and what may be read of its damaged copies."""

    def __init__(self, path):
        self.path = path
        self.data = path.read_bytes()
        with Recording.open(path) as recording:
            self.entries = list(recording.entries())
            self.scenes = [run.scene for run in recording.runs]

    def check(self, data):
        """Check that nothing else is read of these bytes, and that each reader says what lacks."""
        self.path.write_bytes(data)
        for check in (False, True):
            with suppress(RecordingError), Recording.open(self.path, check) as recording:
                read = list(recording.entries())
                assert [entry for entry in read if entry.value] == [
                    entry for entry in self.entries if entry in read
                ]
                scenes = [run.scene for run in recording.runs]
                assert recording.reason or (read, scenes) == (self.entries, self.scenes)
        with suppress(RecordingError):
            result = verify(self.path)
            assert result.complete == (result.reason is None)
            assert result.first_difference is None


@pytest.fixture
def whole(path, monkeypatch):
    monkeypatch.setattr(os, "fsync", lambda _: None)
    return Whole(path)


def test_a_file_cut_anywhere_reads_as_far_as_it_goes(whole):
    for length in range(CHANCE.randrange(100), len(whole.data), 100):
        whole.check(whole.data[:length])


@pytest.mark.parametrize("cut", [0, 1_500])
def test_a_flipped_bit_is_noticed_and_never_a_wrong_number(whole, cut):
    for _ in range(60):
        data = bytearray(whole.data[: len(whole.data) - cut])
        data[CHANCE.randrange(len(data))] ^= 1 << CHANCE.randrange(8)
        whole.check(data)
