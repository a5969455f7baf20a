"""The lab goes on if the disk fails, and so does its recording."""

import errno
import os
import subprocess
import sys

import pytest

from engine.run.lockstep import Lockstep
from engine.run.stepping import Stepping
from recordings.errors import DiskError
from recordings.events import Event
from recordings.library import free_path
from recordings.live_recorder import RETRY_EVERY, LiveRecorder
from recordings.recording import Recording
from recordings.verification import verify
from tests.recordings.examples import SCENE, start


class Lab:
    """A lab that runs at 10 samples a second, and its recorder."""

    def __init__(self, path):
        self.recorder = LiveRecorder(path)
        self.lockstep = Lockstep(SCENE)
        self.clock = 0.0
        self.recorder.event(start(), 0.0)
        self.recorder.sample(self.lockstep.sample(), 0.0)

    def run(self, seconds):
        for _ in range(round(seconds * 10)):
            self.clock += 0.1
            self.lockstep.advance(1)
            self.recorder.sample(self.lockstep.sample(), self.clock)

    def set_h(self, h):
        self.lockstep.set_stepping(Stepping(h))
        self.recorder.event(Event("set_h", 1, self.lockstep.step, self.lockstep.t, h=h), self.clock)


@pytest.fixture
def lab(tmp_path):
    (tmp_path / "library").mkdir()
    lab = Lab(tmp_path / "library" / "lab.mcap")
    yield lab
    lab.recorder.close()


def fail(lab, monkeypatch):
    """From now on the disk is full."""

    def flush():
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(lab.recorder._recorder._writer, "flush", flush)


def test_without_failures_a_recording_is_one_file(lab):
    lab.run(3.0)
    lab.recorder.close()
    assert lab.recorder.failed is None
    assert lab.recorder.files == [lab.recorder.path]
    assert verify(lab.recorder.path).complete


def test_a_full_disk_is_reported_and_the_lab_goes_on(lab, monkeypatch):
    lab.run(3.0)
    fail(lab, monkeypatch)
    lab.run(2.0)
    assert "No space left on device" in lab.recorder.failed
    assert lab.recorder.failed.isprintable()


def test_recording_resumes_in_a_new_file_that_replays_and_verifies_by_itself(lab, monkeypatch):
    lab.run(2.0)
    lab.set_h(0.05)
    lab.run(1.0)
    lab.set_h(-0.02)
    lab.run(1.0)
    fail(lab, monkeypatch)
    lab.run(2.0)
    lab.set_h(0.1)  # while nothing is recorded
    assert lab.recorder.failed
    monkeypatch.undo()
    lab.run(RETRY_EVERY + 1)
    assert lab.recorder.failed is None
    assert lab.recorder.path.name == "lab-2.mcap"
    lab.recorder.close()
    first, second = lab.recorder.files
    assert first.name == "lab.mcap.part"
    for path in (first, second):
        assert verify(path).identical
    with Recording.open(second) as recording:
        assert recording.complete
        assert recording.runs[0].scene == SCENE
        assert [event.h for _, event in recording.events if event.kind == "set_h"] == [
            0.05,
            -0.02,
            0.1,
        ]
        assert recording.events[0][0] == 0.0  # its clock begins anew
        assert recording.length < RETRY_EVERY + 1
        assert recording.sample(recording.at(99.0)).value.step == lab.lockstep.step


def test_after_a_restart_during_a_failure_the_new_file_begins_with_the_new_run(lab, monkeypatch):
    lab.run(1.0)
    fail(lab, monkeypatch)
    lab.run(1.0)
    lab.lockstep = Lockstep(SCENE, run=2)
    lab.recorder.event(start(2), lab.clock)
    monkeypatch.undo()
    lab.run(RETRY_EVERY + 1)
    lab.recorder.close()
    with Recording.open(lab.recorder.files[-1]) as recording:
        assert [run.number for run in recording.runs] == [2]
    assert verify(lab.recorder.files[-1]).identical


def test_two_labs_that_chose_the_same_name_make_two_recordings(tmp_path, monkeypatch):
    monkeypatch.setattr("recordings.live_recorder.free_path", Looks(free_path))
    path = tmp_path / "now.mcap"
    recorders = [LiveRecorder(path, or_next=True) for _ in range(2)]
    for recorder in recorders:
        recorder.event(start(), 0.0)
        recorder.sample(Lockstep(SCENE).sample(), 0.0)
        recorder.close()
    assert [recorder.path.name for recorder in recorders] == ["now.mcap", "now-2.mcap"]
    assert all(verify(recorder.path).identical for recorder in recorders)


class Looks:
    """Two labs look for a free name before either takes it: the second finds what the first did."""

    def __init__(self, shown):
        self.shown, self.found = shown, []

    def __call__(self, path):
        self.found.append(self.found[0] if len(self.found) == 1 else self.shown(path))
        return self.found[-1]


def test_a_lasting_failure_is_retried_now_and_then_and_leaves_no_files(lab, tmp_path, monkeypatch):
    lab.run(1.0)
    tries = []

    def no_recorder(path, wall):
        tries.append(path)
        raise DiskError("No space left on device", path, errno.ENOSPC)

    fail(lab, monkeypatch)
    monkeypatch.setattr("recordings.live_recorder.Recorder", no_recorder)
    lab.run(5 * RETRY_EVERY)
    assert 3 <= len(tries) <= 5
    assert lab.recorder.failed
    lab.recorder.close()
    assert [path.name for path in (tmp_path / "library").iterdir()] == ["lab.mcap.part"]


def test_a_removed_folder_is_reported_and_made_again(lab, tmp_path):
    lab.run(1.0)
    lab.recorder.path.with_name("lab.mcap.part").unlink()
    (tmp_path / "library").rmdir()
    lab.run(1.0)
    assert "No such file or directory" in lab.recorder.failed
    lab.run(RETRY_EVERY + 1)
    assert lab.recorder.failed is None
    lab.recorder.close()
    assert verify(lab.recorder.files[-1]).identical


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is forbidden to root")
def test_a_folder_that_became_read_only_is_reported(lab, tmp_path):
    lab.run(1.0)
    (tmp_path / "library").chmod(0)
    lab.run(2.0)
    failed = lab.recorder.failed
    (tmp_path / "library").chmod(0o700)
    assert "Permission denied" in failed


def test_a_first_file_that_cannot_be_written_raises_at_once(tmp_path):
    with pytest.raises(DiskError, match="no folder"):
        LiveRecorder(tmp_path / "no" / "lab.mcap")


LIMITED = """
import resource, sys
from pathlib import Path
from tests.recordings.test_live_recorder import Lab
lab = Lab(Path(sys.argv[1]))
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))
lab.run(8.0)
print(lab.recorder.failed)
resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
lab.run(10.0)
print(lab.recorder.failed)
lab.recorder.close()
print(*lab.recorder.files)
"""


def test_a_real_file_size_limit_is_survived(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, str(tmp_path / "lab.mcap")],
        capture_output=True,
        text=True,
        check=True,
    )
    failed, later, files = done.stdout.splitlines()
    assert "File too large" in failed
    assert later == "None"
    left, *finished = files.split()
    assert left == str(tmp_path / "lab.mcap.part")
    assert verify(tmp_path / "lab.mcap.part").samples > 20  # 20 kB hold some seconds
    assert finished
    for name in files.split():
        assert verify(tmp_path / name).identical


def test_nothing_is_recorded_after_the_end(lab):
    lab.run(1.0)
    lab.recorder.close()
    written = lab.recorder.path.read_bytes()
    lab.set_h(0.1)
    lab.run(3.0)
    assert lab.recorder.path.read_bytes() == written
    assert lab.recorder.failed is None
