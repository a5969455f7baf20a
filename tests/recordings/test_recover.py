"""Recover: what is intact becomes a complete recording, and losses are counted."""

import pytest

from pendu_tui.recordings.events import Entry
from pendu_tui.recordings.files import RecordingError
from pendu_tui.recordings.format import without_extremes
from pendu_tui.recordings.headless import simulate
from pendu_tui.recordings.reader import read_contents
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover, verify
from tests.recordings.examples import SCENE, record, samples_of, start


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out.mcap"


def ten_seconds(path):
    """Ten samples a second; a chunk every second or so."""
    entries = [Entry(0.0, start())]
    return record(path, [*entries, *(Entry(sample.t, sample) for sample in simulate(SCENE, 10.0))])


def spoil(path, *numbers):
    """Change a byte in each of these chunks."""
    with path.open("rb") as stream:
        places = read_contents(stream, check=True).places
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
