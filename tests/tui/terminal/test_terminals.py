"""The real program on terminals that have less, and on those that are taken away for a while."""

import itertools
import random
import re
import signal
import time
from pathlib import Path

import pytest

from engine.run.lockstep import Sample
from recordings.recording import Recording
from recordings.verification import verify
from tests.tui.emulator import Emulator
from tests.tui.pty_lab import PtyLab

pytestmark = pytest.mark.slow

RECORDING = "REC 0 s"
NEVER_CHANGES = "Phase space"  # once painted
AWAY = 1.5  # s
QUIET = 1.0  # s; a chart is built and painted in a third of that
MOUSE = b"\x1b[?1000h"
VIEWS = {"Phase space": "\x1bOR", "Accuracy": "\x1bOS", "Stability": "\x1b[15~", "Events": "\x1bOQ"}
"""What one sees of a view, and its key."""

SGR = re.compile(rb"\x1b\[([\d;]*)m")


def seen(library: Path, *arguments: str, keys: str = "", **environment: str) -> bytes:
    """What the lab sends in its first second and with some keys."""
    with PtyLab(*arguments, PENDU_RECORDINGS=str(library), **environment) as lab:
        lab.wait_for(RECORDING)
        for key in keys:
            lab.type(key)
            lab.run(0.3)
        lab.type("q")
        assert lab.end() == 0
        return bytes(lab.output)


@pytest.fixture
def lab(tmp_path):
    """A lab that quits at a q."""
    with PtyLab(PENDU_RECORDINGS=str(tmp_path)) as lab:
        yield lab
        lab.type("q")
        assert lab.end() == 0


def codes(output: bytes) -> set[str]:
    """The numbers of all colours and attributes."""
    return {
        code
        for sequence in SGR.findall(output)
        for code in re.findall(r"[34]8;[25];[\d;]+?(?=;[34]8|$)|\d+", sequence.decode())
    }


def test_without_utf_8_the_whole_lab_is_ascii(tmp_path):
    output = seen(tmp_path, keys="v?q", PYTHONUTF8="0", PYTHONIOENCODING="latin-1")
    assert output.isascii()
    assert b"1x" in output  # 1×
    assert b"-----" in output  # a frame


def test_no_color_is_no_colour_at_all_and_no_mouse_leaves_the_mouse_alone(tmp_path):
    output = seen(tmp_path, "--no-mouse", NO_COLOR="1")
    assert codes(output) <= {"0", "1", "2", "7", "39", "49", "22", "27"}
    assert MOUSE not in output


@pytest.mark.parametrize(
    ("term", "some", "none"),
    [
        ("xterm", ("91", "93", "94", "96"), ("38;", "48;")),
        ("xterm-256color", ("38;5;",), ("38;2;", "48;2;")),
    ],
)
def test_a_terminal_with_few_colours_gets_no_others(tmp_path, term, some, none):
    output = seen(tmp_path, TERM=term, COLORTERM="")
    assert all(any(code.startswith(start) for code in codes(output)) for start in some)
    assert not [code for code in codes(output) if code.startswith(none)]
    assert MOUSE in output


def test_frames_come_as_often_as_is_asked_for(tmp_path):
    with PtyLab("--fps", "5", "--h", "0.001", PENDU_RECORDINGS=str(tmp_path)) as lab:
        lab.wait_for(RECORDING)
        began = lab.now
        count = len(lab.reads)
        lab.run(2)
        times = [at for at, _ in lab.reads[count:]]
        bursts = 1 + sum(after - before > 0.05 for before, after in itertools.pairwise(times))
        assert 2 * 5 * 0.5 < bursts <= (lab.now - began) * 5 + 2  # late ones are not made up for


def state(pid: int) -> str:
    return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]


def test_a_lab_that_was_stopped_goes_on_where_it_was(tmp_path):
    with PtyLab(PENDU_RECORDINGS=str(tmp_path)) as lab:
        lab.wait_for(RECORDING)
        for stop in STOPS:
            sent = stopped(lab, stop)
            assert stop is not STOPS[0] or b"\x1b[?1049l" in sent  # the terminal is the shell's
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


STOPS = (lambda lab: lab.type("\x1a"), lambda lab: lab.signal(signal.SIGSTOP))


def stopped(lab: PtyLab, stop) -> bytes:
    """Stop the program; returns what it sends until then."""
    start = len(lab.output)
    stop(lab)
    while state(lab.pid) != "T":
        lab.run(0.02)
    lab.run(0.1)
    return bytes(lab.output[start:])


def standing(lab: PtyLab) -> list[str]:
    """Pause; returns what is on the screen then."""
    lab.wait_for("REC 1 s")
    lab.type(" ")
    lab.wait_for("paused")
    emulator = painted_anew(lab)
    lines = still(emulator)
    quiet_since = lab.now
    while lab.now < quiet_since + QUIET:
        lab.run(0.1)
        if (now := still(emulator)) != lines:
            lines = now
            quiet_since = lab.now
    return lines


def painted_anew(lab: PtyLab) -> Emulator:
    """An emulator of the screen, all of which is painted after a change of size."""
    lab.resize(121, 41)
    lab.run(0.3)
    emulator = Emulator(lab)
    lab.resize(120, 40)
    return emulator


def still(emulator: Emulator, title: str = "") -> list[str]:
    """Wait until the screen is whole and shows the title; returns its standing part."""

    def is_right(lines: list[str]) -> bool:
        panes = [line for line in lines if line.startswith("╭") and line.endswith("╮")]
        is_whole = "paused" in lines[0] and bool(panes) and "Help" in lines[-1]
        return is_whole and title in "".join(lines)

    return standing_part(emulator.wait_until(is_right))


def standing_part(lines: list[str]) -> list[str]:
    """The screen without the insight line and the recording's length, which go on changing."""
    return [lines[0].partition("REC")[0], *lines[1:-3], lines[-1]]


def test_what_stood_on_the_screen_stands_there_again_to_the_letter(lab):
    before = standing(lab)
    for stop in STOPS:
        stopped(lab, stop)
        emulator = Emulator(lab)
        lab.signal(signal.SIGCONT)
        emulator.wait_until(lambda lines: standing_part(lines) == before)
    storm = random.Random(100)
    for title, key in VIEWS.items():
        lab.type(key)
        for _ in range(12):
            lab.resize(storm.randint(1, 220), storm.randint(1, 70))
            lab.run(0.04)
        emulator = Emulator(lab)
        lab.resize(120, 40)
        still(emulator, title)
    emulator.wait_until(lambda lines: standing_part(lines) == before)


def is_silent(lab: PtyLab) -> bool:
    """Whether nothing is sent any more: a cursor that blinks sends something twice a second."""
    end = lab.now + 20
    while lab.now < end:
        if not lab.run(1.4):
            return True
    return False


def test_a_paused_replay_or_lab_sends_no_byte():
    with PtyLab("replay", "drift", "--no-record") as lab:
        for key, kind in (("", "REPLAY"), ("f", "LIVE")):
            lab.type(key)
            lab.wait_for(kind)
            lab.run(1.0)
            lab.type(" ")
            assert is_silent(lab)
            lab.type(" ")


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


def test_a_terminal_that_never_answers_costs_a_second(tmp_path):
    with PtyLab("--no-record", COLORFGBG="") as lab:
        asked = lab.wait_for("\x1b]11;?")
        assert lab.wait_for("not recorded") - asked > 0.9
        lab.type("q")
        assert lab.end() == 0
