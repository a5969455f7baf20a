"""The recorder: valid files, written in time; the lab goes on if the disk fails."""

import json
import math
import os
import random
import re
import threading
import time
from contextlib import suppress
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace

import jsonschema
import pytest
from mcap.reader import make_reader
from mcap.records import Chunk, DataEnd, Footer
from mcap.stream_reader import StreamReader

from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.events import Event, simulate, steps_for
from pendu_tui.recordings.files import DiskError, in_use, publish
from pendu_tui.recordings.format import EVENTS
from pendu_tui.recordings.recorder import LiveRecorder, Recorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import recover, verify
from tests.recordings.examples import SCENE, record, start, two_runs


def stepped(steps):
    lockstep = Lockstep(SCENE)
    lockstep.advance(steps)
    return lockstep.sample()


def begin(recorder):
    recorder.add(start(), 0.0)
    recorder.add(stepped(0), 0.0)
    return recorder


def last_on_disk(recorder):
    """What a reader finds last if the process dies here."""
    with Recording.open(recorder.part) as recording:
        *_, last = recording.entries()
    return last.value


def test_a_recording_is_valid_to_mcaps_readers_which_find_a_time_through_the_index(tmp_path):
    path = record(tmp_path / "a.mcap", two_runs())

    def read(kind, **options):
        with path.open("rb") as file:
            records = list(StreamReader(file, **options).records)
        return [record for record in records if isinstance(record, kind)]

    chunks = read(Chunk, emit_chunks=True)
    (end,), (footer,) = map(read, (DataEnd, Footer))
    assert end.data_section_crc
    assert footer.summary_crc
    assert all(chunk.uncompressed_crc and chunk.compression == "zstd" for chunk in chunks)
    assert len(chunks) > 3
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        header = reader.get_header()
        assert (header.profile, header.library) == ("pendu", f"pendu-tui {version('pendu-tui')}")
        for schema, channel, message in reader.iter_messages():
            assert schema.encoding == "jsonschema"
            assert message.publish_time == message.log_time  # the same whenever it is made
            assert schema.name == ("pendu.Event" if channel.topic == EVENTS else "pendu.Sample")
            jsonschema.validate(json.loads(message.data), json.loads(schema.data))
        window = {"starting_at": 2_500_000_000, "ending_before": 3_500_000_000}
        found = list(reader.iter_messages("/pendu/rk4", **window))
    assert [json.loads(message.data)["step"] for *_, message in found] == [9, 12]  # 1.5 and 2.0 s


def test_invalid_input_is_refused_before_it_spoils_a_chunk_and_no_sample_is_written_twice(
    tmp_path, monkeypatch
):
    recorder = begin(Recorder(tmp_path / "live.mcap"))
    assert last_on_disk(recorder).step == 0  # the start at once
    with pytest.raises(ValueError, match="NaN"):
        recorder.add(stepped(1), float("nan"))
    with pytest.raises(ValueError, match="inf"):
        recorder.add(Event("mark", 1, 0, float("inf")), 0.0)
    for step in (5, 4, 5):
        recorder.add(stepped(step), 0.5)
    before = []
    monkeypatch.setattr(os, "fsync", lambda _: before.append(recorder.part.stat().st_size))

    def renamed(*each):
        before.append(in_use(recorder.part))
        publish(*each)

    monkeypatch.setattr("pendu_tui.recordings.recorder.publish", renamed)
    for _ in range(2):
        recorder.close()
    assert before == [recorder.path.stat().st_size, False]  # on disk and closed
    with Recording.open(recorder.path, check=True) as recording:
        assert recording.complete
        assert [clock for clock, _ in recording.entries()] == [0.0, 0.0, 0.5, 0.5]
    assert verify(recorder.path).samples == 2


def test_a_mark_in_a_pause_is_read_of_a_lab_that_was_killed(tmp_path):
    recorder = begin(Recorder(tmp_path / "a.mcap"))
    recorder.add(Event("mark", 1, 0, 0.0), 0.5)
    recorder.flush()  # a chunk without samples
    with Recording.open(recorder.part) as recording:
        assert [event.kind for _, event in recording.events] == ["start", "mark"]
    recorder.abandon()


@pytest.mark.parametrize("kind", [Recorder, LiveRecorder])
def test_a_recording_without_a_start_leaves_no_file(tmp_path, monkeypatch, kind):
    monkeypatch.setattr("pendu_tui.recordings.recorder.FLUSH_EVERY", 0.01)
    with kind(tmp_path / "a.mcap") as recorder:
        assert recorder.part.exists()
        time.sleep(0.03)  # longer than between two flushes
    assert not list(tmp_path.iterdir())
    recorder = Recorder(tmp_path / "a.mcap")
    recorder.add(start(), 0.0)
    recorder.abandon()  # before anything reached the disk
    assert not list(tmp_path.iterdir())


def test_a_live_recorder_has_every_sample_on_disk_after_half_a_second_without_a_frame(tmp_path):
    threads = {*threading.enumerate()}
    recorder = begin(LiveRecorder(tmp_path / "live.mcap"))
    (flusher,) = {*threading.enumerate()} - threads
    assert flusher.daemon  # a lab that crashes can end
    recorder.add(stepped(2), 0.1)
    deadline = time.monotonic() + 1.0  # s; no more is lost
    while last_on_disk(recorder).step < 2:
        assert time.monotonic() < deadline
        time.sleep(0.05)
    recorder.close()
    recorder.add(stepped(3), 0.2)  # as a frame does that is still due
    with recorder.path.open("rb") as file:
        _, _, message = next(make_reader(file).iter_messages())
    assert 0 <= time.time_ns() - message.publish_time < 10e9  # by the clock on the wall


def test_a_recording_closed_while_another_thread_writes_is_whole(tmp_path):
    samples = list(simulate(SCENE, 20.0))

    def flood(recorder):
        for run in range(1, 40):
            recorder.add(start(run), run)
            for sample in samples[: 5 * run]:
                recorder.add(sample._replace(run=run), run)

    for number in range(10):
        recorder = LiveRecorder(tmp_path / f"{number}.mcap")
        writer = threading.Thread(target=flood, args=(recorder,))
        writer.start()
        time.sleep(random.uniform(0.0, 0.03))
        recorder.close()
        writer.join()
        assert recorder.failed is None
        if recorder.samples:
            verification = verify(recorder.path)
            assert (verification.complete, verification.identical) == (True, True)


def test_a_writer_that_waits_for_the_disk_does_not_hang_the_close(tmp_path):
    recorder = begin(LiveRecorder(tmp_path / "live\u202e.mcap"))
    lock = recorder._lock
    recorder._lock = SimpleNamespace(acquire=lambda timeout: timeout != 2.0)  # s
    recorder.close()
    assert recorder.failed.endswith("live\ufffd.mcap.part: the disk does not respond")
    recorder._lock = lock
    recorder.add(stepped(2), 0.1)
    assert recorder.samples == 1  # it has ended
    recorder.abandon()


def test_a_recording_is_overwritten_only_on_request_and_by_a_finished_one(tmp_path):
    path = record(tmp_path / "a.mcap", two_runs())
    before = path.read_bytes()
    with pytest.raises(DiskError, match="already exists"):
        Recorder(path)
    with suppress(KeyboardInterrupt), Recorder(path, overwrite=True) as recorder:
        begin(recorder)
        raise KeyboardInterrupt
    assert recorder.path == tmp_path / "a-2.mcap"
    assert verify(recorder.path).complete
    recorder = begin(Recorder(path, overwrite=True))
    with pytest.raises(DiskError, match=r"\.part: is in use"):
        Recorder(path, overwrite=True)
    recorder.keep_older()
    recorder.path.write_text("precious")
    with pytest.raises(DiskError, match=rf"{re.escape(str(recorder.path))}: .* appeared"):
        recorder.close()
    assert recorder.path.read_text() == "precious"
    assert verify(recorder.part).complete
    recorder.part.unlink()
    with suppress(DiskError), Recorder(path, overwrite=True) as recorder:
        begin(recorder)
        raise DiskError("is full", path)
    assert not in_use(recorder.part)
    recorder.part.unlink()
    with Recorder(path, overwrite=True) as recorder:
        begin(recorder)
        assert path.read_bytes() == before
    assert path.read_bytes() != before
    with pytest.raises(DiskError, match=f"^{os.devnull}: is a device"):
        Recorder(Path(os.devnull), overwrite=True)


def test_a_recording_ends_whole_before_it_has_more_events_than_may_be_read(tmp_path, monkeypatch):
    for module in ("recorder", "recording"):
        monkeypatch.setattr(f"pendu_tui.recordings.{module}.MAX_EVENTS", 30)
    recorder = LiveRecorder(tmp_path / "lab.mcap")
    for sample in simulate(SCENE, 4.0, recorder.add):
        recorder.add(Event("mark", 1, sample.step, sample.t), sample.t)
    assert f"{recorder.path}: is full" in recorder.failed
    with Recording.open(recorder.path, check=True) as recording:
        assert recording.complete
        assert len(recording.events) == 30


def test_a_real_file_size_limit_is_survived(tmp_path):
    resource = pytest.importorskip("resource", reason="no limit of the size of files")
    usual = resource.getrlimit(resource.RLIMIT_FSIZE)
    recorder = LiveRecorder(tmp_path / "lab.mcap")
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, usual[1]))
    try:
        assert len(list(simulate(SCENE, 20.0, recorder.add))) == 201
        recorder.close()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, usual)
    assert "File too large" in recorder.failed
    assert not in_use(recorder.part)  # another may have it
    assert [*tmp_path.iterdir()] == [recorder.part]
    assert verify(recorder.part).identical


@pytest.mark.parametrize(
    ("h", "time", "every", "steps"),
    [
        (0.1, 2.0, 6, [0, 6, 12, 18, 20]),
        (0.1, 0.3, None, [0, 1, 2, 3]),
        (0.1, 0.0, None, [0]),
        (0.004, 0.1, None, [0, 8, 16, 24, 25]),  # 1/30 s are 8.3 steps
    ],
)
def test_samples_have_their_cadence_and_include_the_first_and_the_last(h, time, every, steps):
    scene = replace(SCENE, h=h)
    assert [sample.step for sample in simulate(scene, time, sample_every=every)] == steps
    assert steps_for(scene, time) == steps[-1]


def test_each_milestone_is_recorded_once_at_the_next_sample():
    entries, scene = [], SCENES["drift"]
    list(simulate(scene, 40.0, lambda *entry: entries.append(entry), sample_every=7))
    lockstep = Lockstep(scene, judged=True)
    lockstep.advance(800)
    noticed = [(value, t) for value, t in entries if getattr(value, "milestone", None)]
    assert all(event[2:4] == event.milestone[2:4] for event, _ in noticed)  # step and time
    recorded = [(event.milestone, t) for event, t in noticed]
    at = [min(math.ceil(each.step / 7) * 7, 800) * scene.h for each in lockstep.milestones]
    assert recorded == list(zip(lockstep.milestones, at, strict=True)) != []


def test_a_long_headless_run_has_few_chunks(tmp_path):
    path, copy = tmp_path / "a.mcap", tmp_path / "copy.mcap"
    with Recorder(path) as recorder:
        samples = sum(1 for _ in simulate(SCENE, 100.0, recorder.add, sample_every=1))
    recover(path, copy)
    for each in (path, copy):
        with Recording.open(each) as recording:
            assert recording.samples == samples == 1001
    heads = path.read_bytes().count(b"\x04\x00\x00\x00zstd")  # in chunks and their index
    assert 12 < heads < 25
