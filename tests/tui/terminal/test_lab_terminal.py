"""The real program on a real pseudo-terminal, and what it leaves behind however it ends."""

import signal
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

from pendu_tui.recordings.recording import Recording
from pendu_tui.recordings.verification import verify
from tests.tui.command_line import PENDU, ROOT, pendu
from tests.tui.pty_lab import PtyLab

pytestmark = pytest.mark.slow
pytest.importorskip("pty", reason="needs a pseudo-terminal")

RECORDING = "REC 0 s"


@pytest.fixture
def library(tmp_path: Path) -> Path:
    return tmp_path / "library"


def lab(library: Path, *arguments: str, **environment: Any) -> PtyLab:
    return PtyLab(*arguments, PENDU_RECORDINGS=str(library), **environment)


def whole(library: Path) -> list[str]:
    """The kinds of events of the library's only recording, which is finished and verifies."""
    (path,) = library.iterdir()
    assert path.suffix == ".mcap"
    assert verify(path).identical
    with Recording.open(path) as recording:
        assert recording.complete
        return [event.kind for _, event in recording.events]


def program(before: str = "", mark: str = "pass") -> list[str]:
    """The lab after some code; the key m runs some more."""
    action = f"import time\ndef mark(self): {mark}"
    patch = "from pendu_tui.tui.screens.lab import LabScreen\nLabScreen.action_mark = mark"
    return [*PENDU[:2], "\n".join([before, action, patch, PENDU[2]])]


def test_the_program_starts_follows_the_keys_quits_and_leaves_a_recording_that_verifies(library):
    with lab(library) as session:
        session.wait_for(RECORDING)
        for key, answer in (("+", "h 0.1 s"), (" ", "paused"), (".", ""), ("p", "gentle")):
            session.type(key)
            session.wait_for(answer)
        session.type("q")
        assert session.end() == 0
        (path,) = library.iterdir()
        assert f"saved {path}" in session.output.decode()
        assert f"pendu-tui replay {path}" in session.output.decode()
    assert whole(library) == ["start", "set_h", "pause", "start", "resume", "stop"]


def finish(session: PtyLab, how: signal.Signals | str) -> None:
    if how == "closed":
        session.hang_up()
    elif isinstance(how, str):
        session.type(how)
    else:
        session.signal(how)


def has_ended(session: PtyLab) -> bool:
    """Return whether it ended within 10 s and left its terminal, if it has one, as it was."""
    was_closed = session.terminal < 0
    return session.end(10.0) == 130 and (was_closed or b"\x1b[?1049l" in session.output)


DEAF = "import signal\nsignal.signal(signal.SIGHUP, signal.SIG_IGN)"


@pytest.mark.parametrize(
    ("how", "before"), [(signal.SIGINT, ""), ("\x03", ""), ("closed", ""), ("closed", DEAF)]
)
def test_whatever_ends_the_lab_finishes_the_recording(library, how, before):
    with lab(library, program=program(before)) as session:
        session.wait_for(RECORDING)
        finish(session, how)
        assert has_ended(session)
    assert whole(library)


@pytest.mark.parametrize("how", [signal.SIGHUP, signal.SIGINT, "closed"])
def test_a_lab_ends_though_it_was_stopped(library, how):
    with lab(library) as session:
        session.wait_for(RECORDING)
        session.signal(signal.SIGTSTP)
        session.run(0.3)
        finish(session, how)
        session.signal(signal.SIGCONT)
        assert has_ended(session)
    assert whole(library)


def test_a_lab_whose_loop_is_stuck_ends_within_10_s_and_its_recording_is_finished(tmp_path):
    with ExitStack() as stack:
        labs = {}
        for how in (signal.SIGTERM, signal.SIGHUP, "closed"):
            stuck = lab(tmp_path / str(how), program=program(mark="time.sleep(1000)"))
            labs[how] = stack.enter_context(stuck)
            stuck.wait_for(RECORDING)
            stuck.type("m")
            stuck.run(0.5)
        for how, stuck in labs.items():
            finish(stuck, how)
        for how, stuck in labs.items():
            assert has_ended(stuck)
            assert whole(tmp_path / str(how))


ENDLESS = """
import os
def mine(force, phase, h):
    while True:
        while os.path.exists("endless"): pass
        theta, omega = phase
        phase = theta + h * omega, omega + h * force(theta)
        yield phase
"""


@contextmanager
def stuck_lab(folder: Path, library: Path, work: str = "pass"):
    """A lab whose method does some work for ever from here on."""
    (folder / "mine.py").write_text(ENDLESS.replace("pass", work))
    own = ("live", "--method", "mine.py:mine")
    with lab(library, *own, folder=folder, PYTHONPATH=str(ROOT)) as session:
        session.wait_for("REC 1 s")
        (folder / "endless").touch()
        yield session


def test_a_method_that_does_not_yield_is_told_of_and_the_keys_work(tmp_path, library):
    with stuck_lab(tmp_path, library) as session:
        session.wait_for("takes more than 3 s", 6.0)
        assert b"has stopped" in session.output
        session.type("p")
        session.wait_for("gentle", 6.0)
        session.type("q")
        assert session.end() == 0
    (recorded,) = library.iterdir()
    (tmp_path / "endless").unlink()
    assert pendu("verify", recorded, "--method", f"{tmp_path / 'mine.py'}:mine").code == 0


@pytest.mark.parametrize(
    ("work", "code", "words", "left"),
    [
        ("__import__('time').sleep(99)", 3, b"mine.py, line 5: `while", ".mcap"),
        ("sum(iter(int, 1))", -signal.SIGKILL, b"a call in C", ".part"),  # keeps the interpreter
    ],
)
def test_a_method_that_cannot_be_interrupted_ends_the_lab_with_a_sentence(
    tmp_path, library, work, code, words, left
):
    with stuck_lab(tmp_path, library, work) as session:
        assert session.end(60.0) == code
        assert b"1049l" in session.output
        assert words in session.output
    (path,) = library.iterdir()
    assert path.suffix == left
    with Recording.open(path) as recording:
        assert recording.length > 0.5


def test_a_bug_ends_the_lab_with_a_traceback_and_its_recording_is_finished(library):
    with lab(library, program=program(mark="raise ZeroDivisionError('in the lab')")) as session:
        session.wait_for(RECORDING)
        session.type("m")
        assert session.end() == 1
        printed = session.output.decode().rpartition("\x1b[")[2]
    assert "replay it with" in printed
    assert "ZeroDivisionError: in the lab" in printed
    assert whole(library)
