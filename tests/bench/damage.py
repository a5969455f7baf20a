"""Damage recordings in every way, and see what every reader makes of it: one JSON object.

python tests/bench/damage.py [cuts|flips|holes ...]
"""

import json
import sys
import time

from tests.recordings.damage import campaign


def main() -> None:
    """Run these parts of the campaign, or all, and print."""
    parts = sys.argv[1:] or ["cuts", "flips", "holes"]
    began = time.perf_counter()
    done = campaign(
        cuts=int("cuts" in parts),
        flips=20_000 * ("flips" in parts),
        others=2_000 * ("flips" in parts),
        holes=1_000 * ("holes" in parts),
    )
    seconds = round(time.perf_counter() - began, 1)
    print(json.dumps({"benchmark": "damage", **done, "seconds": seconds}))


if __name__ == "__main__":
    main()
