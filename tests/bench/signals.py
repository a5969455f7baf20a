"""Stop, continue and end labs at random moments, or close their terminals."""

import random
import signal
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from pendu_tui.recordings.verification import verify
from tests.tui.pty_lab import PtyLab

LIMITS = dict.fromkeys(("dead", "still_there", "late", "unfinished", "not_verified"), 0)
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


def measure(share: float) -> dict[str, Any]:
    chance = random.Random(2)
    storms = [survives(round(2000 * share), (signal.SIGCONT,))]
    storms.append(survives(round(200 * share), STOPS, (signal.SIGCONT,)))
    asked = sum((ends(chance, closed=False) for _ in range(round(60 * share))), Counter())
    closed = sum((ends(chance, closed=True) for _ in range(round(100 * share))), Counter())
    total = sum([*storms, asked, closed], Counter())
    return {
        "storms": [dict(counts) for counts in storms],
        "asked_to_end": dict(asked),
        "closed": dict(closed),
        "dead": len(storms) - total["alive"],
        "still_there": total["still_there"],
        "late": total["late"],
        "unfinished": total["unfinished"],
        "not_verified": total["recordings"] - total["verified"],
    }
