"""Simulate a scene as fast as possible, without the TUI, and judge each method."""

import argparse
from pathlib import Path

from pendu_tui.engine.methods import METHODS
from pendu_tui.engine.run.verdicts import VERDICTS
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.checks import FIELDS, add_gate_option, parse
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.options import add_file, count, duration
from pendu_tui.tui.cli.report import add_report_options
from pendu_tui.tui.cli.scene import add_scene_options, scenes_of
from pendu_tui.tui.cli.workers import add_worker_options
from pendu_tui.tui.commands.studies import figures

EXAMPLES = """\
examples:
  pendu-tui run --time 100
  pendu-tui run --scene crossover --time 100 --record crossover.mcap
  pendu-tui run --time 60 --methods rk4,verlet --method mine.py:my_step
  pendu-tui run --theta 170deg --time 60 --json | jq '.methods[] | {method, verdict}'
  pendu-tui run --time 60 --fail-if 'rk4.max_energy_error > 1% or any.verdict == grows'
  pendu-tui run --theta 10deg:170deg:17 --h 0.01:0.5:50 --time 10min --workers 4 -o runs.csv

drift_per_second: the slope of the relative energy error, or null without evidence for a trend

verdicts:
""" + "\n".join(f"  {each.word}: {each.meaning}" for each in VERDICTS.values())

MAX_TIME = 1e9  # s, 30 years, which is also the limit of a recording's clock


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser, lists=True)
    add = parser.add_argument
    time = "simulated time: 60 (s) or 1min"
    add("--time", metavar="S", type=duration, required=True, help=time)
    record = "record to FILE (the same bytes each time)"
    add_file(parser, "--record", metavar="FILE", type=Path, help=record)
    every = "record every N steps (default: every 1/30 s)"
    add("--sample-every", metavar="N", type=count, help=every)
    names = (f"{method.key}.{field}" for method in METHODS for field in (*FIELDS, "verdict"))
    meaning = (
        "exit with 1 if the expression is true, e.g. rk4.max_energy_error > 1e-3 or any.verdict == "
        "grows; fields: those of --json"
    )
    add_gate_option(parser, names, meaning)
    add("--no-compiled", action="store_true", help="do not use Numba (same results)")
    add_report_options(parser, csv=True, files=(".csv", ".json", *figures.SUFFIXES))
    add_worker_options(parser)


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
