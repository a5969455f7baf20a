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
NEVER_CHANGES = "Phase space"  # once painted
AWAY = 1.5  # s


def seen(library: Path, *arguments: str, keys: str = "", **environment: str) -> bytes:
    """What the lab sends in its first second and with some keys."""
    with PtyLab(*arguments, PENDU_RECORDINGS=str(library), **environment) as lab:
        lab.wait_for(RECORDING)
        for key in keys:
            lab.type(key)
            lab.run(0.3)
        return bytes(lab.output)


def test_without_utf_8_the_whole_lab_is_ascii(tmp_path):
    output = seen(tmp_path, keys="v?", PYTHONUTF8="0", PYTHONIOENCODING="latin-1")
    assert output.isascii()
    assert b"1x" in output  # 1×
    assert b"-----" in output  # a frame


def test_no_color_is_no_colour_at_all_and_no_mouse_leaves_the_mouse_alone(tmp_path):
    colour = re.compile(rb"[34]8;[25];")
    mouse = b"\x1b[?1000h"
    usual = seen(tmp_path)
    plain = seen(tmp_path, "--no-mouse", NO_COLOR="1")
    assert [bool(colour.search(each)) for each in (usual, plain)] == [True, False]
    assert [mouse in each for each in (usual, plain)] == [True, False]


def test_frames_come_as_often_as_is_asked_for(tmp_path):
    with PtyLab("--fps", "5", "--h", "0.001", PENDU_RECORDINGS=str(tmp_path)) as lab:
        lab.wait_for(RECORDING)
        began = lab.now
        count = len(lab.reads)
        lab.run(2)
        times = [at for at, _ in lab.reads[count:]]
        bursts = 1 + sum(after - before > 0.05 for before, after in itertools.pairwise(times))
        assert 2 * 5 * 0.5 < bursts <= (lab.now - began) * 5 + 2  # late ones are not made up for


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
            lab.wait_for(NEVER_CHANGES)
        lab.wait_for("REC 1 s")
        lab.type("q")
        assert lab.end() == 0
        present = lab.now - 2 * AWAY
    assert lab.output.count(b"\x1b[?1049h") == 3  # painted anew
    (path,) = tmp_path.iterdir()
    assert verify(path).identical
    with Recording.open(path) as recording:
        assert recording.length < present
        times = [entry.value.t for entry in recording.entries() if isinstance(entry.value, Sample)]
    assert max(after - before for before, after in itertools.pairwise(times)) < 1.0


def is_silent(lab: PtyLab) -> bool:
    """Whether nothing is sent any more; a cursor that blinks sends something twice a second."""
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


def test_a_terminal_that_never_answers_costs_a_second():
    with PtyLab("--no-record", COLORFGBG="") as lab:
        asked = lab.wait_for("\x1b]11;?")
        assert lab.wait_for("not recorded") - asked > 0.9
