"""`--plain` as one uses it: with a pipe instead of a terminal, ended by Ctrl+C."""

import os
import signal
import subprocess
from pathlib import Path

import pytest

from recordings.library import listing
from recordings.verification import verify
from tests.tui.pty_lab import PENDU, ROOT

pytestmark = pytest.mark.slow


def started(folder: Path, *arguments: str) -> "subprocess.Popen[str]":
    environment = {**os.environ, "PENDU_RECORDINGS": str(folder), "TERM": "dumb"}
    return subprocess.Popen(
        [*PENDU, *arguments],
        cwd=ROOT,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def read_until(process: "subprocess.Popen[str]", words: str) -> list[str]:
    lines = []
    assert process.stdout is not None
    for line in process.stdout:
        lines.append(line)
        if words in line:
            return lines
    raise AssertionError(f"{words!r} was never said: {lines}")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["ctrl+c", "SIGTERM"])
def test_ended_by_a_signal_the_recording_is_whole_and_that_is_fine(tmp_path, number):
    with started(tmp_path, "--plain", "--speed", "8") as process:
        lines = read_until(process, "Explicit Euler over the top")
        process.send_signal(number)
        out, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (0, "")
    assert lines[0].startswith("The lab runs at 8 times real time")
    (item,) = listing(tmp_path)
    assert f"saved {item.path}" in out
    report = verify(item.path)
    assert (report.identical, report.complete) == (True, True)


def test_when_nobody_reads_any_more_the_recording_is_whole_too(tmp_path):
    with started(tmp_path, "live", "--plain", "--speed", "8") as process:
        read_until(process, "energy errors")
        assert process.stdout is not None
        process.stdout.close()
        process.wait(timeout=30)
    assert process.returncode == 141
    (item,) = listing(tmp_path)
    assert verify(item.path).complete


def test_a_replay_is_printed_to_its_end_and_nothing_is_recorded(tmp_path):
    with started(tmp_path, "replay", "drift", "--plain", "--speed", "20") as process:
        out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")
    assert out.startswith("The replay runs at 20 times real time")
    assert "Explicit Euler over the top" in out
    assert not list(tmp_path.iterdir())
