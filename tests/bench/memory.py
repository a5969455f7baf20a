"""An hour in the lab, by a clock that is moved by hand, recorded: what memory it takes.  Prints one JSON object.

Every frame is simulated and recorded; one a second is drawn.
"""

import asyncio
import json
import os
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from engine.scenes import DEFAULT_SCENE
from recordings.live_recorder import LiveRecorder
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.live import LiveScreen
from tui.screens.still import settled
from tui.terminal.options import FPS

SECONDS = 3600
SETTLED = 600  # s, after which nothing may grow: histories are full, modules are loaded
BUDGET = 120  # MB


def resident() -> float:
    """Memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


async def measure(folder: Path) -> dict[str, float]:
    """Run the hour."""
    now = 0.0
    live = Live(DEFAULT_SCENE, clock=lambda: 0.0)
    stage = LiveScreen(
        live, clock=lambda: now, prepare=lambda: live.record(LiveRecorder(folder / "hour.mcap"))
    )
    app = PenduApp(stage)
    at: dict[int, float] = {}
    async with app.run_test(size=(120, 40)) as pilot:
        for second in range(1, SECONDS + 1):
            for frame in range(FPS):
                now = second + frame / FPS
                live.tick(now)
            stage.show_now()
            await pilot.pause()
            if second in (SETTLED, SECONDS):
                await settled(app)
                at[second] = resident()
    live.close()
    return {"after_10_min_mb": round(at[SETTLED], 1), "after_60_min_mb": round(at[SECONDS], 1)}


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        result = asyncio.run(measure(Path(name)))
    print(json.dumps({"bench": "memory", **result, "budget_mb": BUDGET}))
