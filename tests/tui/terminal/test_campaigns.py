import random
import signal
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from pendu_tui.recordings.verification import verify
from tests.tui.pty_lab import PtyLab

pytestmark = pytest.mark.slow
pytest.importorskip("pty", reason="needs a pseudo-terminal")

MAX_END_TIME = 10.0  # s from a signal to the end
ENDS = (signal.SIGHUP, signal.SIGTERM, signal.SIGINT)
STOPS = (signal.SIGSTOP, signal.SIGTSTP)


def survives(count: int, *kinds: tuple[int, ...]) -> Counter[str]:
    """Return the outcomes of a lab that gets many signals at random moments."""
    chance = random.Random(1)
    with TemporaryDirectory() as folder, PtyLab(PENDU_RECORDINGS=folder) as lab:
        lab.wait_for("REC ")
        for _ in range(count):
            for kind in kinds:
                lab.signal(chance.choice(kind))
                lab.run(chance.uniform(0.0, 0.04))
        lab.run(2.0)
        lab.type(" ")
        lab.wait_for("paused")
        lab.type("q")
        return result(lab, Path(folder))


def ends(chance: random.Random, *, closed: bool) -> Counter[str]:
    """Return the outcomes of a lab, perhaps stopped, that gets a signal or loses its terminal."""
    with TemporaryDirectory() as folder, PtyLab(PENDU_RECORDINGS=folder) as lab:
        lab.wait_for("REC ")
        lab.run(chance.uniform(0.0, 3.0))
        if chance.random() < 0.5 or not closed:
            lab.signal(chance.choice(STOPS))
            lab.run(chance.uniform(0.0, 0.5))
        if closed:
            lab.hang_up()
        else:
            lab.signal(chance.choice(ENDS))
        lab.signal(signal.SIGCONT)
        return result(lab, Path(folder))


def result(lab: PtyLab, folder: Path) -> Counter[str]:
    """Wait for the end and count the outcomes."""
    began = lab.now
    code = lab.end(60.0)
    (path,) = folder.iterdir()
    late = lab.now - began > MAX_END_TIME
    is_whole = path.suffix == ".mcap" and verify(path).identical
    return Counter({f"exit {code}": 1, "late": int(late), "verified": int(is_whole)})


def test_a_lab_lives_on_after_a_storm_of_signals():
    assert survives(20, STOPS, (signal.SIGCONT,)) == Counter({"exit 0": 1, "verified": 1})


@pytest.mark.parametrize("closed", [False, True])
def test_a_lab_ends_though_it_was_stopped_and_its_recording_verifies(closed):
    ended = ends(random.Random(4), closed=closed)
    assert (ended["late"], ended["verified"]) == (0, 1)
