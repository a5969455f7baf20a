"""`--plain` with a pipe instead of a terminal."""

import os
import subprocess

import pytest

from pendu_tui.recordings.verification import verify
from tests.tui.command_line import PENDU


@pytest.mark.slow
def test_when_nobody_reads_any_more_the_recording_is_whole(tmp_path):
    env = {**os.environ, "PENDU_RECORDINGS": str(tmp_path)}
    line = [*PENDU, "live", "--plain", "--speed", "20"]
    with subprocess.Popen(line, env=env, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline().startswith("The lab runs at 20×")
        process.stdout.close()
        process.wait(timeout=30)
    assert process.returncode == 141
    (path,) = tmp_path.iterdir()
    report = verify(path)
    assert (report.identical, report.complete) == (True, True)
