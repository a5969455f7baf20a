"""Process start to first painted lab, 120×40, and what the imports take.  Prints one JSON object."""

import json
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.tui.pty_lab import PtyLab

BUDGET = 0.40  # s
TIMES = 10
LAST_ON_SCREEN = "Quit"  # of the key line, which is painted last


def first_paint() -> float:
    """s from the start of the process to the last line of the first picture."""
    with PtyLab("live", "--no-record") as lab:
        seconds = lab.wait_for(LAST_ON_SCREEN)
        lab.type("q")
        lab.end()
    return seconds


def import_milliseconds(modules: str) -> float:
    """What `import modules` adds to a bare interpreter, at best."""

    def run(code: str) -> float:
        timed = f"import time; t = time.perf_counter(); {code}; print(time.perf_counter() - t)"
        return min(
            float(subprocess.run([sys.executable, "-c", timed], capture_output=True, check=True).stdout)
            for _ in range(3)
        )

    return round(1000 * run(f"import {modules}"), 1)


if __name__ == "__main__":
    times = sorted(first_paint() for _ in range(TIMES))
    print(
        json.dumps(
            {
                "bench": "startup",
                "first_paint_seconds": {"best": round(times[0], 3), "median": round(times[TIMES // 2], 3)},
                "budget_seconds": BUDGET,
                "within_budget": times[0] <= BUDGET,
                "import_milliseconds": {
                    name: import_milliseconds(name)
                    for name in (
                        "numpy",
                        "textual.app",
                        "tui.playback.live",
                        "tui.screens.app, tui.screens.live",
                        "plotext",
                        "mcap.writer",
                    )
                },
            }
        )
    )
