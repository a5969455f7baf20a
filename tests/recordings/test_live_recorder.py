"""The lab goes on if the disk fails."""

import subprocess
import sys

import pytest

from engine.run.lockstep import Lockstep
from recordings.errors import DiskError
from recordings.events import Event
from recordings.recorder import LiveRecorder
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


@pytest.fixture
def lab(tmp_path):
    (tmp_path / "library").mkdir()
    lab = Lab(tmp_path / "library" / "lab.mcap")
    yield lab
    lab.recorder.close()


def test_a_recording_ends_whole_before_it_has_more_events_than_may_be_read(lab, monkeypatch):
    for module in ("recorder", "recording"):
        monkeypatch.setattr(f"recordings.{module}.MAX_EVENTS", 30)
    for _ in range(40):
        lab.run(0.1)
        lab.recorder.event(Event("mark", 1, lab.lockstep.step, lab.lockstep.t), lab.clock)
    assert "is full" in lab.recorder.failed
    with Recording.open(lab.recorder.path, check=True) as recording:
        assert recording.complete
        assert len(recording.events) == 30


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
lab.recorder.close()
"""


def test_a_real_file_size_limit_is_survived(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, str(tmp_path / "lab.mcap")],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "File too large" in done.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["lab.mcap.part"]
    assert verify(tmp_path / "lab.mcap.part").identical
