"""Chart speed against accuracy over a ladder of h; find the cheapest method and h."""

import argparse

from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.files import keep_older
from pendu_tui.tui.cli.options import count, duration, positive
from pendu_tui.tui.cli.report import add_report_options, publish, warn
from pendu_tui.tui.cli.scene import add_scene_options, general_scene_of
from pendu_tui.tui.cli.workers import add_worker_options
from pendu_tui.tui.commands.studies import figures

EXAMPLES = """\
examples:
  pendu-tui accuracy --target 1e-6 --time 100
  pendu-tui accuracy --target 1e-3 --error energy --time 1000
  pendu-tui accuracy --all --cost seconds
  pendu-tui accuracy --cost seconds --h-values 0.1:0.001:8 -o points.csv
  pendu-tui accuracy --json | jq '.points[] | select(.method == "rk4" and .valid)'

Exit code 1: no method reaches the target.
"""

MAX_RUNGS = 1000


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add = parser.add_argument
    add("--all", action="store_true", help="chart all methods for any force")
    add("--time", metavar="S", type=duration, help="simulated time (ten small swings)")
    ladder = "N step sizes from A to B in s, log-spaced (12, with z = h·w0 from 0.6 to 0.0015)"
    add("--h-values", metavar="A:B:N", type=h_values, help=ladder)
    kinds = "largest angle error [rad], largest energy error or last angle error (%(default)s)"
    add("--error", choices=("theta", "energy", "final"), default="theta", help=kinds)
    costs = "what counts as cost (%(default)s); seconds are without Numba if a method is your own"
    add("--cost", choices=("evaluations", "seconds"), default="evaluations", help=costs)
    target = "find the cheapest h of each method, or of each in --methods, for this error"
    add("--target", metavar="ERROR", type=positive, help=target)
    add("--no-compiled", action="store_true", help="do not use Numba (same results)")
    add_worker_options(parser)
    add_report_options(parser, csv=True, files=(".csv", ".json", *figures.SUFFIXES))


def h_values(text: str) -> tuple[float, float, int]:
    """Return the ends of a ladder [s], the larger first, and its rungs, from A:B:N."""
    match text.split(":"):
        case [first, last, many] if count(many) <= MAX_RUNGS:
            low, high = sorted((positive(first), positive(last)))
            return high, low, count(many)
    raise ValueError(f"{text!r} is not a list of step sizes; use A:B:N, for example 0.2:0.001:10")


def run(options: argparse.Namespace) -> int:
    if options.all and options.methods is not None:
        raise UserError("--all and --methods exclude each other; choose one of them.")
    if options.cost == "seconds" and (options.workers > 1 or options.dask):
        raise UserError("seconds are measured in this process; use workers for evaluations only.")
    is_figure = figures.check_output(options)
    scene = general_scene_of(options)
    if scene.theta == scene.omega == 0:
        raise UserError(
            "the pendulum hangs at rest, so there is no error to measure; use another --theta or "
            "--omega."
        )
    from pendu_tui.tui.commands.studies.accuracy import Results, measure, report

    results = Results(scene, options)
    interrupted = False
    try:
        measure(results)
    except KeyboardInterrupt:
        interrupted = True
        keep_older(options.output)
    if is_figure:
        figures.draw_accuracy(options, results.scene.cast, results.points)
    else:
        publish(report(results, interrupted), options)
    if interrupted:
        warn("interrupted; partial results are kept.")
        return Exit.INTERRUPTED
    if results.advice and results.advice.point is None:
        warn(f"no method reaches the target over {results.time:g} s.")
        return Exit.CHECK_FAILED
    return Exit.FINE
