"""Stop, continue and end labs at random moments, close their terminals: one JSON object.

python tests/bench/signals.py [--continues N] [--stops N] [--ends N] [--closed N]
"""

import argparse
import json
import random
import signal
import sys
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[2]))

from recordings.verification import verify
from tests.tui.pty_lab import PtyLab

MAX_END_TIME = 10.0  # s from a signal to the end
ENDS = (signal.SIGHUP, signal.SIGTERM, signal.SIGINT)
STOPS = (signal.SIGSTOP, signal.SIGTSTP)


def storm(lab: PtyLab, count: int, chance: random.Random, *kinds: tuple[int, ...]) -> None:
    """Send one signal of each kind, so many times, at random moments."""
    for _ in range(count):
        for kind in kinds:
            lab.signal(chance.choice(kind))
            lab.run(chance.uniform(0.0, 0.04))


def is_alive(lab: PtyLab) -> bool:
    """Return whether the lab still paints and reads its keys."""
    for _ in range(3):  # a key may come while the terminal is taken, and be lost
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
    """Return what becomes of a lab in a storm of signals."""
    with TemporaryDirectory() as folder, PtyLab(PENDU_RECORDINGS=folder) as lab:
        lab.wait_for("REC ")
        storm(lab, count, random.Random(1), *kinds)
        lab.run(2.0)
        alive = is_alive(lab)
        lab.type("q")
        return Counter(signals=count, alive=alive) + result(lab, Path(folder))


def ends(chance: random.Random, *, closed: bool) -> Counter[str]:
    """Return what becomes of a lab whose terminal is closed, or which is asked to end, perhaps while it is stopped."""
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
    """Wait for the end; returns counts of what is left."""
    began = lab.now
    try:
        code = lab.end(60.0)
    except TimeoutError:
        return Counter({"still_there": 1})
    left = list(folder.iterdir())
    finished = [path for path in left if path.suffix == ".mcap"]
    return Counter(
        {
            f"exit_{code}": 1,
            "late": lab.now - began > MAX_END_TIME,
            "recordings": len(finished),
            "verified": sum(verify(path).identical for path in finished),
            "unfinished": len(left) - len(finished),
        }
    )


def main() -> None:
    """Send, look, and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--continues", type=int, default=2000)
    parser.add_argument("--stops", type=int, default=200)
    parser.add_argument("--ends", type=int, default=60)
    parser.add_argument("--closed", type=int, default=100)
    options = parser.parse_args()
    chance = random.Random(2)
    cont = (signal.SIGCONT,)
    report = {
        "continues": survives(options.continues, cont),
        "stops": survives(options.stops, STOPS, cont),
        "ends": sum((ends(chance, closed=False) for _ in range(options.ends)), Counter()),
        "closed": sum((ends(chance, closed=True) for _ in range(options.closed)), Counter()),
    }
    print(
        json.dumps({"bench": "signals", **{name: dict(counts) for name, counts in report.items()}})
    )


if __name__ == "__main__":
    main()
