"""Stop and continue a lab that writes, thousands of times, and see whether it still lives: one JSON object.

python tests/bench/signals.py [NUMBER OF SIGCONT] [NUMBER OF PAIRS]
"""

import json
import random
import signal
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from recordings.verify import verify
from tests.tui.pty_lab import PtyLab

CONTINUES, PAIRS = 2000, 200
RECORDING = "REC "


def alive(lab: PtyLab) -> bool:
    """Whether the lab still paints and reads its keys."""
    try:
        lab.type(" ")
        lab.wait_for("paused")
        lab.type(" ")
        lab.wait_for("running")
    except TimeoutError:
        return False
    return True


def storm(lab: PtyLab, number: int, seed: int, *signals: int) -> float:
    """Send signals at random moments of the lab's writing; returns how long it took in s."""
    chance, began = random.Random(seed), lab.now
    for _ in range(number):
        for each in signals:
            lab.signal(each)
            lab.run(chance.uniform(0.0, 0.04))
    lab.run(1.0)
    return lab.now - began


def main() -> None:
    """Send, look, and print."""
    continues, pairs = map(int, (*sys.argv[1:], *(CONTINUES, PAIRS)[len(sys.argv) - 1 :]))
    with TemporaryDirectory() as folder, PtyLab(PENDU_RECORDINGS=folder) as lab:
        lab.wait_for(RECORDING)
        report = {
            "benchmark": "signals",
            "continues": continues,
            "seconds_of_continues": round(storm(lab, continues, 1, signal.SIGCONT), 1),
            "alive_after_continues": alive(lab),
            "pairs": pairs,
            "seconds_of_pairs": round(storm(lab, pairs, 2, signal.SIGTSTP, signal.SIGCONT), 1),
            "alive_after_pairs": alive(lab),
        }
        lab.type("q")
        try:
            report["exit_code"] = lab.end()
            report["verifies"] = all(verify(path).identical for path in Path(folder).iterdir())
        except TimeoutError:
            report["exit_code"] = None
        print(json.dumps(report))


if __name__ == "__main__":
    main()
