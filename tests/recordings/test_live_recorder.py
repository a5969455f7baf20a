"""The lab goes on if the disk fails."""

import subprocess
import sys

from recordings.events import Event
from recordings.headless import simulate
from recordings.recorder import LiveRecorder
from recordings.recording import Recording
from recordings.verification import verify
from tests.recordings.examples import SCENE


def test_a_recording_ends_whole_before_it_has_more_events_than_may_be_read(tmp_path, monkeypatch):
    for module in ("recorder", "recording"):
        monkeypatch.setattr(f"recordings.{module}.MAX_EVENTS", 30)
    recorder = LiveRecorder(tmp_path / "lab.mcap")
    for sample in simulate(SCENE, 4.0, recorder):
        recorder.event(Event("mark", 1, sample.step, sample.t), sample.t)
    assert "is full" in recorder.failed
    with Recording.open(recorder.path, check=True) as recording:
        assert recording.complete
        assert len(recording.events) == 30


LIMITED = """
import resource, sys
from pathlib import Path
from tests.recordings.test_live_recorder import *
recorder = LiveRecorder(Path(sys.argv[1]))
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))
samples = list(simulate(SCENE, 8.0, recorder))
print(len(samples), recorder.failed)
recorder.close()
"""


def test_a_real_file_size_limit_is_survived(tmp_path):
    command = [sys.executable, "-c", LIMITED, str(tmp_path / "lab.mcap")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("81 ")
    assert "File too large" in done.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["lab.mcap.part"]
    assert verify(tmp_path / "lab.mcap.part").identical
