"""A tour of the lab: eight short steps, each with a question and its answer."""

import argparse

from pendu_tui.tui.terminal.options import add_terminal_options

EXAMPLES = """\
examples:
  pendu-tui tour
  pendu-tui tour --plain --no-record

Enter goes on, 1 or 2 answers, Backspace goes back, Esc leaves; T in the lab resumes the tour.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(record=None)
    parser.add_argument("--no-record", action="store_true", help="do not record")
    add_terminal_options(parser)


def run(options: argparse.Namespace) -> int:
    from pendu_tui.tui.screens import launch

    launch.check(options)
    from pendu_tui.tui.playback.lesson import tour
    from pendu_tui.tui.playback.live import Live

    lesson = tour()
    return launch.open_lab(Live(lesson.page), options, lesson)
