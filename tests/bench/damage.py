"""Damage recordings: every reader notices the damage or reads what was recorded."""

from typing import Any

from tests.recordings.damage import campaign

LIMITS = {"unnoticed": 0}


def measure(share: float) -> dict[str, Any]:
    return campaign(
        cuts=round(1 / share),
        flips=round(20_000 * share),
        others=round(2_000 * share),
        holes=round(1_000 * share),
    )
