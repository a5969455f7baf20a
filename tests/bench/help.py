"""How long `pendu-tui --help` takes, process start to end, and which heavy packages it loads: one JSON object."""

import json
import subprocess
import sys
import time
from pathlib import Path
from statistics import median

REPEATS = 21
HEAVY = {"textual", "numpy", "rich", "plotext", "mcap", "numba"}
LOADED = f"import sys; from tui.cli.dispatch import main; main(['--help']); print(*{HEAVY} & set(sys.modules))"


def seconds(command: list[str]) -> float:
    """How long the command takes [s]."""
    began = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - began


def main() -> None:
    """Measure and print."""
    program = str(Path(sys.executable).with_name("pendu-tui"))
    helps = [seconds([program, "--help"]) for _ in range(REPEATS)]
    bare = [seconds([sys.executable, "-c", "pass"]) for _ in range(REPEATS)]
    loaded = subprocess.run(
        [sys.executable, "-c", LOADED], check=True, capture_output=True, text=True
    )
    print(
        json.dumps(
            {
                "bench": "help",
                "seconds_min": min(helps),
                "seconds_median": median(helps),
                "python_alone_min": min(bare),
                "ratio": round(min(helps) / min(bare), 2),
                "reach": 6.0,
                "heavy_packages": loaded.stdout.splitlines()[-1].split(),
            }
        )
    )


if __name__ == "__main__":
    main()
