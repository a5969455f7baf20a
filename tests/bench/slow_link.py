"""The lab at 5 frames a second on a slow line: how long a key takes to be seen, and whether time goes on as it should.

The real program on a pseudo-terminal of 120×40 that takes 64 KiB/s.  Prints one JSON object.
"""

import json
import re
import sys
import tempfile
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.bench.yardstick import LAB, key_times
from tests.tui.pty_lab import PtyLab

RATE = 64 * 1024  # bytes/s
VIEWS = {"lab": "\x1bOQ", "phase": "\x1bOR", "accuracy": "\x1bOS", "stability": "\x1b[15~"}
SETTLED, SECONDS = (
    4.0,
    10.0,
)  # s until a view has been painted; and of simulated time that are compared
BUDGETS = {"key_max_ms": 1000, "time_slip_ms": 1000}
TIME = re.compile(rb"t (\d+\.\d+) s")


def slip(lab: PtyLab) -> float:
    """How far simulated time, as one reads it, and ours have come apart in a while, in s."""

    def read() -> float:
        start = len(lab.output)
        while not (times := TIME.findall(lab.output, start)):
            lab.read(1.0)
        return lab.now - float(times[-1])

    before = read()
    lab.run(SECONDS)
    return abs(read() - before)


def measure(key: str) -> dict[str, float]:
    """Look at a view for a while."""
    with (
        tempfile.TemporaryDirectory() as folder,
        PtyLab(*LAB, "--fps", "5", rate=RATE, PENDU_RECORDINGS=folder) as lab,
    ):
        lab.wait_for("REC 2 s")
        lab.type(key)
        lab.run(SETTLED)
        began, sent = lab.now, len(lab.output)
        slipped = slip(lab)
        rate = (len(lab.output) - sent) / (lab.now - began)
        keys = key_times(lab, 0.2)
        lab.type("q")
        lab.end()
    return {
        "key_median_ms": round(1000 * median(keys)),
        "key_p95_ms": round(1000 * keys[int(0.95 * len(keys))]),
        "key_max_ms": round(1000 * keys[-1]),
        "time_slip_ms": round(1000 * slipped),
        "kilobytes_per_second": round(rate / 1000, 1),
    }


if __name__ == "__main__":
    views = {name: measure(key) for name, key in VIEWS.items()}
    print(json.dumps({"bench": "slow_link", "views": views, "budgets": BUDGETS}))
