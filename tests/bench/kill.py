"""Kill labs at random moments while they record, and measure what is lost."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.recordings.test_kill import kill_many

LIMITS = {"largest_loss_seconds": 1.0, "not_verified": 0}


def measure(share: float) -> dict[str, Any]:
    kills = round(300 * share)
    with TemporaryDirectory() as folder:
        outcomes = kill_many(Path(folder), kills)
    return {
        "kills": kills,
        "not_verified": sum(not verification.identical for _, verification in outcomes),
        "largest_loss_seconds": round(max(loss for loss, _ in outcomes), 3),
    }
