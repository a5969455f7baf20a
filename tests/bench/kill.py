"""Kill labs while they record, at random moments, and see what is left: one JSON object.

python tests/bench/kill.py [NUMBER OF KILLS [PROCESSES THAT HOG THE PROCESSOR]]
"""

import json
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.recordings.test_kill import kill_one

KILLS = 300
AT_ONCE = 8


def main() -> None:
    """Kill, rescue, verify and print."""
    kills = int(sys.argv[1]) if len(sys.argv) > 1 else KILLS
    chance = random.Random()
    hogs = [
        subprocess.Popen([sys.executable, "-c", "while True: pass"])
        for _ in range(int((sys.argv + ["0"] * 2)[2]))
    ]
    moments = [chance.uniform(0.0, 5.0) for _ in range(kills)]
    try:
        with TemporaryDirectory() as folder, ThreadPoolExecutor(AT_ONCE) as pool:
            folders = (Path(folder) / str(i) for i in range(kills))
            outcomes = list(pool.map(kill_one, folders, moments))
    finally:
        for hog in hogs:
            hog.kill()
    losses = [loss for loss, _ in outcomes]
    print(
        json.dumps(
            {
                "benchmark": "kill",
                "kills": kills,
                "hogs": len(hogs),
                "verified": sum(
                    verification.identical and verification.complete for _, verification in outcomes
                ),
                "largest_loss_seconds": round(max(losses), 3),
                "smallest_loss_seconds": round(min(losses), 3),
            }
        )
    )


if __name__ == "__main__":
    main()
