"""A recorded sitting, made as the lab makes one, with a clock that is moved by hand."""

from collections.abc import Callable
from pathlib import Path

from engine.run.stepping import Stepping
from engine.scenes import DEFAULT_SCENE, SCENES, Scene
from recordings.live_recorder import LiveRecorder
from tui.playback.live import Live

FPS = 30


class Sitting:
    """A lab that records into a file; `run` lets it run."""

    def __init__(self, path: Path, scene: Scene = DEFAULT_SCENE) -> None:
        self.now = 0.0
        self.live = Live(scene, clock=lambda: 0.0)
        self.live.record(LiveRecorder(path, wall=lambda: 1_700_000_000_000_000_000))
        self.live.tick(0.0)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds * FPS)):
            self.now += 1 / FPS
            self.live.tick(self.now)


def recorded(path: Path, *acts: float | Callable[[Live], object], scene: Scene = DEFAULT_SCENE) -> Path:
    """Record a sitting: numbers are seconds to run, functions are done to the lab."""
    sitting = Sitting(path, scene)
    for act in acts:
        if callable(act):
            act(sitting.live)
        else:
            sitting.run(act)
    sitting.live.close()
    return path


def eventful(path: Path) -> Path:
    """Two runs and a bit of everything: 12 s of the recording clock."""
    return recorded(
        path,
        2.0,
        lambda live: live.set_stepping(Stepping(0.1)),
        2.0,
        lambda live: live.mark("here"),
        lambda live: live.set_stepping(Stepping(-0.1)),
        1.0,
        lambda live: live.start(SCENES["spin"]),
        4.0,
        lambda live: live.step(-40),
        lambda live: live.set_stepping(Stepping(0.05)),
        lambda live: live.pause(False),
        3.0,
    )
