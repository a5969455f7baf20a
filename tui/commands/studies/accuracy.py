"""Chart speed against accuracy over a ladder of h, and find the cheapest method and h for a target or a budget."""

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from engine.scenes import Scene, check_h
from tui.cli.errors import Exit, UserError
from tui.cli.files import text_file
from tui.cli.options import add_file, count, positive
from tui.cli.output import progress, warn
from tui.cli.scene import add_scene_options, general_scene_of

if TYPE_CHECKING:
    from engine.accuracy.advice import Advice
    from engine.accuracy.study import Study
    from tui.commands.studies.reports.accuracy import Findings

EXAMPLES = """\
examples:
  pendu-tui accuracy
  pendu-tui accuracy --target 1e-6 --time 100
  pendu-tui accuracy --methods rk4,verlet
  pendu-tui accuracy --all --cost seconds --target 1e-9
  pendu-tui accuracy --budget 2e4 --theta 150deg
  pendu-tui accuracy --target 1e-3 --error energy --time 10,100,1000
  pendu-tui accuracy --cost seconds --h-values 0.1:0.001:8
  pendu-tui accuracy --json | jq '.points[] | select(.method == "rk4" and .valid)'
"""

LONGEST = 1e9  # s
MOST_RUNGS = 1000
MOST_STEPS = 10**10  # of the finest rung: half an hour, compiled
MOST_BUDGET = 10**9  # force evaluations of a run; minutes for each method, compiled


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument(
        "--all",
        action="store_true",
        help="all methods there are and your own; with --cost seconds also Taylor's series and the closed form",
    )
    parser.add_argument(
        "--time",
        metavar="S[,S...]",
        type=times,
        help="simulated time in s; if several, the last is charted (ten small swings)",
    )
    parser.add_argument(
        "--h-values",
        metavar="A:B:N",
        type=h_values,
        help="N step sizes from A to B in s, logarithmically spaced (12 with z = h·w0 from 0.6 to 0.0015)",
    )
    parser.add_argument(
        "--error",
        choices=("theta", "energy", "final"),
        default="theta",
        help="theta: largest angle error [rad]; energy: largest relative energy error; final: angle error at the end"
        " (%(default)s)",
    )
    parser.add_argument(
        "--cost",
        choices=("evaluations", "seconds"),
        default="evaluations",
        help="force evaluations, or measured seconds, which are without Numba where a method is your own (%(default)s)",
    )
    parser.add_argument(
        "--target", metavar="ERROR", type=positive, help="find the cheapest method and h for this error"
    )
    parser.add_argument(
        "--budget", metavar="N", type=positive, help="limit of force evaluations; alone: find the least error within it"
    )
    parser.add_argument("--no-compiled", action="store_true", help="do not use Numba (results are identical)")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="one JSON object, SI units")
    add_file(form, "--csv", metavar="FILE", nargs="?", const="-", help="the points as CSV, to stdout or a file")
    parser.add_argument("--force", action="store_true", help="overwrite FILE")


def times(text: str) -> list[float]:
    """One time or several [s], ascending."""
    values = sorted({positive(part) for part in text.split(",")})
    if values[-1] > LONGEST:
        raise argparse.ArgumentTypeError(f"{text!r} is out of range; use at most {LONGEST:g} s")
    return values


def h_values(text: str) -> tuple[float, float, int]:
    """The ends of a ladder [s] and its rungs, from A:B:N."""
    match text.split(":"):
        case [first, last, many] if count(many) <= MOST_RUNGS:
            return max(positive(first), positive(last)), min(positive(first), positive(last)), count(many)
    raise argparse.ArgumentTypeError(f"{text!r} is not a list of step sizes; use A:B:N, for example 0.2:0.001:10")


def run(options: argparse.Namespace) -> int:
    """Measure, recommend, print.  Ctrl+C keeps what is done."""
    from engine.accuracy.references import with_all_methods
    from engine.accuracy.study import compilable, usual

    if options.all and options.methods is not None:
        raise UserError("--all and --methods exclude each other; choose one of them.")
    scene = general_scene_of(options)
    if options.all:
        scene = with_all_methods(scene)
    if scene.theta == scene.omega == 0:
        raise UserError("the pendulum hangs at rest, so there is no error to measure; use another --theta or --omega.")
    times = options.time or [usual(scene)[0]]
    rungs = _ladder(scene, times[-1], options.h_values, options.all)
    budget = None if options.budget is None else int(options.budget)
    if budget is not None and budget > MOST_BUDGET:
        raise UserError(f"--budget {options.budget:g} would take hours; use at most {MOST_BUDGET:g} evaluations.")
    if budget == 0:
        raise UserError(f"--budget {options.budget:g} is too small; use at least 1 force evaluation.")
    from engine.run.compiled import available
    from tui.commands.studies.reports.accuracy import Findings, print_csv, print_json, print_text

    found = Findings(scene, times[-1], options.error, options.cost, options.target, budget, all=options.all)
    file = None if options.csv in (None, "-") else Path(options.csv)
    with text_file(file, options.force) as out:
        try:
            fast = available() if options.cost == "evaluations" else compilable(scene.cast)
            _fill(found, times, rungs, fast and not options.no_compiled)
        except KeyboardInterrupt:
            if file and not found.points:
                raise
            found.interrupted = True
        if options.csv:
            print_csv(found, out)
        elif options.json:
            print_json(found)
        else:
            print_text(found)
    if file:
        print(f"{file}: {len(found.points)} points.")
    if found.interrupted:
        warn("interrupted; partial results are kept.")
        return Exit.INTERRUPTED
    return Exit.FINE


def _fill(found: "Findings", times: list[float], rungs: list[int], fast: bool) -> None:
    """Find what was asked for; what is found by an interrupt stays found."""
    from engine.accuracy.growth import growth
    from engine.accuracy.references import references
    from engine.accuracy.study import Study, orders, timed
    from engine.run import compiled, loops

    study, cast = Study(found.scene, found.time, compiled.tiered if fast else loops.plain), found.scene.cast
    with progress("measuring") as show:
        for point in study.points(rungs):
            if found.cost == "seconds":
                point = timed(point, found.scene, time.perf_counter, compiled.compiled if fast else loops.plain)
            found.points.append(point)
            show(sum(point.steps for point in found.points), len(cast) * sum(rungs))
    if found.all and found.cost == "seconds":
        found.references = references(found.scene, found.time, time.perf_counter, fast)
    found.orders += orders(found.scene, found.time, study.loops)
    found.growth += (growth(found.scene, method) for method in cast)
    if not (found.target or found.budget):
        return
    with progress("searching") as show:
        for number, duration in enumerate(times):
            there = study if duration == study.time else Study(found.scene, duration, study.loops)

            def show_share(share: float, done: int = number) -> None:
                show(done + share, len(times))

            found.advice.append(_advice(found, there, fast, show_share))


def _advice(found: "Findings", study: "Study", fast: bool, show: Callable[[float], None]) -> "Advice":
    """What is recommended for the time of a study."""
    from engine.accuracy.advice import least_error, least_evaluations, least_seconds, with_saving_over_rk4
    from engine.run import compiled, loops

    if not found.target:
        return least_error(study, found.kind, found.budget or 0, show)
    wish = study, found.kind, found.target, found.budget, show
    if found.cost == "evaluations":
        advice = least_evaluations(*wish)
    else:
        steps = compiled.compiled if fast else loops.plain
        advice = least_seconds(*wish, time.perf_counter, steps)
    return with_saving_over_rk4(advice, study, found.kind, found.target) if found.all else advice


def _ladder(scene: Scene, time: float, given: tuple[float, float, int] | None, all: bool) -> list[int]:
    """The numbers of steps to measure; for all methods, from where the most accurate ones begin."""
    from engine.accuracy.study import ALL_LADDER, Z_LADDER, ladder

    z_max, z_min, count = ALL_LADDER if all else Z_LADDER
    largest, smallest, rungs = given or (min(z_max / scene.w0, time), z_min / scene.w0, count)
    for h in (largest, smallest):
        check_h(h, scene.w0)
    if given and largest > time:
        raise UserError(f"h = {largest:g} s is longer than the time of {time:g} s; use a longer --time.")
    if time / smallest > MOST_STEPS:
        raise UserError(f"{time:g} s in steps of {smallest:.2g} s take hours; use --h-values, for example 0.2:0.01:8.")
    return ladder(time, largest, smallest, rungs)
