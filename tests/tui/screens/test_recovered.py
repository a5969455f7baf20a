from pathlib import Path

from pendu_tui.recordings.reader import read_contents
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from pendu_tui.tui.screens.launch import recover_leftovers
from tests.tui.harness import Lab


def left_unfinished(path: Path) -> Path:
    """What a killed lab leaves."""
    lab = Lab(record=path)
    lab.run(3.0)
    assert lab.live.recorder is not None
    lab.live.recorder._file.close()
    return path.with_name(path.name + ".part")


def test_a_leftover_becomes_a_complete_recording_and_is_reported(tmp_path):
    assert recover_leftovers(tmp_path / "no such folder") == recover_leftovers(tmp_path) == []
    part = left_unfinished(tmp_path / "one.mcap")
    (said,) = recover_leftovers(tmp_path)
    (whole,) = tmp_path.iterdir()
    assert not part.exists()
    assert str(whole) in said
    assert verify(whole).identical
    with Recording.open(whole) as recording:
        assert recording.length > 2  # at most the last second is lost
    assert recover_leftovers(tmp_path) == []


def test_a_damaged_leftover_is_kept_beside_its_recording(tmp_path):
    part = left_unfinished(tmp_path / "one.mcap")
    data = bytearray(part.read_bytes())
    with part.open("rb") as stream:
        data[read_contents(stream).places[1].offset + 80] ^= 0xFF
    part.write_bytes(data)
    (tmp_path / "empty.mcap.part").touch()
    assert len(recover_leftovers(tmp_path)) == 2
    assert {path.name for path in tmp_path.iterdir()} == {"one.mcap", "one.mcap.part.damaged"}
    assert verify(tmp_path / "one.mcap").identical


def test_what_cannot_be_recovered_is_kept_and_reported_once(tmp_path):
    (tmp_path / "bad.mcap.part").write_bytes(b"nothing of ours")
    left_unfinished(tmp_path / "good.mcap")
    said = recover_leftovers(tmp_path)
    assert len(said) == 2
    (kept,) = [path for path in tmp_path.iterdir() if path.read_bytes() == b"nothing of ours"]
    assert any(str(kept) in sentence for sentence in said)
    assert recover_leftovers(tmp_path) == []


def test_a_recording_in_progress_is_left_alone(tmp_path):
    lab = Lab(record=tmp_path / "one.mcap")
    lab.run(1.0)
    assert recover_leftovers(tmp_path) == []
    lab.live.close()
    assert [path.name for path in tmp_path.iterdir()] == ["one.mcap"]


def test_a_full_disk_does_not_keep_the_lab_from_starting(tmp_path, monkeypatch):
    part = left_unfinished(tmp_path / "one.mcap")

    def full(self):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as elsewhere:
        elsewhere.setattr("mcap.writer.Writer.flush", full)
        (said,) = recover_leftovers(tmp_path)
    assert str(part) in said
    assert "No space left on device" in said
    assert list(tmp_path.iterdir()) == [part]
    assert len(recover_leftovers(tmp_path)) == 1
    assert not part.exists()


def test_leftovers_recovered_by_another_lab_are_skipped(tmp_path, monkeypatch):
    one, two = left_unfinished(tmp_path / "one.mcap"), left_unfinished(tmp_path / "two.mcap")
    monkeypatch.setattr("pendu_tui.recordings.library.leftovers", lambda folder: [one, two])
    one.unlink()
    assert len(recover_leftovers(tmp_path)) == 1
    assert not two.exists()
