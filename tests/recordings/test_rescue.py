"""Rescue: what a killed lab has left becomes a recording, and nothing disappears unsaid."""

import pytest

from recordings.events import Event
from recordings.library import leftovers
from recordings.recorder import Recorder
from recordings.recover import rescue
from recordings.verify import verify
from tests.recordings.sittings import start, tiny, two_runs


def left_behind(path, spoil=False):
    """What a lab leaves that is killed while it records."""
    recorder = Recorder(path)
    for clock, value in two_runs()[:5]:
        recorder.event(value, clock) if isinstance(value, Event) else recorder.sample(value, clock)
    recorder.flush()
    middle = recorder.bytes - 200
    recorder.abandon()
    if spoil:
        data = bytearray(recorder.part.read_bytes())
        data[middle] ^= 0xFF
        recorder.part.write_bytes(data)
    return recorder.part


def test_a_leftover_becomes_the_recording_it_was_to_be(tmp_path):
    part = left_behind(tmp_path / "a.mcap")
    (done,) = map(rescue, leftovers(tmp_path))
    assert done.leftover == part
    assert done.saved == tmp_path / "a.mcap"
    assert done.kept is None
    assert done.recovery.samples_kept == 4
    assert [path.name for path in tmp_path.iterdir()] == ["a.mcap"]
    verification = verify(done.saved)
    assert verification.complete
    assert verification.identical


def test_a_name_that_was_taken_meanwhile_is_not_overwritten(tmp_path):
    other = tiny(tmp_path / "b.mcap").rename(tmp_path / "a.mcap")
    data = other.read_bytes()
    part = left_behind(tmp_path / "c.mcap").rename(tmp_path / "a.mcap.part")
    done = rescue(part)
    assert done.saved == tmp_path / "a-2.mcap"
    assert other.read_bytes() == data


def test_a_damaged_leftover_is_kept_beside_what_was_saved_of_it(tmp_path):
    part = left_behind(tmp_path / "a.mcap", spoil=True)
    data = part.read_bytes()
    done = rescue(part)
    assert done.recovery.damaged
    assert done.kept == tmp_path / "a.mcap.part.damaged"
    assert done.kept.read_bytes() == data
    assert verify(done.saved).identical
    assert leftovers(tmp_path) == []


def test_a_leftover_of_which_nothing_can_be_saved_is_kept_and_told_of_once(tmp_path):
    (tmp_path / "a.mcap.part").write_bytes(b"\x89MCAP0\r\n" + bytes(50))
    (done,) = map(rescue, leftovers(tmp_path))
    assert done.saved is None
    assert "nothing in it can be saved" in done.reason
    assert done.kept.read_bytes() == b"\x89MCAP0\r\n" + bytes(50)
    assert leftovers(tmp_path) == []


def test_an_empty_leftover_is_removed_and_told_of(tmp_path):
    (tmp_path / "a.mcap.part").touch()
    (done,) = map(rescue, leftovers(tmp_path))
    assert "the file is empty" in done.reason
    assert not list(tmp_path.iterdir())


def test_a_lab_that_is_running_is_left_alone(tmp_path):
    with Recorder(tmp_path / "a.mcap") as recorder:
        recorder.event(start(), 0.0)
        recorder.sample(two_runs()[1].value, 0.0)
        assert leftovers(tmp_path) == []
    assert verify(tmp_path / "a.mcap").complete


def test_what_is_left_is_not_lost_when_the_disk_is_full(tmp_path, monkeypatch):
    part = left_behind(tmp_path / "a.mcap")

    def full(self):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as elsewhere:
        elsewhere.setattr("mcap.writer.Writer.flush", full)
        with pytest.raises(OSError, match="No space left"):
            rescue(part)
    assert [path.name for path in tmp_path.iterdir()] == ["a.mcap.part"]
