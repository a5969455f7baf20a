"""A tour of the lab: nine short steps, with questions and their answers."""

import argparse


def run(options: argparse.Namespace) -> int:
    from pendu_tui.tui.screens import launch

    launch.check(options)
    from pendu_tui.tui.playback.lesson import tour
    from pendu_tui.tui.playback.live import Live

    lesson = tour()
    return launch.open_lab(Live(lesson.page), options, lesson)
