"""The real program on terminals that have less, and on those that are taken away for a while."""

import itertools
import re
import signal
import time
from pathlib import Path

import pytest

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from tests.tui.pty_lab import PtyLab

pytestmark = pytest.mark.slow

RECORDING = "REC 0 s"
AWAY = 1.5  # s


def test_a_lab_that_was_stopped_goes_on_where_it_was(tmp_path):
    with PtyLab(PENDU_RECORDINGS=str(tmp_path)) as lab:
        lab.wait_for(RECORDING)
        for stop in (lambda: lab.type("\x1a"), lambda: lab.signal(signal.SIGSTOP)):
            stop()
            while Path(f"/proc/{lab.pid}/stat").read_text().rpartition(")")[2].split()[0] != "T":
                lab.run(0.02)
            lab.run(0.1)
            assert b"\x1b[?1049l" in lab.output  # after Ctrl+Z the terminal is the shell's
            time.sleep(AWAY)
            lab.signal(signal.SIGCONT)
            lab.wait_for(re.compile(rb"REC [1-9]"))
        lab.type("q")
        assert lab.end() == 0
        present = lab.now - 2 * AWAY
    assert lab.output.count(b"\x1b[?1049h") == 2  # painted anew
    (path,) = tmp_path.iterdir()
    assert verify(path).identical
    with Recording.open(path) as recording:
        assert recording.length < present
        times = [entry.value.t for entry in recording.entries() if isinstance(entry.value, Sample)]
    assert max(after - before for before, after in itertools.pairwise(times)) < 1.0


def is_silent(lab: PtyLab) -> bool:
    end = lab.now + 20
    while lab.now < end:
        if not lab.run(1.4):
            return True
    return False


def test_a_paused_replay_or_lab_sends_no_byte_and_what_goes_on_live_is_recorded(tmp_path):
    with PtyLab("replay", "drift", "--start-at", "5", PENDU_RECORDINGS=str(tmp_path)) as lab:
        for key, words in (("", "run 1/1"), ("f", RECORDING)):
            lab.type(key)
            lab.wait_for(words)
            lab.run(1.0)
            lab.type(" ")
            assert is_silent(lab)
            lab.type(" ")
        lab.type("q")
        assert lab.end() == 0
    (path,) = tmp_path.iterdir()
    assert verify(path).identical


def test_the_terminal_is_asked_for_its_background_and_a_late_answer_is_no_key(tmp_path):
    path = tmp_path / "lab.mcap"
    with PtyLab("live", "--record", str(path), COLORFGBG="") as lab:
        lab.wait_for("\x1b]11;?")
        lab.run(0.5)
        lab.type("\x1b]11;rgb:ff/ff/f0\x1b\\\x1b[?62;22c")
        lab.wait_for(RECORDING)
        lab.run(1.0)
        lab.type("q")
        assert lab.end() == 0
        assert b"48;2;244;244;244" in lab.output
    with Recording.open(path) as recording:
        assert [event.kind for _, event in recording.events] == ["start", "stop"]
