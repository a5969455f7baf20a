"""`--plain` with a pipe instead of a terminal."""

import os
import subprocess
from pathlib import Path

import pytest

from pendu_tui.recordings.verification import verify
from tests.tui.command_line import PENDU

pytestmark = pytest.mark.slow


def started(folder: Path, *arguments: str) -> "subprocess.Popen[str]":
    env = {**os.environ, "PENDU_RECORDINGS": str(folder), "TERM": "dumb"}
    pipe = subprocess.PIPE
    return subprocess.Popen([*PENDU, *arguments], env=env, stdout=pipe, stderr=pipe, text=True)


def test_when_nobody_reads_any_more_the_recording_is_whole(tmp_path):
    with started(tmp_path, "live", "--plain", "--speed", "20") as process:
        process.stdout.readline()
        process.stdout.close()
        process.wait(timeout=30)
    assert process.returncode == 141
    (path,) = tmp_path.iterdir()
    report = verify(path)
    assert (report.identical, report.complete) == (True, True)


def test_a_replay_is_printed_to_its_end_and_nothing_is_recorded(tmp_path):
    with started(tmp_path, "replay", "drift", "--plain", "--speed", "20") as process:
        out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")
    assert out.startswith("The replay runs at 20× speed")
    assert "Explicit Euler over the top" in out
    assert not list(tmp_path.iterdir())
