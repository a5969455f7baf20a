"""The lab: methods side by side, their errors over time, and a recording."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.cast import check_fits
from pendu_tui.tui.cli.options import add_file, positive
from pendu_tui.tui.cli.scene import add_scene_options, scene_of
from pendu_tui.tui.cli.scene_file import read_scenes
from pendu_tui.tui.terminal.options import add_terminal_options

if TYPE_CHECKING:
    from pendu_tui.tui.playback.lesson import Lesson
    from pendu_tui.tui.playback.live import Live

EXAMPLES = """\
examples:
  pendu-tui
  pendu-tui live --scene crossover
  pendu-tui live --theta 170deg --h 0.02 --record swing.mcap
  pendu-tui live --scene crossover --equal-cost
  pendu-tui live --plain --no-record
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    speed = "multiple of real time (default: the scene's)"
    parser.add_argument("--speed", metavar="X", type=positive, help=speed)
    equal = "give all methods equally many force evaluations: cheaper ones take smaller steps"
    parser.add_argument("--equal-cost", action="store_true", help=equal)
    recording = parser.add_mutually_exclusive_group()
    record = "record to FILE instead of the data folder"
    add_file(recording, "--record", metavar="FILE", type=Path, help=record)
    recording.add_argument("--no-record", action="store_true", help="do not record")
    add_terminal_options(parser)


def lab_of(scene: Scene, options: argparse.Namespace) -> "Live":
    """Return a lab of the scene.  Raises SceneError for a step too large at equal cost."""
    from pendu_tui.tui.playback.live import Live

    live = Live(scene, options.speed or scene.speed)
    if options.equal_cost:
        live.change(live.stepping.toggled())
    return live


def run(options: argparse.Namespace) -> int:
    from pendu_tui.tui.screens import launch

    scene = scene_of(options, lecture=True)
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
    from pendu_tui.tui.playback.lesson import Lesson

    pages = [*read_scenes(file).values()]
    if len(pages) == 1 and not pages[0].shot.question:
        return None
    return Lesson("Page", pages)
