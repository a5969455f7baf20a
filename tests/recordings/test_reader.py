"""The reader: its limits, what it refuses, and what is read and saved of a damaged file."""

import struct
import zlib
from dataclasses import replace
from itertools import chain
from pathlib import Path

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
from tests.recordings import hostile
from tests.recordings.damage import campaign
from tests.recordings.examples import SCENE, record, samples_of, start, two_runs

HEAD = struct.Struct("<BQQQQI8sQ")  # opcode, length, start [ns], end [ns], size, crc, zstd, packed
FOOTER = struct.Struct("<BQQQI8s")  # opcode, length, start of the summary, offsets, crc, magic
INDEX = struct.Struct("<BQQQQ")  # opcode, length, start [ns], end [ns], offset


@pytest.fixture
def path(tmp_path) -> Path:
    return record(tmp_path / "a.mcap", two_runs())


def places_in(path: Path) -> list[reader.Place]:
    with path.open("rb") as stream:
        return reader.read_contents(stream, check=True).places


def is_whole(path: Path) -> bool:
    try:
        with Recording.open(path, check=True) as read:
            return read.complete and None not in [value for _, value in read.entries()]
    except RecordingError:
        return False


def limits(path: Path) -> dict[str, int]:
    """Return the limits that just let this file pass."""
    data = path.read_bytes()
    _, _, start, *_ = FOOTER.unpack(data[-FOOTER.size :])
    heads = [HEAD.unpack_from(data, place.offset) for place in places_in(path)]
    return {
        "MAX_RECORD": max(head[4] for head in heads),
        "MAX_EXPANSION": max(-(-head[4] // (head[1] + 128)) for head in heads),
        "MAX_SUMMARY": len(data) - start,
        "MAX_TIME": max(head[3] for head in heads),
        "MAX_EVENTS": 10,  # that they are, with the stop
    }


LIMITS = ("MAX_RECORD", "MAX_EXPANSION", "MAX_SUMMARY", "MAX_TIME", "MAX_EVENTS")


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_is_met_on_both_sides(path, monkeypatch, name):
    limit = limits(path)[name]
    module = recording if name == "MAX_EVENTS" else reader
    for value, passes in ((limit, True), (limit - 1, False)):
        monkeypatch.setattr(module, name, value)
        assert is_whole(path) == passes


def test_even_a_recording_of_rest_which_zstd_shrinks_most_stays_far_below_the_limits(tmp_path):
    path = tmp_path / "rest.mcap"
    with Recorder(path) as recorder:
        scene = replace(SCENE, theta=0.0, cast=GENERAL[:MAX_METHODS])
        list(simulate(scene, 100.0, recorder, sample_every=1))
    found = limits(path)
    assert found["MAX_EXPANSION"] > 30
    assert all(limit <= getattr(reader, name, 50_000) / 2 for name, limit in found.items())


def test_a_chunk_in_which_time_runs_back_is_lost(tmp_path):
    path = tmp_path / "a.mcap"
    clocks = (0.0, 2.0, 1.0, 3.0)
    marks = (hostile.event(Event("mark", 1, 0, 0.0), clock) for clock in clocks)
    hostile.write(path, chain(hostile.begun(), marks))
    assert not is_whole(path)
    hostile.write(path, hostile.begun())
    assert is_whole(path)


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


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out.mcap"


def ten_seconds(path):
    """Ten samples a second; a chunk every second or so."""
    entries = [Entry(0.0, start())]
    return record(path, [*entries, *(Entry(sample.t, sample) for sample in simulate(SCENE, 10.0))])


def spoil(path, *numbers):
    """Change a byte in each of these chunks."""
    places = places_in(path)
    data = bytearray(path.read_bytes())
    for number in numbers:
        data[places[number].offset + 80] ^= 0xFF
    path.write_bytes(data)
    return path


def samples(path):
    with Recording.open(path) as recording:
        return [value for _, value in samples_of(recording)]


def test_lost_chunks_cost_their_samples_and_the_extremes_of_the_next_one(tmp_path, out):
    path = ten_seconds(tmp_path / "a.mcap")
    whole = samples(path)
    recovery = recover(spoil(path, 3, 6), out)
    kept = samples(out)
    assert recovery["damaged"]
    assert recovery["samples_kept"] == len(kept)
    assert recovery["entries_lost"] == len(whole) - len(kept) > 0
    after_gaps = [sample for sample in kept if sample not in whole]
    assert len(after_gaps) == 2
    assert after_gaps == [without_extremes(sample) for sample in after_gaps]
    assert verify(out).identical


def test_without_its_start_a_run_is_lost(tmp_path, out):
    with pytest.raises(RecordingError, match="are lost"):
        recover(spoil(ten_seconds(tmp_path / "a.mcap"), 0), out)
    assert not out.exists()
    assert [path.name for path in tmp_path.iterdir()] == ["a.mcap"]


def test_damage_costs_what_is_hit_and_never_yields_a_wrong_number():
    done = campaign(cuts=40, flips=40, others=10, holes=10)
    assert done["unnoticed"] == 0
    assert done["chunks_lost"] > 0  # or nothing was tested
