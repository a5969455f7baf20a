"""The lab: four pendulums, their errors over time, and a recording of the sitting."""

import argparse
import gc
import os
import shlex
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from engine.scenes import Scene
from tui.cli.errors import Exit, UserError
from tui.cli.options import add_file, add_scene_options, positive, scene_of
from tui.cli.output import progress
from tui.terminal.options import add_terminal_options, terminal_options_of

if TYPE_CHECKING:
    from tui.playback.live import Live
    from tui.playback.source import Source
    from tui.screens.base import SourceScreen
    from tui.screens.live import LiveScreen

EXAMPLES = """\
examples:
  pendu-tui
  pendu-tui live --scene crossover
  pendu-tui live --theta 170deg --h 0.02 --record swing.mcap
  pendu-tui live --present
  pendu-tui live --plain --no-record
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add this command's options."""
    add_scene_options(parser)
    parser.add_argument("--speed", metavar="X", type=positive, default=1.0, help="times real time (%(default)g)")
    recording = parser.add_mutually_exclusive_group()
    add_file(recording, "--record", metavar="FILE", type=Path, help="record here, not in the data folder")
    recording.add_argument("--no-record", action="store_true", help="record nothing")
    add_terminal_options(parser)


def run(options: argparse.Namespace) -> int:
    """Run the lab."""
    scene = scene_of(options)
    if options.plain:
        return plain_lab(scene, options)
    from tui.terminal.check import check_terminal

    check_terminal()
    gc.disable()  # until the stage is set: collections while importing would delay the first paint by a thirtieth
    path = None if options.no_record else place_of(options.record)
    told = [] if path is None else tell_of_leftovers(path.parent)
    from tui.playback.live import Live

    return show(recording_lab(Live(scene, options.speed), path, told, or_next=options.record is None), options)


def plain_lab(scene: Scene, options: argparse.Namespace) -> int:
    """Run the lab without a screen."""
    path = None if options.no_record else place_of(options.record)
    if path is not None:
        tell_of_leftovers(path.parent)
    from tui.playback.live import Live

    live = Live(scene, options.speed)
    if path is not None:
        from recordings.live_recorder import LiveRecorder

        live.record(LiveRecorder(path, or_next=options.record is None))
    return say(live)


def say(source: "Source") -> int:
    """Tell in sentences what happens, until Ctrl+C or a signal ends it, as it should be ended; so that is fine."""
    from tui.cli.files import stop_requests
    from tui.words.plain_text import plain

    try:
        with stop_requests() as stopped:
            plain(source, partial(print, flush=True), stopped)
    finally:
        source.close()
    farewell(source)
    return Exit.FINE


def recording_lab(live: "Live", path: Path | None, notices: Sequence[str] = (), or_next: bool = True) -> "LiveScreen":
    """The lab's screen, and a recording at that place, or at the next free one."""
    from tui.screens.live import LiveScreen

    def prepare() -> None:
        if path is not None:
            from recordings.live_recorder import LiveRecorder  # brings mcap, which can wait for the first paint

            live.record(LiveRecorder(path, or_next=or_next))

    return LiveScreen(live, prepare=prepare, notices=notices)


def show(stage: "SourceScreen", options: argparse.Namespace) -> int:
    """Run the app with this screen first, and say goodbye."""
    from tui.commands.replay import player
    from tui.screens.app import PenduApp

    assert sys.__stderr__ is not None  # where Textual draws
    display = terminal_options_of(options, os.environ, sys.__stderr__.encoding)
    app = PenduApp(stage, lambda path: player(path, options.no_record), display)
    result = app.run(mouse=display.mouse)
    app.stage.source.close()
    if isinstance(result, OSError):
        raise result
    for each in app.stages:
        farewell(each.source)
    return app.return_code or Exit.FINE if result is None else result


def place_of(file: Path | None) -> Path:
    """Where to record: the given file, or a new one in the library.  Raises OSError where that cannot work."""
    from recordings import library

    if file is not None and file.exists():
        raise UserError(f"{file} exists already: choose another name, or remove it.", Exit.DISK)
    path = file or library.new_path()
    if file is None:
        path.parent.mkdir(parents=True, exist_ok=True)
    if not path.parent.is_dir() or not os.access(path.parent, os.W_OK | os.X_OK):
        raise UserError(
            f"{path.parent} is no folder that can be written: choose another one with --record or PENDU_RECORDINGS,"
            " or record nothing with --no-record.",
            Exit.DISK,
        )
    return path


def tell_of_leftovers(folder: Path) -> list[str]:
    """Recover what an earlier sitting left unfinished, and say so."""
    from tui.words.recovered import recover_leftovers

    sentences = recover_leftovers(folder, progress)
    for sentence in sentences:
        print(f"pendu-tui: {sentence}", file=sys.stderr)
    return sentences


def farewell(source: "Source") -> None:
    """Say where the recording is and how to see it again."""
    from tui.playback.live import Live

    if not isinstance(source, Live) or source.recorder is None:
        return
    for file in source.recorder.files:
        print(f"recorded: {file}\nsee it again: pendu-tui replay {shlex.quote(str(file))}")
    if source.recorder.failed:
        print(f"pendu-tui: the recording stopped: {source.recorder.failed}", file=sys.stderr)
