"""The lab: methods side by side, their errors over time, and a recording."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.cast import check_fits
from pendu_tui.tui.cli.scene import scene_of

if TYPE_CHECKING:
    from pendu_tui.tui.playback.lesson import Lesson
    from pendu_tui.tui.playback.live import Live


def lab_of(scene: Scene, options: argparse.Namespace) -> "Live":
    """Return a lab of the scene.  Raises SceneError for a step too large at equal cost."""
    from pendu_tui.tui.playback.live import Live

    live = Live(scene, options.speed or scene.speed)
    if options.equal_cost:
        live.change(live.stepping.toggled())
    return live


def run(options: argparse.Namespace) -> int:
    from pendu_tui.tui.screens import launch

    scene = scene_of(options, lesson=True)
    check_fits(scene.cast)
    launch.check(options)
    live = lab_of(scene, options)
    name = options.scene or options.scene_option or ""
    lesson = None
    if name.endswith(".toml"):
        lesson = lesson_of(Path(name))
    return launch.open_lab(live, options, lesson)


def lesson_of(file: Path) -> "Lesson | None":
    """Return the lesson in a scene file; None for a single scene without a question."""
    from pendu_tui.tui.cli.scene import read_scenes
    from pendu_tui.tui.playback.lesson import Lesson

    pages = [*read_scenes(file).values()]
    if len(pages) == 1 and not pages[0].shot.question:
        return None
    return Lesson("Page", pages)
