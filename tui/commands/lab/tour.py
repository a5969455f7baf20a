"""A tour of the lab: eight short steps, each with a question and its answer."""

import argparse

from tui.cli.errors import Exit
from tui.terminal.options import add_terminal_options

EXAMPLES = """\
examples:
  pendu-tui tour
  pendu-tui tour --plain --no-record

enter goes on, 1 or 2 answers, backspace goes back, esc leaves for the lab, where T returns.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--no-record", action="store_true", help="do not record")
    add_terminal_options(parser)


def run(options: argparse.Namespace) -> int:
    from tui.screens import launch
    from tui.terminal.check import check_terminal

    if not options.plain:
        check_terminal()
    path = None if options.no_record else launch.recording_path(None)
    notices = [] if path is None else launch.recover_leftovers(path.parent)
    from engine.scenes import DEFAULT_SCENE
    from tui.playback.live import Live

    live = Live(DEFAULT_SCENE)
    if not options.plain:
        screen = launch.live_screen(live, path, notices)
        screen.begins_with_tour = True
        return launch.show(screen, options)
    from functools import partial

    from tui.cli.files import stop_requests
    from tui.words.plain_text import print_tour

    launch.start_recording(live, path, or_next=True)
    try:
        with stop_requests() as stopped:
            print_tour(live, partial(print, flush=True), stopped)
    finally:
        live.close()
    launch.say_goodbye(live)
    return Exit.FINE
