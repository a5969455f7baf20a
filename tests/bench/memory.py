"""An hour in the lab with everything on, by a clock that is moved by hand: what memory it takes.  Prints one JSON object.

Six methods, one of them the user's own, a ghost and a recording.  Every frame is simulated and
recorded; once a second one is drawn, by turns in each view, and once a minute h changes.
"""

import asyncio
import gc
import json
import os
import sys
import tempfile
from itertools import cycle
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from engine.methods import METHODS
from engine.methods.examine import load
from engine.scenes import DEFAULT_SCENE
from recordings.recorder import LiveRecorder
from tui.cli.options import resolve
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.launch import open_ghost
from tui.screens.live import LiveScreen
from tui.terminal.options import FPS
from tui.views import VIEWS

MINUTES = 60
SETTLED = 10  # min, after which histories are full and modules are loaded
MAX_GROWTH = 4.0  # MB from then on: 2.3 measured, of them 0.7 the index of the recording
OWN = """
def mine(force, phase, h):
    theta, omega = phase
    while True:
        omega = omega + h * force(theta)
        theta = theta + h * omega
        yield theta, omega
"""


def resident() -> float:
    """Memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


async def measure(folder: Path) -> dict[int, float]:
    """Run the hour; returns the memory [MB] after each ten minutes."""
    now = 0.0
    own = load(OWN, "mine", "m", "mine.py")
    live = Live(DEFAULT_SCENE.with_cast((*METHODS[:5], own)), clock=lambda: 0.0)
    live.laid_under = open_ghost(resolve("drift"))
    stage = LiveScreen(
        live, clock=lambda: now, prepare=lambda: live.record(LiveRecorder(folder / "hour.mcap"))
    )
    app = PenduApp(stage)
    at: dict[int, float] = {}
    views = cycle(f"f{number}" for number, _ in enumerate(VIEWS, 2))
    async with app.run_test(size=(120, 40)) as pilot:
        for second in range(1, 60 * MINUTES + 1):
            for frame in range(FPS):
                now = second + frame / FPS
                live.tick(now)
            if second % 10 == 0:
                await pilot.press(next(views))
            stage.show_now()
            await pilot.pause()
            if second % 60 == 0:
                await pilot.press("plus" if second % 120 else "minus")
            if second % 600 == 0:
                gc.collect()
                at[second // 60] = round(resident(), 1)
                print(at, file=sys.stderr, flush=True)
    live.close()
    return at


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        at = asyncio.run(measure(Path(name)))
    growth = round(at[MINUTES] - at[SETTLED], 1)
    report = {"mb_after_minutes": at, "growth_mb": growth, "max_growth_mb": MAX_GROWTH}
    print(json.dumps({"bench": "memory", **report}))
