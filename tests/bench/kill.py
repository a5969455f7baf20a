"""Kill labs at random moments while they record, and measure what is lost."""

import random
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.recordings.test_kill import kill_one

LIMITS = {"largest_loss_seconds": 1.0, "not_verified": 0}
AT_ONCE = 8


def measure(share: float) -> dict[str, Any]:
    kills = round(300 * share)
    moments = [random.uniform(0.0, 5.0) for _ in range(kills)]
    with TemporaryDirectory() as folder, ThreadPoolExecutor(AT_ONCE) as pool:
        folders = [Path(folder) / str(number) for number in range(kills)]
        outcomes = list(pool.map(kill_one, folders, moments))
    verified = [result for _, result in outcomes if result.identical]
    return {
        "kills": kills,
        "not_verified": kills - len(verified),
        "largest_loss_seconds": round(max(loss for loss, _ in outcomes), 3),
    }
