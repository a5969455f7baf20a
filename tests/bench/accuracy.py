"""How long `pendu-tui accuracy` takes from the command line to the chart: one JSON object.

With its defaults, and with every run compiled and timed (`--cost seconds`, where Numba is installed).
"""

import json
import subprocess
import sys
import time
from pathlib import Path

from engine.run.compiled import available

REPEATS = 3
LIMITS = {"plain": 5.0, "compiled": 2.0}  # s
RUNS = {
    "defaults": ["--no-compiled"],
    "defaults, Numba where it pays": [],
    "seconds as cost": ["--cost", "seconds", "--no-compiled"],
    "seconds as cost, all compiled": ["--cost", "seconds"],
}


def seconds(arguments: list[str]) -> float:
    """The shortest of several runs of the program [s]."""
    program, best = str(Path(sys.executable).with_name("pendu-tui")), float("inf")
    for _ in range(REPEATS):
        began = time.perf_counter()
        told = subprocess.run(
            [program, "accuracy", *arguments], check=True, capture_output=True, text=True
        )
        best = min(best, time.perf_counter() - began)
        assert "force evaluations" in told.stdout
    return best


def main() -> None:
    """Measure and print."""
    measured = {name: seconds(arguments) for name, arguments in RUNS.items()}
    limits = {
        name: LIMITS["plain" if "--no-compiled" in arguments or not available() else "compiled"]
        for name, arguments in RUNS.items()
    }
    passed = all(measured[name] <= limits[name] for name in RUNS)
    print(
        json.dumps(
            {"bench": "accuracy", "seconds": measured, "limits": limits, "pass": passed}, indent=1
        )
    )


if __name__ == "__main__":
    main()
