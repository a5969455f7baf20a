"""Labs and replays under test, with or without a screen; their clock moves only in `run`."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from textual.pilot import Pilot

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES, Scene
from pendu_tui.recordings.recorder import LiveRecorder
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.commands.lab import settled
from pendu_tui.tui.drawing.cells import CellWidget
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.source import Playhead, Source
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.terminal.options import FPS
from pendu_tui.tui.views import VIEWS

PATIENCE = 120  # s


class Clocked:
    """A source and its clock."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.now = 0.0
        source.tick(0.0)

    def run(self, seconds: float) -> Sample:
        for _ in range(round(seconds * FPS)):
            self.now += 1 / FPS
            self.source.tick(self.now)
        return self.source.sample


class Lab(Clocked):
    """A lab without a screen; `record`: a file, or anything with the methods of a LiveRecorder."""

    def __init__(
        self,
        scene: Scene = DEFAULT_SCENE,
        speed: float = 1.0,
        record: Any = None,
        work_clock: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self.live = Live(scene, speed, clock=work_clock)
        if isinstance(record, Path):
            record = LiveRecorder(record)
        if record is not None:
            self.live.record(record)
        super().__init__(self.live)


def after(scene: Scene, seconds: float) -> Live:
    """Return a lab that has run for some seconds."""
    lab = Lab(scene)
    lab.run(seconds)
    return lab.live


def recorded(
    path: Path, *acts: float | Callable[[Live], object], scene: Scene = DEFAULT_SCENE
) -> Path:
    """Record a lab: numbers are seconds to run, functions are applied to it."""
    lab = Lab(scene, record=path)
    for act in acts:
        if callable(act):
            act(lab.live)
        else:
            lab.run(act)
    lab.live.close()
    return path


def eventful(path: Path) -> Path:
    """Record two runs with changes, a mark and steps back: 12 s of the recording clock."""
    path.write_bytes(_eventful())
    return path


@cache
def _eventful() -> bytes:
    acts = (
        2.0,
        lambda live: live.change(Stepping(0.1)),
        2.0,
        lambda live: live.mark("here"),
        lambda live: live.change(Stepping(-0.1)),
        1.0,
        lambda live: live.start(SCENES["spin"]),
        4.0,
        lambda live: live.step(-40),
        lambda live: live.change(Stepping(0.05)),
        lambda live: live.pause(False),
        3.0,
    )
    with TemporaryDirectory() as folder:
        return recorded(Path(folder, "eventful.mcap"), *acts).read_bytes()


class Theatre:
    """A running app with its screen."""

    def __init__(self, make_stage: Any) -> None:
        self.now = 0.0
        self.first: LabScreen = make_stage(lambda: self.now)
        self.app = PenduApp(self.first)
        self.pilot: Pilot[Any]

    @property
    def stage(self) -> Any:
        return self.app.lab

    @property
    def source(self) -> Any:
        return self.stage.source

    @property
    def sample(self) -> Sample:
        return self.source.sample

    @property
    def scene(self) -> Scene:
        return self.source.scene

    @property
    def playhead(self) -> Playhead:
        return self.source.playhead

    async def run(self, seconds: float) -> None:
        for _ in range(round(seconds * FPS)):
            self.now += 1 / FPS
            self.source.tick(self.now)
        self.stage.show_now()
        await self.pilot.pause()

    def frames(self, count: int = 1, seconds: float = 1 / FPS) -> None:
        """Let the timer of frames ring so often, each time after so many seconds."""
        for _ in range(count):
            self.now += seconds
            self.stage.frame()

    async def press(self, *keys: str) -> None:
        for key in keys:
            await self.pilot.press(key)
            await self.pilot.pause()

    async def click(self, target: Any, *offset: int, **options: Any) -> None:
        await self.pilot.click(target, offset=offset or (0, 0), **options)
        await self.pilot.pause()

    @property
    def notices(self) -> list[str]:
        return [each.message for each in self.app._notifications]

    def pane(self, widget: type[CellWidget] | str) -> Any:
        """Return the only such widget on the screen."""
        return self.stage.query_one(widget)

    def text(self, widget: type[CellWidget] | str) -> str:
        """Return the text of the first such widget on the screen."""
        return self.stage.query(widget).first(CellWidget).text

    async def settled(self) -> None:
        await settled(self.app)


def key_of(view: str) -> str:
    """Return the key that shows a view, as Textual calls it."""
    return f"f{2 + list(VIEWS).index(view)}"


@asynccontextmanager
async def on_stage(make_stage: Any, size: tuple[int, int]) -> AsyncIterator[Theatre]:
    theatre = Theatre(make_stage)
    async with theatre.app.run_test(size=size) as theatre.pilot:
        for _ in range(2):  # the second begins after the first paint
            await theatre.pilot.pause()
        theatre.source.tick(0.0)
        yield theatre
        theatre.app.finish()


def lab(scene: Scene = DEFAULT_SCENE, size: tuple[int, int] = (120, 40)) -> Any:
    """A lab on screen."""
    return on_stage(lambda clock: LabScreen(Live(scene, clock=lambda: 0.0), clock), size)


def player(path: Path, size: tuple[int, int] = (120, 40)) -> Any:
    """A replay on screen; going live from it is not recorded."""
    replay = Replay(Recording.open(path), clock=lambda: 0.0)
    return on_stage(lambda clock: LabScreen(replay, clock), size)


async def until(pilot: Pilot[Any], condition: Callable[[], object]) -> None:
    """Wait for something computed in the background."""
    async with asyncio.timeout(PATIENCE):
        while not condition():
            await pilot.pause(0.05)


@asynccontextmanager
async def view_of(
    key: str,
    kind: type[Any],
    complete: Callable[[Any], bool],
    scene: Scene = DEFAULT_SCENE,
    size: tuple[int, int] = (80, 24),
) -> AsyncIterator[tuple[Pilot[Any], Any, Live]]:
    """Show a view of a paused lab by its key; yield its pane once it is complete."""
    live = Live(scene)
    live.pause(True)
    async with on_stage(lambda clock: LabScreen(live), size) as theatre:
        await theatre.press(key)
        pane = theatre.stage.query_one(kind)
        await until(theatre.pilot, lambda: complete(pane))
        pane.draw()
        yield theatre.pilot, pane, live
