"""Stop and continue a lab that writes, close its terminal, and see what is left: one JSON object.

python tests/bench/signals.py [SIGCONT [SIGTSTP AND SIGCONT [CLOSED TERMINALS [SIGHUP AND SIGCONT]]]]

Each number is how often; two processes hog the processor meanwhile.
"""

import json
import random
import signal
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

from recordings.verification import verify
from tests.tui.pty_lab import PtyLab

NUMBERS = 2000, 500, 300, 200
AT_ONCE = 6
PATIENCE = 60.0  # s for a lab to end
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


def ended(task: tuple[str, int]) -> dict[str, int]:
    """Start a lab, close its terminal or send HUP and CONT at a random moment, and count what becomes of it."""
    way, seed = task
    chance = random.Random(seed)
    with TemporaryDirectory() as folder, PtyLab(PENDU_RECORDINGS=folder) as lab:
        lab.run(chance.uniform(0.0, 6.0))
        if way == "closed":
            lab.hang_up()
        else:
            lab.signal(signal.SIGHUP)
            lab.signal(signal.SIGCONT)
        began = lab.now
        try:
            code = lab.end(PATIENCE)
        except TimeoutError:
            return {f"{way}_still_there": 1}
        left = [*Path(folder).iterdir()]
        return {
            f"{way}_{'in_time' if lab.now - began < PATIENCE / 2 else 'late'}": 1,
            f"{way}_exit_{code}": 1,
            "recordings": sum(path.suffix == ".mcap" for path in left),
            "recordings_that_verify": sum(path.suffix == ".mcap" and verify(path).identical for path in left),
            **Counter(f"left_{path.name}" for path in left if path.suffix != ".mcap"),
        }


def main() -> None:
    """Send, look, and print."""
    continues, pairs, closings, hangups = map(int, (*sys.argv[1:], *NUMBERS[len(sys.argv) - 1 :]))
    hogs = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    try:
        report = storms(continues, pairs)
        tasks = [*(("closed", n) for n in range(closings)), *(("hung_up", n) for n in range(hangups))]
        counted = Counter[str]()
        with ThreadPoolExecutor(AT_ONCE) as pool:
            for counts in pool.map(ended, tasks):
                counted.update(counts)
    finally:
        for hog in hogs:
            hog.kill()
    print(json.dumps(report | dict(sorted(counted.items()))))


def storms(continues: int, pairs: int) -> dict[str, object]:
    """What becomes of a lab in two storms of signals."""
    with TemporaryDirectory() as folder, PtyLab(PENDU_RECORDINGS=folder) as lab:
        lab.wait_for(RECORDING)
        report: dict[str, object] = {
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
        return report


if __name__ == "__main__":
    main()
