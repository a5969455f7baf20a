"""The shell command that brings back what is on the screen."""

import shlex

from engine.scenes import DEFAULT_SCENE, LIMITS, SCENES, Scene
from tui.playback.live import Live
from tui.playback.replay import Replay
from tui.playback.source import Source


def command(source: Source) -> str:
    """For a lab, its scene; for a replay, or once the step size has changed, this moment of the recording.

    A lab that changed its step size and does not record can only be started again from its scene.
    """
    if isinstance(source, Replay):
        return _moment(str(source.recording.path), source.playhead.position)
    if _changed(source) and isinstance(source, Live) and source.recorder is not None:
        return _moment(str(source.recorder.path), source.recorder.seconds)
    speed = () if source.playhead.speed == 1 else ("--speed", f"{source.playhead.speed:g}")
    return shlex.join(["pendu-tui", "live", *scene_arguments(source.scene), *speed])


def reproduces(source: Source) -> bool:
    """Whether the command brings back all: not a change of the step size that no file holds."""
    return isinstance(source, Replay) or not _changed(source) or source.recording_status is not None


def _changed(source: Source) -> bool:
    return any(event.kind == "set_h" and event.run == source.sample.run for event in source.events)


def _moment(file: str, position: float) -> str:
    return shlex.join(["pendu-tui", "replay", file, "--start-at", f"{position:.9g}", "--paused"])


def scene_arguments(scene: Scene) -> list[str]:
    """The options that reproduce a scene to the last bit."""
    if SCENES.get(scene.name) == scene:
        return ["--scene", scene.name]
    changes = {name: getattr(scene, name) for name in (*LIMITS, "h")}
    changes = {name: value for name, value in changes.items() if value != getattr(DEFAULT_SCENE, name)}
    return [part for name, value in changes.items() for part in (f"--{name}", repr(value))]
