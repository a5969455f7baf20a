"""After kill -9 at any moment the leftover verifies, and lacks less than a second."""

import random
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from pendu_tui.recordings.events import remember
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from tests.recordings.killed import OWN

pytestmark = pytest.mark.slow


def whole_lines(log):
    return log.read_text().rpartition("\n")[0].splitlines()


def kill_one(folder, after):
    """Kill a lab `after` its first sample [s]; return the loss [s] and what verify finds."""
    folder.mkdir()
    log = folder / "log"
    command = [sys.executable, "-m", "tests.recordings.killed", str(folder / "a.mcap"), str(log)]
    lab = subprocess.Popen(command, cwd=Path(__file__).parents[2])
    try:
        while not log.exists() or not whole_lines(log):
            assert lab.poll() is None
            time.sleep(0.01)
        time.sleep(after)
    finally:
        lab.kill()
        lab.wait()
    part = folder / "a.mcap.part"
    with Recording.open(part) as recording:
        assert not recording.complete
        assert not recording.damaged
        last = recording.sample(recording.at(recording.length)).value
    lost_at = []  # s, when the lost samples were taken
    for line in whole_lines(log):
        when, run, step = line.split()
        if (int(run), int(step)) > (last.run, last.step):
            lost_at.append(float(when))
    loss = lost_at[-1] - lost_at[0] if lost_at else 0.0
    remember(OWN)
    return loss, verify(part)


def kill_many(folder, kills):
    """Kill labs at random moments; return each one's loss [s] and what verify finds."""
    folders = [folder / f"{number}" for number in range(kills)]
    moments = [random.uniform(0.0, 2.5) for _ in folders]
    with ThreadPoolExecutor(8) as pool:  # labs sleep most of the time
        return list(pool.map(kill_one, folders, moments))


def test_a_killed_lab_leaves_a_recording_that_verifies_and_lacks_less_than_a_second(tmp_path):
    for loss, verification in kill_many(tmp_path, 4):
        assert loss < 1.0
        assert verification.identical
