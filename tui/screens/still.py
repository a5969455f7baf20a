"""A picture of the lab, and a film of a replay: the same every time, because the clock is moved by hand."""

import asyncio
import re
from collections.abc import Callable, Sequence

from textual.strip import Strip
from textual.widget import Widget

from engine.scenes import Scene
from tui.playback.frame_rate import FrameTimer, Timer
from tui.playback.live import Live
from tui.playback.replay import Replay
from tui.screens.app import PenduApp
from tui.screens.live import LiveScreen
from tui.screens.replay import ReplayScreen
from tui.terminal.options import FPS, USUAL, TerminalOptions

PATIENCE = 30.0  # s for the charts to be built


async def still(
    scene: Scene, seconds: float, size: tuple[int, int], terminal: TerminalOptions = USUAL, keys: Sequence[str] = ()
) -> str:
    """The lab as an SVG picture, `seconds` after the start and `keys` pressed since."""
    now = 0.0
    live = Live(scene, clock=lambda: 0.0)
    screen = LiveScreen(live, clock=lambda: now)
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


class _Filmed(PenduApp):
    interrupted = False

    def interrupt(self) -> None:
        """Note a signal: whoever films cleans up."""
        self.interrupted = True


class _Never(Timer):
    """A timer that calls for no frame."""

    def stop(self) -> None:
        pass


async def film(
    replay: Replay,
    frames: int,
    size: tuple[int, int],
    terminal: TerminalOptions,
    take: Callable[[int, list[Strip]], None],
) -> None:
    """Play so many frames, `terminal.fps` a second, and hand each with its number to `take`, as the screen's rows.

    Raises KeyboardInterrupt where a signal asks for an end.
    """
    now = 0.0
    screen = ReplayScreen(replay, lambda live: LiveScreen(live), clock=lambda: now)
    screen._timer = FrameTimer(lambda _: _Never())
    app = _Filmed(screen, terminal=terminal)
    async with app.run_test(size=size) as pilot:
        await pilot.pause()
        for frame in range(frames):
            now = frame / terminal.fps
            replay.tick(now)
            screen.show_now()
            await pilot.pause(0)
            await settled(app)
            await pilot.pause(0)
            if app.interrupted:
                raise KeyboardInterrupt
            take(frame, screen._compositor.render_strips())


async def settled(app: PenduApp) -> None:
    """Wait until every pane shows the newest data."""
    async with asyncio.timeout(PATIENCE):
        while not all(_is_settled(pane) for pane in app.source_screen.query("#views *").results(Widget)):
            await asyncio.sleep(0.01)


def _is_settled(pane: Widget) -> bool:
    shown = getattr(pane, "drawable", True) or not pane.is_on_screen  # else it is still to hear that it is shown
    return shown and getattr(pane, "settled", True)


def normalised(svg: str) -> str:
    """The picture without the random number in Rich's names."""
    return re.sub(r"terminal-\d+-", "terminal-", svg)
