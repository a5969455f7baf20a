"""Chart speed against accuracy over a ladder of h; find the cheapest method and h."""

import argparse
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from engine.scenes import Scene, check_h
from tui.cli.errors import Exit, UserError
from tui.cli.files import check_free
from tui.cli.options import count, positive
from tui.cli.output import progress, warn
from tui.cli.report import add_report_options, publish
from tui.cli.scene import add_scene_options, general_scene_of
from tui.cli.workers import add_worker_options, workers_of
from tui.commands.studies.reports import figures

if TYPE_CHECKING:
    from engine.accuracy.recommend import Advice
    from engine.accuracy.study import Study
    from tui.commands.studies.reports.accuracy import Findings

EXAMPLES = """\
examples:
  pendu-tui accuracy --target 1e-6 --time 100
  pendu-tui accuracy --all --cost seconds --target 1e-9
  pendu-tui accuracy --target 1e-3 --error energy --time 10,100,1000
  pendu-tui accuracy --cost seconds --h-values 0.1:0.001:8 -o points.csv
  pendu-tui accuracy --all --time 1000 --workers 4
  pendu-tui accuracy --json | jq '.points[] | select(.method == "rk4" and .valid)'
"""

MAX_SECONDS = 1e9  # of simulated time
MAX_RUNGS = 1000
MAX_STEPS = 10**10  # of the finest rung: half an hour, compiled
MAX_BUDGET = 10**9  # force evaluations of a run; minutes for each method, compiled


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add = parser.add_argument
    every = "chart all methods for any force, with --cost seconds also series and closed form"
    add("--all", action="store_true", help=every)
    some = "simulated time in s; if several, the last is charted (ten small swings)"
    add("--time", metavar="S[,S...]", type=times, help=some)
    ladder = "N step sizes from A to B in s, log spaced (12, z = h·w0 from 0.6 to 0.0015)"
    add("--h-values", metavar="A:B:N", type=h_values, help=ladder)
    kinds = "largest angle error [rad], largest energy error, last angle error (%(default)s)"
    add("--error", choices=("theta", "energy", "final"), default="theta", help=kinds)
    costs = "force evaluations, or seconds, without Numba if a method is your own (%(default)s)"
    add("--cost", choices=("evaluations", "seconds"), default="evaluations", help=costs)
    wish = "find each method's cheapest h for this error; without --methods, try all of them"
    add("--target", metavar="ERROR", type=positive, help=wish)
    margin = "reach a target FACTOR times as small, for other starts and longer times (%(default)g)"
    add("--safety", metavar="FACTOR", type=positive, default=1.0, help=margin)
    limit = "limit of force evaluations; alone: find the least error within it"
    add("--budget", metavar="N", type=positive, help=limit)
    add("--no-compiled", action="store_true", help="do not use Numba (results are identical)")
    add_worker_options(parser)
    add_report_options(parser, csv=True, files=(".csv", ".json", *figures.SUFFIXES))


def times(text: str) -> list[float]:
    """Return one time or several [s], ascending."""
    values = sorted({positive(part) for part in text.split(",")})
    if values[-1] > MAX_SECONDS:
        raise argparse.ArgumentTypeError(f"{text!r} is out of range; use at most {MAX_SECONDS:g} s")
    return values


def h_values(text: str) -> tuple[float, float, int]:
    """Return the ends of a ladder [s], the larger first, and its rungs, from A:B:N."""
    match text.split(":"):
        case [first, last, many] if count(many) <= MAX_RUNGS:
            low, high = sorted((positive(first), positive(last)))
            return high, low, count(many)
    raise argparse.ArgumentTypeError(
        f"{text!r} is not a list of step sizes; use A:B:N, for example 0.2:0.001:10"
    )


def run(options: argparse.Namespace) -> int:
    """Measure, recommend, print.  Ctrl+C keeps what is done."""
    from engine.accuracy.study import usual, with_all_methods
    from tui.commands.studies.reports.accuracy import Findings, report

    _check_options(options)
    scene = general_scene_of(options)
    if scene.theta == scene.omega == 0:
        raise UserError(
            "the pendulum hangs at rest, so there is no error to measure; use another --theta or "
            "--omega."
        )
    searched = scene if options.methods else with_all_methods(scene)
    if options.all:
        scene = searched
    durations = options.time or [usual(scene)[0]]
    rungs = _ladder(scene, durations[-1], options.h_values, options.all)
    found = Findings(
        scene=scene,
        searched=searched,
        time=durations[-1],
        kind=options.error,
        cost=options.cost,
        target=options.target,
        safety=options.safety,
        budget=None if options.budget is None else int(options.budget),
        all=options.all,
    )
    try:
        _fill(found, durations, rungs, options)
    except KeyboardInterrupt:
        found.interrupted = True
    if figures.is_figure(options.output):
        figures.draw_accuracy(options.output, options.force, found)
    else:
        publish(report(found), options)
    if found.interrupted:
        warn("interrupted; partial results are kept.")
        return Exit.INTERRUPTED
    return Exit.FINE


def _check_options(options: argparse.Namespace) -> None:
    """Raise UserError for options that exclude each other, or an output that cannot be written."""
    if options.all and options.methods is not None:
        raise UserError("--all and --methods exclude each other; choose one of them.")
    if options.budget is not None and not 1 <= options.budget <= MAX_BUDGET:
        raise UserError(
            f"--budget {options.budget:g} is out of range; use 1 to {MAX_BUDGET:g} force "
            "evaluations."
        )
    if options.cost == "seconds" and (options.workers > 1 or options.dask or options.executor):
        raise UserError(
            "seconds are measured in this process, where others would disturb them; use workers "
            "with --cost evaluations."
        )
    if options.safety < 1:
        raise UserError(f"--safety {options.safety:g} is less than 1; use 2, for example.")
    if options.output:
        check_free(options.output, options.force)
    if figures.is_figure(options.output):
        figures.check(options.output, options.force)


def _is_compiled(scene: Scene, options: argparse.Namespace) -> bool:
    """Return whether Numba compiles the methods; if seconds are measured, all or none."""
    from engine.accuracy.study import compilable
    from engine.run.compiled import available

    if options.no_compiled:
        return False
    return compilable(scene.cast) if options.cost == "seconds" else available()


def _fill(
    found: "Findings", durations: list[float], rungs: list[int], options: argparse.Namespace
) -> None:
    """Add what was asked for to the findings, so that an interrupt keeps what was found."""
    from engine.accuracy.growth import growth
    from engine.accuracy.references import references
    from engine.accuracy.study import Study, measured_point, orders, timed
    from engine.run import compiled, loops

    scene = found.scene
    fast = _is_compiled(scene, options)
    study_loops = compiled.TieredLoops if fast else loops.PlainLoops
    study = Study(scene, found.time, study_loops)
    timed_loops = compiled.compiled if fast else loops.PlainLoops
    tasks = [(index, steps) for steps in rungs for index in range(len(scene.cast))]
    all_steps = len(scene.cast) * sum(rungs)
    done = 0
    measure = partial(measured_point, scene, found.time, study_loops)
    with workers_of(options) as workers, progress("measuring") as show:
        for point in workers.map(measure, tasks):
            if found.cost == "seconds":
                point = timed(point, scene, time.perf_counter, timed_loops)
            found.points.append(point)
            done += point.steps
            show(done, all_steps)
    if found.all and found.cost == "seconds":
        found.references = references(scene, found.time, time.perf_counter, fast)
    found.orders += orders(scene, found.time, study.loops)
    found.growth += (growth(scene, method) for method in scene.cast)
    if found.target is None and found.budget is None:
        return
    with progress("searching") as show:
        for number, duration in enumerate(durations):
            wider = Study(found.searched, duration, study.loops)

            show_share = partial(_show_share, show, number, len(durations))
            found.advice.append(_advice(found, wider, fast, show_share))


def _show_share(show: Callable[[float, float], None], done: int, all: int, share: float) -> None:
    """Show the share of the times that are searched, with that of the next one."""
    show(done + share, all)


def _advice(
    found: "Findings", study: "Study", fast: bool, show: Callable[[float], None]
) -> "Advice":
    """Return what is recommended for the time of a study."""
    from engine.accuracy.recommend import least_cost, least_error
    from engine.run import compiled, loops

    if found.target is None:
        return least_error(study, found.kind, found.budget or 0, show)
    target = found.target / found.safety
    if found.cost == "evaluations":
        return least_cost(study, found.kind, target, found.budget, show)
    timed_loops = compiled.compiled if fast else loops.PlainLoops
    clock = time.perf_counter
    return least_cost(study, found.kind, target, found.budget, show, clock, timed_loops)


def _ladder(
    scene: Scene, time: float, given: tuple[float, float, int] | None, all: bool
) -> list[int]:
    """Return the numbers of steps to measure: the usual ones, those of --all, or as given."""
    from engine.accuracy.study import ALL_LADDER, Z_LADDER, ladder

    z_max, z_min, rungs = ALL_LADDER if all else Z_LADDER
    largest = min(z_max / scene.w0, time)
    smallest = z_min / scene.w0
    if given:
        largest, smallest, rungs = given
    for h in (largest, smallest):
        check_h(h, scene.w0)
    if given and largest > time:
        raise UserError(
            f"h = {largest:g} s is longer than the time of {time:g} s; use a longer --time."
        )
    if time / smallest > MAX_STEPS:
        raise UserError(
            f"{time:g} s in steps of {smallest:.2g} s take hours; use --h-values, for example "
            "0.2:0.01:8."
        )
    return ladder(time, largest, smallest, rungs)
