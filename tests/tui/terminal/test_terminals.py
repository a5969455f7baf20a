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

T = re.compile(rb"t (\d+\.\d+) s")
SGR = re.compile(rb"\x1b\[([\d;]*)m")


def session(library: Path, *arguments: str, **environment: str) -> PtyLab:
    return PtyLab(*arguments, PENDU_RECORDINGS=str(library), **environment)


def seen(library: Path, *arguments: str, keys: str = "", **environment: str) -> bytes:
    """What the lab sends in its first second and with some keys."""
    with session(library, *arguments, **environment) as pendu:
        pendu.wait_for(RECORDING)
        for key in keys:
            pendu.type(key)
            pendu.run(0.3)
        pendu.type("q")
        assert pendu.end() == 0
        return bytes(pendu.output)


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


def test_pixels_can_be_chosen(tmp_path):
    assert seen(tmp_path, "live", "--pixels", "ascii").decode().isascii()
    assert "▀" in seen(tmp_path, "live", "--pixels", "half").decode()


def test_no_color_is_no_colour_at_all_and_no_mouse_leaves_the_mouse_alone(tmp_path):
    output = seen(tmp_path, "--no-mouse", NO_COLOR="1")
    assert codes(output) <= {"0", "1", "2", "7", "39", "49", "22", "27"}
    assert MOUSE not in output


def test_with_16_colours_there_are_no_others(tmp_path):
    found = codes(seen(tmp_path, TERM="xterm", COLORTERM=""))
    assert {"91", "94", "96", "93"} <= found  # the methods
    assert not [code for code in found if code.startswith(("38;", "48;"))]


def test_with_256_colours_there_are_no_others(tmp_path):
    output = seen(tmp_path, COLORTERM="")
    assert [code for code in codes(output) if code.startswith("38;5;")]
    assert not [code for code in codes(output) if code.startswith(("38;2;", "48;2;"))]
    assert MOUSE in output


def test_frames_come_as_often_as_is_asked_for(tmp_path):
    with session(tmp_path, "--fps", "5", "--h", "0.001") as pendu:
        pendu.wait_for(RECORDING)
        began, count = pendu.now, len(pendu.reads)
        pendu.run(2)
        times = [at for at, _ in pendu.reads[count:]]
        bursts = 1 + sum(after - before > 0.05 for before, after in itertools.pairwise(times))
        assert 2 * 5 * 0.5 < bursts <= (pendu.now - began) * 5 + 2  # late ones are not made up for
        pendu.type("q")
        assert pendu.end() == 0


def state(pid: int) -> str:
    return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]


def test_a_lab_that_was_stopped_goes_on_where_it_was(tmp_path):
    with session(tmp_path) as pendu:
        pendu.wait_for(RECORDING)
        for ctrl_z in (True, False):
            if ctrl_z:
                pendu.type("\x1a")
                assert b"\x1b[?1049l" in stopped(pendu)  # the terminal is the shell's
            else:
                pendu.signal(signal.SIGSTOP)
                stopped(pendu)
            time.sleep(AWAY)
            pendu.signal(signal.SIGCONT)
            pendu.wait_for(NEVER_CHANGES)
        pendu.wait_for("REC 1 s")
        pendu.type("q")
        assert pendu.end() == 0
        present = pendu.now - 2 * AWAY
    assert pendu.output.count(b"\x1b[?1049h") == 3  # painted anew
    (path,) = tmp_path.iterdir()
    assert verify(path).identical
    with Recording.open(path) as recording:
        assert recording.length < present
        times = [entry.value.t for entry in recording.entries() if isinstance(entry.value, Sample)]
    assert max(after - before for before, after in itertools.pairwise(times)) < 1.0


def stopped(pendu: PtyLab) -> bytes:
    """Wait until the program is stopped; returns what it sends until then."""
    start = len(pendu.output)
    while state(pendu.pid) != "T":
        pendu.run(0.02)
    pendu.run(0.1)
    return bytes(pendu.output[start:])


def standing(pendu: PtyLab) -> list[str]:
    """Pause; returns what is on the screen then."""
    pendu.wait_for("REC 1 s")
    pendu.type(" ")
    pendu.wait_for("paused")
    emulator = painted_anew(pendu)
    lines = still(emulator)
    quiet_since = pendu.now
    while pendu.now < quiet_since + QUIET:
        pendu.run(0.1)
        if (now := still(emulator)) != lines:
            lines, quiet_since = now, pendu.now
    return lines


def painted_anew(pendu: PtyLab) -> Emulator:
    """An emulator of the screen, all of which is painted after a change of size."""
    pendu.resize(121, 41)
    pendu.run(0.3)
    emulator = Emulator(pendu)
    pendu.resize(120, 40)
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


def test_what_stood_on_the_screen_stands_there_again_to_the_letter(tmp_path):
    with session(tmp_path) as pendu:
        before = standing(pendu)
        emulator = painted_anew(pendu)
        emulator.wait_until(lambda lines: standing_part(lines) == before)
        for stop in (lambda: pendu.type("\x1a"), lambda: pendu.signal(signal.SIGSTOP)):
            stop()
            stopped(pendu)
            emulator = Emulator(pendu)
            pendu.signal(signal.SIGCONT)
            emulator.wait_until(lambda lines: standing_part(lines) == before)
        pendu.type("q")
        assert pendu.end() == 0


def test_a_storm_of_sizes_leaves_every_view_whole(tmp_path):
    storm = random.Random(100)
    with session(tmp_path) as pendu:
        before = standing(pendu)
        for title, key in VIEWS.items():
            pendu.type(key)
            for _ in range(12):
                pendu.resize(storm.randint(1, 220), storm.randint(1, 70))
                pendu.run(0.04)
            emulator = Emulator(pendu)
            pendu.resize(120, 40)
            still(emulator, title)
        emulator.wait_until(lambda lines: standing_part(lines) == before)
        pendu.type("q")
        assert pendu.end() == 0


def becomes_silent(pendu: PtyLab, seconds: float = 20.0) -> bool:
    """Whether nothing is sent any more: a cursor that blinks sends something twice a second."""
    end = pendu.now + seconds
    while pendu.now < end:
        if not pendu.run(1.1):
            return True
    return False


def test_with_reduced_motion_a_paused_lab_stands_still_and_what_lies_over_it_does_too(tmp_path):
    with session(tmp_path, TEXTUAL_ANIMATIONS="none") as pendu:
        pendu.wait_for(RECORDING)
        pendu.type(" ")
        assert becomes_silent(pendu)
        for key in "i\x10?":
            pendu.type(key)
            assert pendu.run(0.3)
            assert becomes_silent(pendu)
            pendu.type("\x1b")
            pendu.run(0.3)


@pytest.mark.parametrize(
    ("colour", "paper"), [("ffff/ffff/f0f0", b"244;244;244"), ("12/12/12", b"18;18;18")]
)
def test_the_terminal_is_asked_for_its_background_and_a_late_answer_is_no_key(
    tmp_path, colour, paper
):
    path = tmp_path / "lab.mcap"
    with session(tmp_path, "live", "--record", str(path), COLORFGBG="") as pendu:
        pendu.wait_for("\x1b]11;?")
        pendu.run(0.5)
        pendu.type(f"\x1b]11;rgb:{colour}\x1b\\\x1b[?62;22c")
        pendu.wait_for(RECORDING)
        pendu.run(1.0)
        pendu.type("q")
        assert pendu.end() == 0
        assert b"48;2;" + paper in pendu.output
    with Recording.open(path) as recording:
        assert [event.kind for _, event in recording.events] == ["start", "stop"]


def test_a_terminal_that_never_answers_costs_a_second(tmp_path):
    with session(tmp_path, COLORFGBG="") as pendu:
        asked = pendu.wait_for("\x1b]11;?")
        assert pendu.wait_for(RECORDING) - asked > 0.9
        pendu.type("q")
        assert pendu.end() == 0
