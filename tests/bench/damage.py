"""Damage recordings in every way, and see what every reader makes of it: one JSON object.

python tests/bench/damage.py [SHARE OF THE CAMPAIGN, 1 = all]
"""

import json
import sys
import time

from tests.recordings.damage import campaign


def main() -> None:
    """Run the campaign and print."""
    share = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
    began = time.perf_counter()
    done = campaign(
        cuts=max(1, round(1 / share)),
        flips=round(20_000 * share),
        others=round(2_000 * share),
        holes=round(1_000 * share),
    )
    seconds = round(time.perf_counter() - began, 1)
    print(json.dumps({"benchmark": "damage", **done, "seconds": seconds}))


if __name__ == "__main__":
    main()
