"""The real program, stopped when its end comes."""

import signal

import pytest

from pendu_tui.recordings.verification import verify
from tests.tui.pty_lab import PtyLab

pytestmark = pytest.mark.slow
pytest.importorskip("pty", reason="needs a pseudo-terminal")


def finished(lab: PtyLab, folder) -> bool:
    """Wait for the end; return whether it came within 10 s and left a recording that verifies."""
    began = lab.now
    lab.end(60.0)
    (path,) = folder.iterdir()
    return lab.now - began < 10 and path.suffix == ".mcap" and verify(path).identical


@pytest.mark.parametrize("end", [signal.SIGHUP, signal.SIGINT, "closed"])
def test_a_lab_ends_though_it_was_stopped(tmp_path, end):
    with PtyLab(PENDU_RECORDINGS=str(tmp_path)) as lab:
        lab.wait_for("REC ")
        lab.signal(signal.SIGTSTP)
        lab.run(0.3)
        if end == "closed":
            lab.hang_up()
        else:
            lab.signal(end)
        lab.signal(signal.SIGCONT)
        assert finished(lab, tmp_path)
