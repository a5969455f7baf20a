"""A recording on the lab's screen: pause, step, seek, loop, play backwards, go on live from any moment."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from tui.cli.errors import Exit, UserError
from tui.cli.options import add_recording, number, positive
from tui.commands.live import place_of, recording_lab, say, show
from tui.terminal.options import add_terminal_options

if TYPE_CHECKING:
    from tui.playback.live import Live
    from tui.screens.base import SourceScreen
    from tui.screens.replay import ReplayScreen

EXAMPLES = """\
examples:
  pendu-tui replay latest
  pendu-tui replay drift
  pendu-tui replay sitting.mcap --start-at 12 --speed 0.5 --loop
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add this command's options."""
    add_recording(parser, metavar="FILE|latest|NAME", help="a file, the latest sitting, or one that came along")
    parser.add_argument(
        "--start-at", metavar="S", type=number, default=0.0, help="begin at this many s of the recording (%(default)g)"
    )
    parser.add_argument("--speed", metavar="X", type=positive, default=1.0, help="times the recorded one (%(default)g)")
    parser.add_argument("--loop", action="store_true", help="begin again at the end")
    parser.add_argument("--paused", action="store_true", help="wait for the space key")
    parser.add_argument("--no-record", action="store_true", help="record nothing when going on live")
    add_terminal_options(parser)


def run(options: argparse.Namespace) -> int:
    """Replay."""
    from recordings.library import resolve
    from tui.terminal.check import check_terminal

    path = resolve(options.file)
    if not options.plain:
        check_terminal()
    stage = player(path, options.no_record)
    replay = stage.replay
    if not 0 <= options.start_at <= replay.length:
        raise UserError(f"--start-at {options.start_at:g} is outside: give a time from 0 to {replay.length:.2f} s.")
    replay.set_speed(options.speed)
    replay.looping = options.loop
    replay.seek(options.start_at)
    replay.pause(options.paused)
    return say(replay) if options.plain else show(stage, options)


def player(path: Path, no_record: bool) -> "ReplayScreen":
    """The stage for a recording; a lab that goes on from it is recorded, or not."""
    from recordings.recording import Recording
    from tui.cli.output import progress
    from tui.playback.marks import Marks
    from tui.playback.replay import Replay
    from tui.screens.replay import ReplayScreen

    with progress(f"looking through {path.name}") as tell:
        recording = Recording.open(path, progress=tell)
    if recording.at(0.0) is None:
        raise UserError(f"{path}: no samples are left in it, so there is nothing to see.", Exit.INPUT_UNREADABLE)

    def go_live(live: "Live") -> "SourceScreen":
        return recording_lab(live, None if no_record else place_of(None))

    notices = [f"This recording is not whole: {recording.reason}. What is intact is shown."] if recording.reason else []
    return ReplayScreen(Replay(recording, Marks(path)), go_live, notices=notices)
