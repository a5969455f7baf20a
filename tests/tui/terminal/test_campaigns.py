"""No signal, and no closed terminal, leaves a lab that hangs."""

import random
import signal
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from pendu_tui.recordings.verification import verify
from tests.tui.pty_lab import PtyLab

pytestmark = pytest.mark.slow

MAX_END_TIME = 10.0  # s from a signal to the end
ENDS = (signal.SIGHUP, signal.SIGTERM, signal.SIGINT)
STOPS = (signal.SIGSTOP, signal.SIGTSTP)


def is_alive(lab: PtyLab) -> bool:
    """Return whether the lab still paints and reads its keys."""
    for _ in range(3):  # a key that is typed while the lab resumes may be lost
        try:
            lab.type(" ")
            lab.wait_for("paused", 5.0)
            lab.type(" ")
            lab.wait_for("running", 5.0)
        except TimeoutError:
            continue
        return True
    return False


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
        alive = is_alive(lab)
        lab.type("q")
        return Counter(alive=alive) + result(lab, Path(folder))


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
    try:
        code = lab.end(60.0)
    except TimeoutError:
        return Counter({"still_there": 1})
    files = list(folder.iterdir())
    finished = [path for path in files if path.suffix == ".mcap"]
    return Counter(
        {
            f"exit_{code}": 1,
            "late": lab.now - began > MAX_END_TIME,
            "recordings": len(finished),
            "verified": sum(verify(path).identical for path in finished),
            "unfinished": len(files) - len(finished),
        }
    )


def test_a_lab_lives_on_after_a_storm_of_signals():
    counts = survives(20, STOPS, (signal.SIGCONT,))
    assert (counts["alive"], counts["exit_0"], counts["verified"]) == (1, 1, 1)


@pytest.mark.parametrize("closed", [False, True])
def test_a_lab_ends_though_it_was_stopped_and_its_recording_verifies(closed):
    counts = ends(random.Random(4), closed=closed)
    assert (counts["still_there"], counts["late"], counts["unfinished"]) == (0, 0, 0)
    assert counts["verified"] == 1
