"""The lab, and a tour, a replay and an image of it."""

import argparse
import asyncio
import os
from pathlib import Path

from pendu_tui.recordings.events import remember
from pendu_tui.tui.cli.cast import own_methods
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.files import whole_file
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.cli.scene import read_scenes, scene_of
from pendu_tui.tui.playback import lesson as lessons
from pendu_tui.tui.playback.lesson import Lesson
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.screens import launch
from pendu_tui.tui.terminal.options import terminal_options_of


def live(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    launch.check(options)
    lab = Live(scene, options.speed or scene.speed)
    if options.equal_cost:
        lab.change(lab.stepping.toggled())
    name = options.scene or options.scene_option or ""
    lesson = None
    if name.endswith(".toml"):
        lesson = lesson_of(Path(name))
    return launch.open_lab(lab, options, lesson)


def lesson_of(file: Path) -> Lesson | None:
    """Return the lesson in a scene file; None for a single scene without a question."""
    pages = [*read_scenes(file).values()]
    if len(pages) == 1 and not pages[0].shot.question:
        return None
    return Lesson("Page", pages)


def tour(options: argparse.Namespace) -> int:
    launch.check(options)
    pages = lessons.tour()
    return launch.open_lab(Live(pages.page), options, pages)


def replay(options: argparse.Namespace) -> int:
    from pendu_tui.recordings.recording import Recording  # mcap, which a lab needs later

    path = resolve(options.file)
    remember(own_methods(options))
    launch.check(options)
    played = Replay(Recording.open(path))
    if not 0 <= options.start_at <= played.length:
        raise UserError(
            f"--start-at {options.start_at:g} is outside the recording; use 0 to "
            f"{played.length:.2f} s."
        )
    played.set_speed(options.speed or 1.0)
    played.looping = options.loop
    played.seek(options.start_at)
    played.pause(options.paused)
    if options.plain:
        return launch.print_sentences(played)
    return launch.show(launch.replay_screen(played, options.no_record), options)


def snapshot(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    display = terminal_options_of(options, os.environ, "utf-8")
    path = options.output or Path(f"{scene.name}.svg")
    with whole_file(path, options.force) as file:
        svg = asyncio.run(launch.still(scene, options.time, options.size, display))
        file.write_text(svg, encoding="utf-8")
    return Exit.FINE
