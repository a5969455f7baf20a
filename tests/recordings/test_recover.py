"""Recover: what is intact becomes a complete recording, and losses are counted."""

import json
from dataclasses import replace
from itertools import pairwise

import pytest
from mcap.records import Message
from mcap.stream_reader import StreamReader

from engine.run.lockstep import Lockstep, Sample
from engine.run.stepping import Stepping
from recordings.errors import DiskError, RecordingError
from recordings.events import Entry, Event
from recordings.library import leftovers
from recordings.recorder import Recorder
from recordings.recording import Recording
from recordings.recover import recover, rescue
from recordings.verify import verify
from tests.recordings.examples import SCENE, record, start, tiny, two_runs


def chunks(path):
    """Where the chunks begin."""
    data, found, at = path.read_bytes(), [], -1
    with path.open("rb") as stream:
        *_, footer = StreamReader(stream, emit_chunks=True).records
    while (at := data.find(b"\x04\x00\x00\x00zstd", at + 1, footer.summary_start)) >= 0:
        found.append(at - 37)
    return found


def spoil(path, *places):
    """Change a byte in each of these chunks."""
    data = bytearray(path.read_bytes())
    for place in places:
        data[chunks(path)[place] + 60] ^= 0xFF
    path.write_bytes(data)
    return path


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out.mcap"


def ten_seconds(path, changes=(), runs=1):
    """Ten samples a second; a chunk every second or so."""
    with Recorder(path, lambda: 1_700_000_000_000_000_000) as recorder:
        for run in range(1, runs + 1):
            lockstep = Lockstep(SCENE, run)
            zero = (run - 1) * 10.1
            recorder.event(start(run), zero)
            for step in range(101):
                lockstep.advance(step - lockstep.step)
                if step in dict(changes):
                    recorder.event(Event("set_h", run, step, lockstep.t, h=dict(changes)[step]), zero + step / 10)
                    lockstep.set_stepping(Stepping(dict(changes)[step]))
                recorder.sample(lockstep.sample(), zero + step / 10)
    return path


def test_a_whole_recording_is_copied_message_by_message(tmp_path, out):
    path = record(tmp_path / "a.mcap", two_runs(), wall=iter(range(10**9, 10**10)).__next__)
    recovery = recover(path, out)
    assert (recovery.samples_kept, recovery.samples_lost, recovery.chunks_lost, recovery.seconds_lost) == (
        10,
        0,
        0,
        0.0,
    )
    assert recovery.reason is None
    assert not recovery.damaged

    def messages(path):
        with Recording.open(path) as recording, path.open("rb") as stream:
            seals = recording._layout.seals  # a copy has its own
            records = [record for record in StreamReader(stream).records if isinstance(record, Message)]
            found = [message for message in records if message.channel_id != seals]
        return [(message.log_time, message.sequence, message.data) for message in found]

    assert messages(out) == messages(path)
    with Recording.open(path) as was, Recording.open(out) as now:
        assert was.metadata.items() <= now.metadata.items()
        assert now.metadata["recovered"] == "yes"


def test_an_unfinished_recording_is_finished_and_not_called_damaged(tmp_path, out):
    with Recorder(tmp_path / "a.mcap") as recorder:
        for clock, value in two_runs():
            recorder.event(value, clock) if isinstance(value, Event) else recorder.sample(value, clock)
        recorder.flush()
        recovery = recover(recorder.part, out)
    assert recovery.samples_kept == 10
    assert not recovery.damaged
    assert recovery.reason == "the recording was not finished"
    verification = verify(out)
    assert verification.complete
    assert verification.identical


def test_a_lost_chunk_costs_its_samples_and_the_extremes_of_the_next_sample(tmp_path, out):
    path = ten_seconds(tmp_path / "a.mcap")
    with Recording.open(path) as recording:
        whole = [value for _, value in recording.entries() if isinstance(value, Sample)]
    recovery = recover(spoil(path, 3), out)
    assert recovery.chunks_lost == 1
    assert recovery.damaged
    with Recording.open(out) as recording:
        kept = [value for _, value in recording.entries() if isinstance(value, Sample)]
    assert (recovery.samples_kept, recovery.samples_lost) == (len(kept), len(whole) - len(kept))
    assert recovery.samples_lost > 0
    widest = max(later.t - earlier.t for earlier, later in pairwise(kept))
    assert recovery.seconds_lost == pytest.approx(widest)  # from the last sample before to the first after
    changed = [now for now in kept if now not in whole]
    assert len(changed) == 1
    (first_after,) = changed
    assert all(reading.energy_error_low == reading.energy_error for reading in first_after.readings)
    assert verify(out).identical


def test_losses_are_counted_without_a_summary_too(tmp_path, out):
    path = spoil(ten_seconds(tmp_path / "a.mcap"), 3, 6)
    end = chunks(path)[-3]
    path.write_bytes(path.read_bytes()[: end + 100])
    recovery = recover(path, out)
    assert recovery.chunks_lost == 3  # two changed, one cut
    assert recovery.samples_lost > 0
    with Recording.open(out) as recording:  # those of the cut one cannot be known
        last = recording.sample(recording.at(99.0)).value.step
        assert recovery.samples_kept + recovery.samples_lost == last + 1
    assert 0.1 * recovery.samples_lost < recovery.seconds_lost < 0.1 * recovery.samples_lost + 1.5  # ten a second
    assert verify(out).identical


def test_a_run_that_lost_its_start_is_dropped_and_counted(tmp_path, out):
    path = ten_seconds(tmp_path / "a.mcap", runs=2)
    second = next(place for place in range(20) if starts_in(path, place) == [2])
    recovery = recover(spoil(path, second), out)
    assert recovery.runs_lost == 1
    with Recording.open(out) as recording:
        assert [run.number for run in recording.runs] == [1]
        assert recovery.samples_kept == recording.samples
    assert recovery.samples_kept + recovery.samples_lost == 202
    assert recovery.seconds_lost == pytest.approx(20.1 - 10.0, abs=1.0)
    assert verify(out).identical


def starts_in(path, place):
    """The runs that start in a chunk."""
    with Recording.open(path) as recording:
        entries = recording._decoded(place).entries
    return [value.run for _, value in entries if isinstance(value, Event) and value.kind == "start"]


def test_a_run_that_lost_a_change_of_h_keeps_its_samples_and_is_listed(tmp_path, out):
    path = ten_seconds(tmp_path / "a.mcap", changes=[(55, 0.05)])
    with Recording.open(path) as recording:
        place = recording.at(5.4).chunk  # the event was flushed with what was before it
    recovery = recover(spoil(path, place), out)
    assert recovery.runs_broken == (1,)
    assert recovery.samples_kept > 80
    assert not verify(out).identical  # nothing is called identical that cannot be simulated again


def test_the_file_to_be_recovered_is_never_overwritten(tmp_path):
    path = record(tmp_path / "a.mcap", two_runs())
    data = path.read_bytes()
    for out in (path, tmp_path / "x" / ".." / "a.mcap"):
        (tmp_path / "x").mkdir(exist_ok=True)
        with pytest.raises(DiskError, match="is the recording to recover"):
            recover(path, out, overwrite=True)
    assert path.read_bytes() == data


def test_an_existing_file_is_overwritten_only_on_request(tmp_path, out):
    path = record(tmp_path / "a.mcap", two_runs())
    out.write_text("precious")
    with pytest.raises(DiskError, match="exists already"):
        recover(path, out)
    assert out.read_text() == "precious"
    recover(path, out, overwrite=True)
    assert verify(out).complete


def test_a_recovery_that_saves_nothing_leaves_nothing_behind(tmp_path, out):
    path = spoil(ten_seconds(tmp_path / "a.mcap"), 0)
    with pytest.raises(RecordingError, match=r"a\.mcap: nothing in it can be saved: a chunk"):
        recover(path, out)
    assert [file.name for file in tmp_path.iterdir()] == ["a.mcap"]


def test_an_interrupted_recovery_leaves_nothing_behind(tmp_path, out):
    path = ten_seconds(tmp_path / "a.mcap")

    def interrupt(done, size):
        if done > size / 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        recover(path, out, interrupt)
    assert [file.name for file in tmp_path.iterdir()] == ["a.mcap"]


def test_the_fingerprint_of_sin_is_the_recordings_not_this_machines(tmp_path, out, monkeypatch):
    with monkeypatch.context() as elsewhere:
        elsewhere.setattr("recordings.summary.fingerprints", lambda: {"sin": "another"})
        path = record(tmp_path / "a.mcap", two_runs())
    recover(path, out)
    assert not verify(out).same_sin


def test_steps_out_of_order_are_refused(tmp_path, out, monkeypatch):
    entries = two_runs()[:4]
    monkeypatch.setattr("recordings.recorder.encode_readings", lambda sample: backwards(sample))
    path = record(tmp_path / "a.mcap", entries)
    monkeypatch.undo()
    with pytest.raises(RecordingError, match="the steps of run 1 are not in order"):
        recover(path, out)


def backwards(sample):
    """Its messages, with steps that descend."""
    from recordings.format import encode_readings

    messages = (json.loads(data) for data in encode_readings(sample))
    return [json.dumps(fields | {"step": 100 - fields["step"]}).encode() for fields in messages]


def test_marks_without_samples_are_recovered(tmp_path, out):
    entries = [*two_runs()[:2], *(Entry(0.0, Event("mark", 1, 0, 0.0, text=f"{i}")) for i in range(5))]
    path = record(tmp_path / "a.mcap", entries)
    recover(path, out)
    with Recording.open(out) as recording:
        assert [event.text for _, event in recording.events if event.kind == "mark"] == list("01234")


def test_a_leftover_can_be_recovered_under_its_own_name(tmp_path):
    whole = record(tmp_path / "a.mcap", two_runs())
    part = whole.rename(tmp_path / "a.mcap.part")
    data = part.read_bytes()
    recovery = recover(part, whole)
    assert recovery.out == whole
    assert verify(whole).complete
    assert {path.name for path in tmp_path.iterdir()} == {"a.mcap", "a.mcap.part"}
    assert part.read_bytes() == data
    with pytest.raises(DiskError, match="exists already"):
        recover(part, whole)
    assert recover(part, whole, overwrite=True).samples_kept == 10
    assert {path.name for path in tmp_path.iterdir()} == {"a.mcap", "a.mcap.part"}


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


def test_a_leftover_becomes_a_recording_under_its_own_name(tmp_path):
    left_behind(tmp_path / "a.mcap")
    (done,) = map(rescue, leftovers(tmp_path))
    assert done.saved == tmp_path / "a.mcap"
    assert done.kept is None
    assert done.recovery.samples_kept == 4
    assert [path.name for path in tmp_path.iterdir()] == ["a.mcap"]
    verification = verify(done.saved)
    assert verification.complete
    assert verification.identical


def test_a_recording_of_the_same_name_is_not_overwritten(tmp_path):
    other = tiny(tmp_path / "b.mcap").rename(tmp_path / "a.mcap")
    data = other.read_bytes()
    part = left_behind(tmp_path / "c.mcap").rename(tmp_path / "a.mcap.part")
    done = rescue(part)
    assert done.saved == tmp_path / "a-2.mcap"
    assert other.read_bytes() == data


def test_a_damaged_leftover_is_kept_next_to_its_recovery(tmp_path):
    part = left_behind(tmp_path / "a.mcap", spoil=True)
    data = part.read_bytes()
    done = rescue(part)
    assert done.recovery.damaged
    assert done.kept == tmp_path / "a.mcap.part.damaged"
    assert done.kept.read_bytes() == data
    assert verify(done.saved).identical
    assert leftovers(tmp_path) == []


def test_an_unreadable_leftover_is_kept_and_reported_once(tmp_path):
    (tmp_path / "a.mcap.part").write_bytes(b"\x89MCAP0\r\n" + bytes(50))
    (done,) = map(rescue, leftovers(tmp_path))
    assert done.saved is None
    assert "nothing in it can be saved" in done.reason
    assert done.kept.read_bytes() == b"\x89MCAP0\r\n" + bytes(50)
    assert leftovers(tmp_path) == []


def test_an_empty_leftover_is_removed_and_reported(tmp_path):
    (tmp_path / "a.mcap.part").touch()
    (done,) = map(rescue, leftovers(tmp_path))
    assert "the file is empty" in done.reason
    assert not list(tmp_path.iterdir())


def test_a_leftover_is_not_lost_if_the_disk_is_full(tmp_path, monkeypatch):
    part = left_behind(tmp_path / "a.mcap")

    def full(self):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as elsewhere:
        elsewhere.setattr("mcap.writer.Writer.flush", full)
        with pytest.raises(OSError, match="No space left"):
            rescue(part)
    assert [path.name for path in tmp_path.iterdir()] == ["a.mcap.part"]


@pytest.mark.parametrize("lost", [0, 1])
def test_runs_after_a_lost_start_are_saved_though_the_lost_one_had_their_methods_first(tmp_path, out, lost):
    scenes = [
        SCENE,
        replace(SCENE, cast=SCENE.cast[:2], model="linear"),
        replace(SCENE, cast=SCENE.cast[1::-1], model="linear"),
    ]
    begins = []
    with Recorder(tmp_path / "a.mcap") as recorder:
        for run, scene in enumerate(scenes, 1):
            recorder.flush()
            begins.append(recorder.bytes)
            recorder.event(start(run, scene), 10.0 * run)
            lockstep = Lockstep(scene, run)
            for step in range(30):
                recorder.sample(lockstep.sample(), 10.0 * run + step / 10)
                lockstep.advance(1)
        recorder.flush()
        data = bytearray(recorder.part.read_bytes())
    at = data.index(b"\x04\x00\x00\x00zstd", begins[lost])
    data[at + 60] ^= 0xFF
    (tmp_path / "cut.mcap").write_bytes(data)
    recovery = recover(tmp_path / "cut.mcap", out)
    assert (recovery.samples_kept, recovery.samples_lost) == (60, 30)
    with Recording.open(out) as recording:
        assert [run.number for run in recording.runs] == ([2, 3] if lost == 0 else [1, 3])
    assert verify(out).identical
