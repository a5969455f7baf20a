"""What phase space costs in the real program on a pseudo-terminal: processor time, bytes, and repaints of a drag.

Prints one JSON object.  Run it on a machine that has nothing else to do.
"""

import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.tui.pty_lab import PtyLab

SECONDS = 10.0
MOVES = 60
F3 = "\x1bOR"
BUDGETS = {  # shares of a core, s
    "lab_120x40": 0.28,
    "full_200x60_ring_trails": 0.35,
    "drag_p95": 0.035,
}


def lab(folder: str, size: tuple[int, int], *keys: str) -> PtyLab:
    """A lab that records, after the keys and some seconds."""
    lab = PtyLab("live", "--record", str(Path(folder) / "bench.mcap"), size=size)
    lab.wait_for("Quit")
    lab.run(1.0)
    for key in keys:
        lab.type(key)
        lab.run(0.3)
    lab.run(2.0)
    return lab


def running(size: tuple[int, int], *keys: str) -> dict[str, float]:
    """Share of a core, and kB/s to the terminal, while the lab runs."""
    with TemporaryDirectory() as folder, lab(folder, size, *keys) as program:
        cpu, sent, began = program.cpu_seconds(), len(program.output), time.monotonic()
        program.run(SECONDS)
        seconds = time.monotonic() - began
        result = {
            "core": round((program.cpu_seconds() - cpu) / seconds, 3),
            "kB_per_second": round((len(program.output) - sent) / 1000 / seconds, 1),
        }
        program.type("q")
        program.end()
    return result


def drag(size: tuple[int, int], *keys: str) -> list[float]:
    """s from each move of the pointer to the last byte of the repaint, the lab paused."""
    with TemporaryDirectory() as folder, lab(folder, size, *keys, " ") as program:
        columns, rows = size
        program.type(f"\x1b[<0;{columns // 2};{rows // 3}M")
        program.run(0.5)
        times = []
        for move in range(MOVES):
            began = program.now
            program.type(f"\x1b[<32;{columns // 2 + move % 20};{rows // 3 + move % 7}M")
            last = began
            while program.read(0.06):
                last = program.reads[-1][0]
            times.append(last - began)
        program.type("q")
        program.end()
    return sorted(times)


if __name__ == "__main__":
    moves = drag((200, 60), F3)
    measured = {
        "lab_120x40": running((120, 40)),
        "lab_80x24_phase_hidden": running((80, 24)),
        "full_200x60_ring_trails": running((200, 60), F3),
        "drag_200x60_milliseconds": {
            "median": round(1000 * moves[len(moves) // 2], 1),
            "p95": round(1000 * moves[int(0.95 * len(moves))], 1),
        },
    }
    within = (
        measured["lab_120x40"]["core"] <= BUDGETS["lab_120x40"]
        and measured["full_200x60_ring_trails"]["core"] <= BUDGETS["full_200x60_ring_trails"]
        and moves[int(0.95 * len(moves))] <= BUDGETS["drag_p95"]
    )
    print(json.dumps({"bench": "phase", **measured, "budgets": BUDGETS, "within_budget": within}))
