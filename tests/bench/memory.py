"""The memory of an hour in the lab with everything on, by a clock that is moved by hand.

Six methods, one of them the user's own, a ghost and a recording.  Every frame is simulated and
recorded; once a second one is drawn, by turns in each view, and once a minute h changes.
"""

import asyncio
import gc
import os
from itertools import cycle
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

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

LIMITS = {"growth_mb": 4.0}  # after a sixth of the time, when histories are full
OWN = """
def mine(force, phase, h):
    theta, omega = phase
    while True:
        omega = omega + h * force(theta)
        theta = theta + h * omega
        yield theta, omega
"""


def resident() -> float:
    """Return the memory of this process [MB]."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


async def run(folder: Path, minutes: int) -> list[float]:
    """Return the memory [MB] after each sixth of the time."""
    now = 0.0
    own = load(OWN, "mine", "m", "mine.py")
    live = Live(DEFAULT_SCENE.with_cast((*METHODS[:5], own)), clock=lambda: 0.0)
    live.laid_under = open_ghost(resolve("drift"))
    stage = LiveScreen(
        live, clock=lambda: now, prepare=lambda: live.record(LiveRecorder(folder / "hour.mcap"))
    )
    memory = []
    views = cycle(f"f{number}" for number, _ in enumerate(VIEWS, 2))
    async with PenduApp(stage).run_test(size=(120, 40)) as pilot:
        for second in range(1, 60 * minutes + 1):
            for frame in range(FPS):
                now = second + frame / FPS
                live.tick(now)
            if second % 10 == 0:
                await pilot.press(next(views))
            stage.show_now()
            await pilot.pause()
            if second % 60 == 0:
                await pilot.press("plus" if second % 120 else "minus")
            if second % (10 * minutes) == 0:
                memory.append(round(resident(), 1))
    live.close()
    return memory


def measure(share: float) -> dict[str, Any]:
    with TemporaryDirectory() as folder:
        memory = asyncio.run(run(Path(folder), round(60 * share)))
    return {"memory_mb": memory, "growth_mb": round(memory[-1] - memory[0], 1)}
