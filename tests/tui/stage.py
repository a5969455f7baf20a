"""A screen under test: a headless app whose clock is moved by hand."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from textual.pilot import Pilot

from engine.scenes import DEFAULT_SCENE, Scene
from recordings.recording import Recording
from tui.drawing.cells import CellWidget
from tui.playback.live import Live
from tui.playback.marks import Marks
from tui.playback.replay import Replay
from tui.screens.app import PenduApp
from tui.screens.base import SourceScreen
from tui.screens.keys import COMMON
from tui.screens.live import LiveScreen
from tui.screens.replay import ReplayScreen
from tui.screens.still import settled
from tui.terminal.options import FPS


class Theatre:
    """A running app with its stage, and a clock that stands until `run` moves it."""

    def __init__(self, make_stage: Any) -> None:
        self.now = 0.0
        self.first: SourceScreen = make_stage(lambda: self.now)
        self.app = PenduApp(self.first)
        self.pilot: Pilot[Any]

    @property
    def stage(self) -> Any:
        return self.app.source_screen

    @property
    def source(self) -> Any:
        return self.stage.source

    async def run(self, seconds: float) -> None:
        for _ in range(round(seconds * FPS)):
            self.now += 1 / FPS
            self.source.tick(self.now)
        self.stage.show_now()
        await self.pilot.pause()

    async def press(self, *keys: str) -> None:
        await self.pilot.press(*keys)

    def text(self, widget: type[CellWidget] | str) -> str:
        """What the first such widget on the stage shows."""
        return self.stage.query(widget).first(CellWidget).text

    async def settled(self) -> None:
        await settled(self.app)


def key_of(view: str) -> str:
    """The key that shows a view, as Textual calls it."""
    return next(key.names for key in COMMON if key.action == f"view({view!r})")


@asynccontextmanager
async def on_stage(make_stage: Any, size: tuple[int, int]) -> AsyncIterator[Theatre]:
    theatre = Theatre(make_stage)
    async with theatre.app.run_test(size=size) as theatre.pilot:
        await theatre.pilot.pause()
        theatre.source.tick(0.0)
        yield theatre


def lab(scene: Scene = DEFAULT_SCENE, size: tuple[int, int] = (120, 40)) -> Any:
    """A lab on stage."""
    return on_stage(lambda clock: LiveScreen(Live(scene, clock=lambda: 0.0), clock), size)


def player(path: Path, size: tuple[int, int] = (120, 40)) -> Any:
    """A replay on stage; going live from it is not recorded."""

    def make(clock: Any) -> SourceScreen:
        replay = Replay(Recording.open(path), Marks(path), clock=lambda: 0.0)
        return ReplayScreen(replay, lambda live: LiveScreen(live, clock), clock)

    return on_stage(make, size)
