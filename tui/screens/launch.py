"""Open the lab or a replay, show it (or print it as sentences), and say where the recording is."""

import argparse
import gc
import os
import shlex
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from traceback import walk_tb
from typing import TYPE_CHECKING, Any

from pendu_tui.tui.cli.errors import Exit, UserError, explained
from pendu_tui.tui.cli.report import progress, say, warn

# Textual, NumPy and mcap are imported only where they are needed
if TYPE_CHECKING:
    from pendu_tui.engine.scenes import Scene
    from pendu_tui.recordings.recording import Recording
    from pendu_tui.tui.playback.live import Live
    from pendu_tui.tui.playback.replay import Replay
    from pendu_tui.tui.playback.source import Source
    from pendu_tui.tui.screens.base import SourceScreen
    from pendu_tui.tui.screens.live import LiveScreen
    from pendu_tui.tui.screens.replay import ReplayScreen


def check(options: argparse.Namespace) -> None:
    if not options.plain:
        from pendu_tui.tui.terminal.check import check_terminal

        check_terminal()
        # until the screen is up; collections would delay the first paint by 3 %
        gc.disable()


def recording_path(file: Path | None) -> Path:
    """Return where to record: the given file, or a new one in the library.

    Raises UserError or OSError.
    """
    from pendu_tui.recordings import library

    if file is not None and file.exists():
        raise UserError(f"{file} exists already: choose another name or delete it.", Exit.DISK)
    path = file or library.new_path()
    if file is None:
        path.parent.mkdir(parents=True, exist_ok=True)
    if not path.parent.is_dir() or not os.access(path.parent, os.W_OK | os.X_OK):
        raise UserError(
            f"{path.parent} is not writable: choose another folder with --record or "
            "PENDU_RECORDINGS, or turn recording off with --no-record.",
            Exit.DISK,
        )
    return path


def start_recording(live: "Live", path: Path | None, or_next: bool) -> None:
    if path is None:
        return
    from pendu_tui.recordings.errors import NameTakenError
    from pendu_tui.recordings.library import free_path
    from pendu_tui.recordings.recorder import LiveRecorder  # imports mcap

    while live.recorder is None:
        try:
            live.record(LiveRecorder(path))
        except NameTakenError:
            if not or_next:
                raise
            path = free_path(path)


def live_screen(live: "Live", path: Path | None, or_next: bool = True) -> "LiveScreen":
    from pendu_tui.tui.screens.live import LiveScreen

    return LiveScreen(live, prepare=partial(start_recording, live, path, or_next))


def open_recording(path: Path) -> "Recording":
    """Open a recording to replay it.  Raises UserError if it is empty."""
    from pendu_tui.recordings.recording import Recording

    with progress(f"reading {path.name}") as show_progress:
        recording = Recording.open(path, progress=show_progress)
    if recording.at(0.0) is None:
        recording.close()
        raise UserError(f"{path} contains no samples.", Exit.INPUT_UNREADABLE)
    return recording


def replay_screen(replay: "Replay", no_record: bool) -> "ReplayScreen":
    """Return the replay's screen; a lab that continues it is recorded in the library, if at all."""
    from pendu_tui.tui.screens.replay import ReplayScreen

    def go_live(live: "Live") -> "LiveScreen":
        return live_screen(live, None if no_record else recording_path(None))

    notices = []
    if reason := replay.recording.reason:
        notices.append(f"This recording is incomplete ({reason}); showing what is intact.")
    return ReplayScreen(replay, go_live, notices=notices)


def show(screen: "SourceScreen", options: argparse.Namespace) -> int:
    """Run the app with this screen first, say goodbye, and return the exit code."""
    from pendu_tui.recordings.system import environment
    from pendu_tui.tui.screens.app import PenduApp
    from pendu_tui.tui.terminal.check import background
    from pendu_tui.tui.terminal.options import fitting_theme, terminal_options_of

    assert sys.__stderr__ is not None  # where Textual draws
    if options.theme == "auto" and not os.environ.get("COLORFGBG"):
        options.theme = fitting_theme(environment())
        if options.theme != "ansi":
            options.theme = background() or options.theme
    terminal = terminal_options_of(options, environment(), sys.__stderr__.encoding)
    app = PenduApp(screen, terminal)
    try:
        result = app.run(mouse=terminal.mouse)
    finally:
        app.finish()
    codes = [say_goodbye(each.source) for each in app.source_screens]
    if isinstance(result, BaseException):
        raise _sentence(result)
    if result is not None:
        return result
    return max([app.return_code or Exit.FINE, *codes])


def _sentence(error: BaseException) -> UserError:
    """Return the error as a sentence, which names the place of a bug."""
    error = getattr(error, "error", error)  # of a worker
    try:
        return explained(error)
    except BaseException:
        code, line = [(frame.f_code, line) for frame, line in walk_tb(error.__traceback__)][-1]
        return UserError(
            f"an error in this program ended the lab: {type(error).__name__}: {error} "
            f"({Path(code.co_filename).name}:{line}); please report it.",
            Exit.CHECK_FAILED,
        )


def open_lab(
    live: "Live",
    options: argparse.Namespace,
    with_tour: bool = False,
    lecture: "Mapping[str, Scene] | None" = None,
) -> int:
    path = None
    if not options.no_record:
        path = recording_path(options.record)
    or_next = options.record is None
    if options.plain:
        from pendu_tui.tui.words.plain_text import print_run, print_tour

        start_recording(live, path, or_next)
        return print_sentences(live, print_tour if with_tour else print_run)
    screen = live_screen(live, path, or_next)
    screen.begins_with_tour = with_tour
    screen.lecture = lecture or screen.lecture
    return show(screen, options)


def print_sentences(source: Any, write: Callable[..., None]) -> int:
    """Have `write` print what happens until Ctrl+C or another signal, which is no error here."""
    from pendu_tui.tui.cli.files import stop_requests

    try:
        with stop_requests() as stopped:
            write(source, partial(print, flush=True), stopped)
    finally:
        source.close()
    return say_goodbye(source)


def say_goodbye(source: "Source") -> int:
    from pendu_tui.tui.playback.live import Live

    if not isinstance(source, Live) or source.recorder is None:
        return Exit.FINE
    recorder = source.recorder
    file = recorder.path
    if recorder.part.exists():
        file = recorder.part
    if file.exists():
        say(f"saved {file}\nreplay it with: pendu-tui replay {shlex.quote(str(file))}")
    if recorder.failed:
        warn(f"the recording stopped: {recorder.failed}")
        return Exit.DISK
    return Exit.FINE
