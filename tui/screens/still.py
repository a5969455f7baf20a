"""Pictures of the lab, always the same because the clock is moved by hand."""

import asyncio
from collections.abc import Sequence

from textual.widget import Widget

from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.drawing.cells import CellWidget
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.screens.svg import normalised
from pendu_tui.tui.terminal.options import FPS, USUAL, TerminalOptions


async def still(
    scene: Scene,
    seconds: float,
    size: tuple[int, int],
    terminal: TerminalOptions = USUAL,
    keys: Sequence[str] = (),
) -> str:
    """Return the lab as an SVG picture, `seconds` after the start, with `keys` pressed then."""
    now = 0.0
    live = Live(scene, clock=lambda: 0.0)
    screen = LabScreen(live, clock=lambda: now)
    app = PenduApp(screen, terminal=terminal)
    async with app.run_test(size=size) as pilot:
        for frame in range(round(seconds * FPS) + 1):
            now = frame / FPS
            live.tick(now)
        screen.show_now()
        await pilot.press(*keys)
        await settled(app)
        await pilot.pause()
        return normalised(app.export_screenshot())


async def settled(app: PenduApp) -> None:
    panes = app.lab.query("#views *").results
    async with asyncio.timeout(30):
        while not all(map(_is_settled, panes(Widget))):
            await asyncio.sleep(0.01)
    for pane in panes(CellWidget):
        pane.draw()


def _is_settled(pane: Widget) -> bool:
    # a pane on screen that is not drawable does not know its size yet
    is_shown = getattr(pane, "drawable", True) or not pane.is_on_screen
    return is_shown and getattr(pane, "settled", True)
