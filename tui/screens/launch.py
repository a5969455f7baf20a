"""Open the lab or a replay: on screen, as sentences or as a picture; say where it is recorded."""

import argparse
import asyncio
import gc
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from textual.widget import Widget

from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings import files
from pendu_tui.recordings.files import NameTakenError, printable
from pendu_tui.recordings.system import environment, quoted
from pendu_tui.tui.cli.errors import Exit, warn
from pendu_tui.tui.cli.files import stop_requests
from pendu_tui.tui.drawing.cells import CellWidget
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


def check(options: argparse.Namespace) -> None:
    if not options.plain:
        check_terminal()
        # until the screen is up; collections would delay the first paint by 3 %
        gc.disable()


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


def open_lab(live: Live, options: argparse.Namespace, lesson: Lesson | None = None) -> int:
    """Open a lab, with a lesson if it begins with the lab's scene."""
    if not options.no_record:
        recording_path(options.record)  # a name that cannot be used is refused before the screen
    if options.plain:
        if not options.no_record:
            start_recording(live, options.record)
        return print_sentences(live, lesson)
    screen = LabScreen(live)
    if not options.no_record:
        screen.record = partial(start_recording, file=options.record)
    screen.guide = lesson
    return show(screen, options)


def replay_screen(replay: Replay, no_record: bool) -> LabScreen:
    """Return the screen of a replay; what continues live is recorded in the library, if at all."""
    screen = LabScreen(replay)
    if reason := replay.recording.reason:
        screen.notice = f"This recording is incomplete ({reason}); showing what is intact."
    if not no_record:
        screen.record = start_recording
    return screen


def print_sentences(source: Source, lesson: Lesson | None = None) -> int:
    """Print what happens until Ctrl+C or another signal, which is no error here."""
    try:
        with stop_requests() as stopped:
            tell(source, partial(print, flush=True), stopped, lesson=lesson)
    finally:
        source.close()
    return say_goodbye(source)


def say_goodbye(source: Source) -> int:
    if not isinstance(source, Live) or source.recorder is None:
        return Exit.FINE
    recorder = source.recorder
    file = recorder.path
    if recorder.part.exists():
        file = recorder.part
    if file.exists():
        for line in (f"saved {file}", f"replay it with: pendu-tui replay {quoted([str(file)])}"):
            print(printable(line, limit=5000))  # whole, to be copied
    if recorder.failed:
        warn(f"the recording stopped: {recorder.failed}")
        return Exit.DISK
    return Exit.FINE


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
    async with asyncio.timeout(30):
        while not all(map(_is_settled, panes(Widget))):
            await asyncio.sleep(0.01)
    for pane in panes(CellWidget):
        pane.draw()


def _is_settled(pane: Widget) -> bool:
    # a pane on screen that is not drawable does not know its size yet
    is_shown = getattr(pane, "drawable", True) or not pane.is_on_screen
    return is_shown and getattr(pane, "settled", True)
