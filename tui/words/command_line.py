"""The shell command that reproduces what is on the screen."""

import math
import shlex

from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES, Scene
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.source import Source


def command(source: Source) -> str:
    """Return the command for a lab's start or, in a replay or after a change of h, for the moment.

    Without a recording, a change of h cannot be reproduced.
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
    """Return whether the command reproduces everything: an unrecorded change of h is lost."""
    status = source.recording_status
    is_recorded = status is not None and not status.failed
    return is_recorded or _start_h(source) is not None


def _start_h(source: Source) -> float | None:
    """Return the h [s] of a scene that steps like this from its start; None if h changed."""
    if any(0 < change.step <= source.sample.step for change in source.changes):
        return None
    stepping = source.stepping
    # a scene's h is positive
    for h in (source.scene.h, stepping.smallest):
        if stepping._replace(h=1.0).with_smallest(h) == stepping:
            return h
    return None


def _moment(file: str, position: float) -> str:
    return shlex.join(["pendu-tui", "replay", file, "--start-at", f"{position:.9g}", "--paused"])


def _listed(scene: Scene) -> Scene:
    """Return the listed scene of this name, else the first of this model."""
    candidates = [SCENES.get(scene.name), *SCENES.values()]
    return next((each for each in candidates if each and each.model == scene.model), DEFAULT_SCENE)


def scene_arguments(scene: Scene) -> list[str]:
    """Return the options that reproduce a scene to the last bit, with the user's own methods."""
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
