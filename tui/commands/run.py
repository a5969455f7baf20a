"""Simulate a scene as fast as possible, without the TUI, and judge each method."""

import argparse

from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.checks import parse
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.scene import scenes_of
from pendu_tui.tui.commands.studies import figures

MAX_TIME = 1e9  # s, 30 years, which is also the limit of a recording's clock


def run(options: argparse.Namespace) -> int:
    scenes = scenes_of(options)
    gate = None
    if options.fail_if is not None:
        gate = parse(options.fail_if, cast=scenes.base.cast)
    for scene in scenes.corners():
        _check_time(scene, options.time)
    is_figure = figures.check_output(options)
    from pendu_tui.tui.commands.studies.run import run_list, run_one

    if len(scenes) > 1:
        return run_list(scenes, options, gate, is_figure)
    (scene,) = scenes
    return run_one(scene, options, gate, is_figure)


def _check_time(scene: Scene, seconds: float) -> None:
    if seconds > MAX_TIME:
        raise UserError(f"--time {seconds:g} is out of range; use at most {MAX_TIME:g} s.")
    if round(seconds / scene.h) == 0:
        raise UserError(
            f"--time {seconds:g} s is shorter than one step of {scene.h:g} s; use a longer time."
        )
