"""What the lab costs: the real program on a pseudo-terminal, 120×40, everything moving, recording on.

Prints one JSON object.  A frame is a burst of output that redraws a pendulum; the chart and the table
come with less frequent ones.
"""

import json
import re
import sys
import tempfile
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[2]))

import itertools

from tests.tui.pty_lab import PtyLab

SECONDS = 20.0
KEYS = 30
LAB = ("live", "--h", "0.01")  # more than one step a frame, so that every frame moves
BUDGETS = {
    "cpu_percent": 25,
    "frames_per_second": 29,
    "frame_p99_ms": 45,
    "kilobytes_per_second": 250,
    "key_p95_ms": 50,
}
CURSOR = re.compile(rb"\x1b\[(\d+);(\d+)H")
PENDULUMS = 47  # columns from the left
BURST = 0.004  # s


def frames(lab: PtyLab, seconds: float) -> list[float]:
    """When frames came, in s."""
    times: list[float] = []
    end, last = lab.now + seconds, 0.0
    while lab.now < end:
        piece = lab.read(end - lab.now)
        moved = any(int(column) <= PENDULUMS and 1 < int(row) < 30 for row, column in CURSOR.findall(piece))
        if moved and lab.now - last > BURST:
            times.append(lab.now)
            last = lab.now
    return times


def key_times(lab: PtyLab, pause: float = 0.1) -> list[float]:
    """How long it takes from a key to what it does on the screen, in s."""
    times = []
    for n in range(KEYS):
        lab.run(pause + n / 300)  # anywhere in a frame
        key, effect = ("+", "h 0.02 s") if n % 2 == 0 else ("-", "h 0.01 s")
        began = lab.now
        lab.type(key)
        times.append(lab.wait_for(effect) - began)
    return sorted(times)


def measure() -> dict[str, float]:
    """Run the lab for a while."""
    with tempfile.TemporaryDirectory() as folder, PtyLab(*LAB, PENDU_RECORDINGS=folder) as lab:
        lab.wait_for("REC 2 s")
        cpu, began, sent = lab.cpu_seconds(), lab.now, len(lab.output)
        times = frames(lab, SECONDS)
        elapsed = lab.now - began
        cpu, sent = lab.cpu_seconds() - cpu, len(lab.output) - sent
        keys = key_times(lab)
        lab.type("q")
        lab.end()
    gaps = sorted(after - before for before, after in itertools.pairwise(times))
    return {
        "cpu_percent": round(100 * cpu / elapsed, 1),
        "frames_per_second": round(len(times) / elapsed, 2),
        "frame_p99_ms": round(1000 * gaps[int(0.99 * len(gaps))], 1),
        "kilobytes_per_second": round(sent / elapsed / 1000, 1),
        "key_median_ms": round(1000 * median(keys), 1),
        "key_p95_ms": round(1000 * keys[int(0.95 * len(keys))], 1),
    }


if __name__ == "__main__":
    print(json.dumps({"bench": "lab", **measure(), "budgets": BUDGETS}))
