"""The shell command that brings back what is on the screen."""

import math
import shlex

from engine.methods.own import OwnMethod
from engine.scenes import DEFAULT_SCENE, SCENES, Scene
from tui.playback.live import Live
from tui.playback.replay import Replay
from tui.playback.source import Source


def command(source: Source) -> str:
    """Return the start of a lab; of a replay, or after a change of h, the moment of the recording.

    A lab that changed its step size on the way and does not record can only be started again.
    """
    scene = source.scene
    if isinstance(source, Replay):
        return _moment(str(source.recording.path), source.playhead.position)
    h = _start_h(source)
    if h is None and isinstance(source, Live) and source.recorder and reproduces(source):
        return _moment(str(source.recorder.path), source.recorder.seconds)
    if h is not None and h != scene.h:
        scene = scene.altered(h=h)
    first = [change.stepping for change in source.changes if change.step == 0][-1]
    arguments = scene_arguments(scene)
    if first.equal_cost:
        arguments.append("--equal-cost")
    if source.playhead.speed != _listed(scene).speed:
        arguments += ["--speed", f"{source.playhead.speed:g}"]
    return shlex.join(["pendu-tui", "live", *arguments])


def reproduces(source: Source) -> bool:
    """Return whether the command brings back all: not a change of h that no file holds."""
    status = source.recording_status
    is_recorded = status is not None and not status.failed
    return is_recorded or _start_h(source) is not None


def _start_h(source: Source) -> float | None:
    """Return the h [s] of a scene that steps like this from its start on; None if h has changed."""
    if any(0 < change.step <= source.sample.step for change in source.changes):
        return None
    stepping = source.stepping
    # a scene's h is positive: time does not run back from its start
    for h in (source.scene.h, stepping.smallest):
        if stepping._replace(h=1.0).with_smallest(h) == stepping:
            return h
    return None


def _moment(file: str, position: float) -> str:
    return shlex.join(["pendu-tui", "replay", file, "--start-at", f"{position:.9g}", "--paused"])


def _listed(scene: Scene) -> Scene:
    """The listed scene of its name, or else the first of its model."""
    candidates = [SCENES.get(scene.name), *SCENES.values()]
    return next((each for each in candidates if each and each.model == scene.model), DEFAULT_SCENE)


def scene_arguments(scene: Scene) -> list[str]:
    """The options that reproduce a scene to the last bit, a user's own methods from their files."""
    base = _listed(scene)
    arguments = ["--scene", base.name]
    for name, value in scene.numbers.items():
        if value != base.numbers.get(name):
            unit = "rad" if name == "theta" and abs(value) > math.tau else ""  # or it is refused
            arguments += [f"--{name.replace('_', '-')}", f"{value!r}{unit}"]
    if scene.cast != base.cast:
        arguments += ["--methods", ",".join(method.key for method in scene.cast)]
    for method in scene.cast:
        if isinstance(method, OwnMethod):
            arguments += ["--method", f"{method.file}:{method.key}"]
    return arguments
