"""Run a scene without the TUI, as fast as possible, and judge each method."""

import argparse
import math
import time
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from engine.methods import METHODS
from engine.scenes import Scene
from recordings.errors import printable
from tui.cli.errors import Exit, UserError
from tui.cli.fail_if import FIELDS, parse
from tui.cli.files import check_free, stop_requests
from tui.cli.options import Suggestions, add_file, count, positive
from tui.cli.output import fields_of, print_lines, progress, scene_line, warn, write_json
from tui.cli.report import print_table
from tui.cli.scene import add_scene_options, scene_of
from tui.words.numbers import file_size, z_name

if TYPE_CHECKING:
    from engine.run.lockstep import Lockstep, Sample

EXAMPLES = """\
examples:
  pendu-tui run --time 100
  pendu-tui run --scene crossover --time 100 --record crossover.mcap
  pendu-tui run --time 60 --methods rk4,verlet --method mine.py:my_step,letter=m
  pendu-tui run --theta 170deg --time 60 --json | jq '.methods[] | {method, verdict}'
  pendu-tui run --time 60 --fail-if 'velocity_verlet.max_energy_error > 1e-2 or rk4.drift_per_second < -1e-5'
  pendu-tui run --time 600 --fail-if 'velocity_verlet.verdict != bounded'

Verdicts know the method and its step, and may be slower than those of judge, which sees energies only: an energy that
grew and stopped is called grows for 4096 steps, then caught.
"""

LONGEST = 1e9  # s, 30 years; a recording's clock ends there, too
LARGE = 200e6  # bytes of a recording that deserve a warning; half a minute to write
SAMPLE_BYTES = 320  # of a recording, measured with h from 0.01 to 0.05 s
MOST_SAMPLES = 20_000  # of a run that is not recorded: enough for every verdict, and little work next to the steps
AT_ONCE = 1_000_000  # steps in a batch, about a second; Ctrl+C is only seen between batches


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument(
        "--time", metavar="S", type=positive, help="simulated time in s, rounded to whole steps; required"
    )
    add_file(parser, "--record", metavar="FILE", type=Path, help="record to FILE (identical runs give identical files)")
    parser.add_argument("--force", action="store_true", help="overwrite FILE")
    parser.add_argument("--sample-every", metavar="N", type=count, help="record every N steps (default: every 1/30 s)")
    parser.add_argument(
        "--fail-if",
        metavar="EXPR",
        choices=Suggestions(f"{method.key}.{field}" for method in METHODS for field in (*FIELDS, "verdict")),
        help="exit 1 if the expression is true, e.g. rk4.max_energy_error > 1e-3 (fields: see --json)",
    )
    parser.add_argument("--no-compiled", action="store_true", help="do not use Numba (results are identical)")
    parser.add_argument("--json", action="store_true", help="one JSON object, SI units")


def run(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    gate = None if options.fail_if is None else parse(options.fail_if, cast=scene.cast)
    from recordings.headless import SAMPLE_EVERY, steps_for

    if options.time is None:  # said last: argparse would say it before what else is wrong
        raise UserError("--time is missing: how many seconds to simulate, for example --time 60.")
    if options.time > LONGEST:
        raise UserError(f"--time {options.time:g} is out of range; use at most {LONGEST:g} s.")
    steps = steps_for(scene, options.time)
    if steps == 0:
        raise UserError(f"--time {options.time:g} s is shorter than one step of {scene.h:g} s; use a longer time.")
    every = max(1, round(SAMPLE_EVERY / scene.h), 0 if options.record else steps // MOST_SAMPLES)
    every = options.sample_every or min(every, AT_ONCE)
    if options.record:
        check_free(options.record, options.force)
        _announce(steps, every)
    began = time.perf_counter()
    sample, lockstep, stopped = _simulate(scene, options, steps, every)
    wall_seconds = time.perf_counter() - began
    rows = _rows(scene, sample, lockstep, stopped)
    if options.record:
        warn(f"recorded {sample.t:g} s, {file_size(options.record.stat().st_size)}: {printable(str(options.record))}")
    if options.json:
        fields = {"scene": scene.fields(), "time": sample.t, "steps": sample.step, "wall_seconds": wall_seconds}
        write_json("run", {**fields, "methods": rows})
    else:
        _print(scene, sample, wall_seconds, rows, lockstep)
    if stopped:
        warn(f"interrupted at t = {sample.t:g} s, showing the results up to then.")
        return Exit.INTERRUPTED
    if gate and (found := gate({row["method"]: row for row in rows})):
        warn(f"the check failed: {options.fail_if} ({found})")
        return Exit.CHECK_FAILED
    return Exit.FINE


def _announce(steps: int, every: int) -> None:
    """Warn before a recording gets large."""
    if (size := steps / every * SAMPLE_BYTES) > LARGE:
        enough, large = math.ceil(steps * SAMPLE_BYTES / LARGE), file_size(round(LARGE))
        warn(
            f"the recording will be about {file_size(round(size))}; --sample-every {enough} would reduce it to {large}."
        )


def _simulate(scene: Scene, options: argparse.Namespace, steps: int, every: int) -> "tuple[Sample, Lockstep, bool]":
    """The last sample, its lockstep with the verdicts, and whether a signal stopped the run before its end."""
    from engine.run import compiled, loops
    from engine.run.lockstep import Lockstep
    from recordings.headless import simulate

    recorder: Any = nullcontext()
    if options.record:
        from recordings.recorder import Recorder

        recorder = Recorder(options.record, wall=None, overwrite=options.force)
    fitting = loops.PlainLoops if options.no_compiled else partial(compiled.TieredLoops, expected_steps=steps)
    lockstep = Lockstep(scene, loops=fitting, judged=True)
    with stop_requests() as stopped, progress(f"{steps:,} steps") as show, recorder as recording:
        for sample in simulate(scene, options.time, recording, every, lockstep=lockstep):
            show(sample.step, steps)
            if stopped() and sample.step < steps:
                return sample, lockstep, True
    return sample, lockstep, False


def _rows(scene: Scene, sample: "Sample", lockstep: "Lockstep", stopped: bool) -> list[dict[str, Any]]:
    """The results by method, as in --json.  A method that diverged has no theta to compare.

    Where evaluations vary they are counted, by running again, unless somebody waits for the end.
    """
    from engine.run.loops import count_evaluations
    from recordings.fields import NUMBERS

    exact = scene.exact().at(sample.t).theta
    rows = []
    for method, reading, judgement in zip(scene.cast, sample.readings, lockstep.judgements, strict=True):
        end, off = reading.diverged_at, scene.equations.theta_error(reading.theta, exact)
        steps = sample.step if end is None else round(end / scene.h)
        evaluations = method.evaluations(steps)
        if method.varies and end is None and steps and not stopped:
            start = scene.equations.start(scene.theta, scene.omega)
            evaluations = count_evaluations(method, scene.equations, start, scene.h, steps)
        rows.append(
            {
                "method": method.key,
                **fields_of(reading, *NUMBERS),
                "log_energy_error": None if scene.equations.energy_error.conserved else reading.energy_error,
                "spring_energy": reading.extra.get("spring_energy"),
                "theta_error": None if math.isnan(off) or end is not None else abs(off),
                "drift_per_second": judgement.slope,
                "verdict": judgement.verdict,
                "lyapunov_per_second": judgement.lyapunov,
                "force_evaluations": evaluations,
                "diverged_at": end,
            }
        )
    return rows


def _print(
    scene: Scene,
    sample: "Sample",
    wall_seconds: float,
    rows: list[dict[str, Any]],
    lockstep: "Lockstep",
) -> None:
    print_lines(f"{scene_line(scene, 'h')}, {z_name(scene.model)} = {scene.z:.4g}")
    pace = f", {sample.step / wall_seconds / 1e6:.3g} million a second" if wall_seconds > 1 else ""
    print(f"{sample.step} steps to t = {sample.t:g} s in {wall_seconds:.2f} s{pace}\n")
    from tui.words.insight import irregular_insight, milestone_insight, sentence

    forms = {"spring_energy": ".4g"} if scene.model == "spring" else {}
    forms |= {"energy_error": "+.2e", "max_energy_error": ".2e", "drift_per_second": "+.1e", "theta_error": ".2e"}
    table = []
    for method, row, judgement in zip(scene.cast, rows, lockstep.judgements, strict=True):
        end, row = row["diverged_at"], row | {"drift_per_second": judgement.trend}
        numbers = ("-" if row[name] is None else format(row[name], form) for name, form in forms.items())
        verdict = row["verdict"] if end is None else f"diverged at {end:g} s"
        table.append((method.label, verdict, *numbers, str(row["force_evaluations"])))
    error = "energy error" if scene.equations.energy_error.conserved else "ln(E/E_true)"
    spring = ("in the spring",) if scene.model == "spring" else ()
    headers = (*spring, error, "largest", "per second", "theta error [rad]", "force evaluations")
    print_table("ll" + "r" * len(headers), ("method", "verdict", *headers), table)
    for each in lockstep.milestones:
        if each.kind in ("over the top", "errors cross"):
            print(sentence(milestone_insight(each, scene.equations.energy_error.conserved)))
    for method, judgement in zip(scene.cast, lockstep.judgements, strict=True):
        if judgement.lyapunov and (found := irregular_insight(method, judgement, 0.0)):
            print(sentence(found))
