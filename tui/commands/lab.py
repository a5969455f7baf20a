"""The lab, and a tour, a replay and an image of it; on screen or as sentences."""

import argparse
import asyncio
import gc
import os
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from textual.widget import Widget

from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings import files
from pendu_tui.recordings.events import remember
from pendu_tui.recordings.files import NameTakenError, printable
from pendu_tui.recordings.system import environment, quoted
from pendu_tui.tui.cli.cast import own_methods
from pendu_tui.tui.cli.errors import Exit, UserError, warn
from pendu_tui.tui.cli.files import stop_requests, whole_file
from pendu_tui.tui.cli.options import resolve
from pendu_tui.tui.cli.scene import read_scenes, scene_of
from pendu_tui.tui.drawing.cells import CellWidget
from pendu_tui.tui.playback import lesson as lessons
from pendu_tui.tui.playback.lesson import Lesson
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.screens.app import PenduApp, normalised
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.terminal.options import (
    FPS,
    USUAL,
    TerminalOptions,
    background,
    check_terminal,
    terminal_options_of,
)
from pendu_tui.tui.words.plain_text import tell

# The commands


def live(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    check(options)
    lab = Live(scene, options.speed or scene.speed)
    if options.equal_cost or scene.shot.equal_cost:
        lab.change(lab.stepping.toggled())
    name = options.scene or options.scene_option or ""
    lesson = None
    if name.endswith(".toml"):
        lesson = lesson_of(Path(name))
    return play(lab, options, lesson)


def lesson_of(file: Path) -> Lesson | None:
    """Return the lesson in a scene file; None for a single scene without a question."""
    pages = [*read_scenes(file).values()]
    if len(pages) == 1 and not pages[0].shot.question:
        return None
    return Lesson("Page", pages)


def tour(options: argparse.Namespace) -> int:
    check(options)
    pages = lessons.tour()
    return play(Live(pages.page), options, pages)


def replay(options: argparse.Namespace) -> int:
    from pendu_tui.recordings.recording import Recording  # mcap, which a lab needs later

    path = resolve(options.file)
    remember(own_methods(options))
    check(options)
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
    return play(played, options)


def snapshot(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    display = terminal_options_of(options, os.environ, "utf-8")
    # a scene's name may hold a path, which somebody else may have written
    path = options.output or Path(Path(f"{scene.name}.svg").name)
    with whole_file(path, options.force) as file:
        svg = asyncio.run(still(scene, options.time, options.size, display))
        file.write_text(svg, encoding="utf-8")
    return Exit.FINE


# On screen or as sentences


def check(options: argparse.Namespace) -> None:
    if not options.plain:
        check_terminal()
        # until the screen is up; collections would delay the first paint by 3 %
        gc.disable()


def play(source: Source, options: argparse.Namespace, lesson: Lesson | None = None) -> int:
    """Play a lab, perhaps with a lesson, or a replay, and return the exit code.

    A lab is recorded from its start, a replay from where it continues live.
    """
    if isinstance(source, Live) and not options.no_record:
        if options.plain:
            start_recording(source, options.record)
        else:
            recording_path(options.record)  # refuses a name before the screen is up
    if options.plain:
        return print_sentences(source, lesson)
    screen = LabScreen(source)
    screen.guide = lesson
    if not options.no_record:
        screen.record = partial(start_recording, file=options.record)
    return show(screen, options)


def print_sentences(source: Source, lesson: Lesson | None = None) -> int:
    """Print what happens, to the end or until Ctrl+C or another signal."""
    try:
        with stop_requests() as stopped:
            tell(source, partial(print, flush=True), stopped, lesson=lesson)
    finally:
        source.close()
    code = say_goodbye(source)
    if stopped() and code == Exit.FINE:
        return Exit.INTERRUPTED
    return code


def show(screen: LabScreen, options: argparse.Namespace) -> int:
    """Run the app with this screen first, say goodbye, and return the exit code."""
    assert sys.__stderr__ is not None  # where Textual draws
    known = environment()
    terminal = terminal_options_of(options, known, sys.__stderr__.encoding)
    if options.theme == "auto" and terminal.theme != "ansi" and not known.get("COLORFGBG"):
        terminal = terminal._replace(theme=background() or terminal.theme)
    app = PenduApp(screen, terminal)
    try:
        result = app.run(mouse=terminal.mouse)
    finally:
        app.finish()
    codes = [say_goodbye(source) for source in screen.sources]
    if isinstance(result, BaseException):
        raise getattr(result, "error", result)  # of a worker
    if result is not None:
        return result
    return max([app.return_code or Exit.FINE, *codes])


def say_goodbye(source: Source) -> int:
    if not isinstance(source, Live) or source.recorder is None:
        return Exit.FINE
    recorder = source.recorder
    file = recorder.path
    if recorder.part.exists():
        file = recorder.part
    if file.exists():
        for line in (f"saved {file}", f"replay it with: pendu-tui replay {quoted([str(file)])}"):
            print(printable(line, len(line)))  # whole, to be copied
    if recorder.failed:
        warn(f"the recording stopped: {recorder.failed}")
        return Exit.DISK
    return Exit.FINE


# Its recording


def recording_path(file: Path | None, folder: Path | None = None) -> Path:
    """Return where to record: the given file, or a new one in the library.

    Raises OSError if it cannot be written.
    """
    path = file or files.new_path(folder)
    if file is None:
        path.parent.mkdir(parents=True, exist_ok=True)
    try:
        files.check_target(path, force=None)
    except files.DiskError as error:
        if file is None:
            error.strerror = f"{error.strerror}, with PENDU_RECORDINGS, or use --no-record"
        raise
    return path


def start_recording(live: Live, file: Path | None = None, folder: Path | None = None) -> None:
    """Record a lab in this file, or in a folder (the library) under a free name."""
    from pendu_tui.recordings.recorder import LiveRecorder  # mcap's writer, after the first paint

    path = recording_path(file, folder)
    while live.recorder is None:
        try:
            live.record(LiveRecorder(path))
        except NameTakenError:
            if file is not None:
                raise
            path = files.free_path(path)


# Its image


async def still(
    scene: Scene,
    seconds: float,
    size: tuple[int, int],
    terminal: TerminalOptions = USUAL,
    keys: Sequence[str] = (),
) -> str:
    """Return the lab as an SVG picture, `seconds` after the start, with `keys` pressed then."""
    now = 0.0
    live = Live(scene, clock=lambda: 0.0)
    screen = LabScreen(live, clock=lambda: now)
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


async def settled(app: PenduApp) -> None:
    panes = app.lab.query("#views *").results
    # minutes on a busy machine, where a study lets others go first
    while not all(map(_is_settled, panes(Widget))):
        await asyncio.sleep(0.01)
    for pane in panes(CellWidget):
        pane.draw()


def _is_settled(pane: Widget) -> bool:
    # a pane on screen that is not drawable does not know its size yet
    is_shown = getattr(pane, "drawable", True) or not pane.is_on_screen
    return is_shown and getattr(pane, "settled", True)
