"""Run a scene without a screen, as fast as it goes, and judge each method."""

import argparse
import math
import sys
import time
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from engine.methods import METHODS
from engine.scenes import Scene
from tui.cli.errors import Exit, UserError
from tui.cli.files import check_free
from tui.cli.options import add_scene_options, count, positive, scene_of
from tui.cli.output import print_table, progress, scene_fields, write_json
from tui.words.numbers import file_size

if TYPE_CHECKING:
    from engine.run.lockstep import Sample
    from engine.run.observer import RunObserver
    from tui.cli.fail_if import Gate

EXAMPLES = """\
examples:
  pendu-tui run --time 100
  pendu-tui run --scene crossover --time 100 --record crossover.mcap
  pendu-tui run --theta 170deg --time 60 --json | jq '.methods[] | {method, verdict}'
  pendu-tui run --time 60 --fail-if 'velocity_verlet.max_energy_error > 1e-2 or rk4.drift_per_second < -1e-5'
  pendu-tui run --time 600 --fail-if 'velocity_verlet.verdict != bounded'
"""

LONGEST = 1e9  # s, 30 years; a recording's clock ends there, too
LARGE = 200e6  # bytes of a recording that nobody expects; half a minute to write
SAMPLE_BYTES = 320  # of a recording, measured with h from 0.01 to 0.05 s
MOST_SAMPLES = 20_000  # of a run that is not recorded: enough for every verdict, and constant work beside the steps
AT_ONCE = 1_000_000  # steps, about a second: nobody is heard in between


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add this command's options."""
    add_scene_options(parser)
    parser.add_argument(
        "--time", metavar="S", type=positive, required=True, help="simulated time in s, rounded to whole steps"
    )
    parser.add_argument("--record", metavar="FILE", type=Path, help="record it: the same run gives the same bytes")
    parser.add_argument("--force", action="store_true", help="overwrite FILE")
    parser.add_argument(
        "--sample-every", metavar="STEPS", type=count, help="steps from sample to sample (those of 1/30 s)"
    )
    parser.add_argument(
        "--fail-if",
        metavar="EXPR",
        help="exit 1 if METHOD.FIELD > NUMBER or METHOD.verdict == WORD, fields as in --json",
    )
    parser.add_argument("--no-compiled", action="store_true", help="do without Numba; the numbers are the same")
    parser.add_argument("--json", action="store_true", help="one JSON object, SI units")


def run(options: argparse.Namespace) -> int:
    """Simulate, record, judge, print."""
    scene, gate = scene_of(options), _gate(options.fail_if)
    from recordings.headless import SAMPLE_EVERY, steps_for

    if options.time > LONGEST:
        raise UserError(f"--time {options.time:g} is out of range: give {LONGEST:g} s or less.")
    steps = steps_for(scene, options.time)
    if steps == 0:
        raise UserError(f"--time {options.time:g} s is not even one step of {scene.h:g} s: give a longer time.")
    every = max(1, round(SAMPLE_EVERY / scene.h), 0 if options.record else steps // MOST_SAMPLES)
    every = options.sample_every or min(every, AT_ONCE)
    if options.record:
        check_free(options.record, options.force)
        _announce(steps, every)
    began = time.perf_counter()
    sample, observer, stopped = _simulate(scene, options, steps, every)
    wall_seconds = time.perf_counter() - began
    rows = _rows(sample, observer)
    if options.json:
        fields = {"scene": scene_fields(scene), "time": sample.t, "steps": sample.step, "wall_seconds": wall_seconds}
        write_json("run", {**fields, "methods": rows})
    else:
        _print(scene, sample, wall_seconds, rows)
    if stopped:
        print(
            f"pendu-tui: interrupted at t = {sample.t:g} s; the result is that of the time until then.", file=sys.stderr
        )
        return Exit.INTERRUPTED
    if gate and gate.holds({row["method"]: row for row in rows}):
        print(f"pendu-tui: the check failed: {options.fail_if}", file=sys.stderr)
        return Exit.CHECK_FAILED
    return Exit.FINE


def _announce(steps: int, every: int) -> None:
    """Say so before a recording gets large."""
    if (size := steps / every * SAMPLE_BYTES) > LARGE:
        enough = math.ceil(steps * SAMPLE_BYTES / LARGE)
        print(
            f"pendu-tui: the recording will have about {file_size(round(size))};"
            f" with --sample-every {enough} it has {file_size(round(LARGE))}.",
            file=sys.stderr,
        )


def _gate(expression: str | None) -> "Gate | None":
    from tui.cli.fail_if import GateError, parse

    try:
        return parse(expression) if expression is not None else None
    except GateError as error:
        raise UserError(f"--fail-if: {error}") from error


def _simulate(scene: Scene, options: argparse.Namespace, steps: int, every: int) -> "tuple[Sample, RunObserver, bool]":
    """The last sample, what was observed, and whether somebody stopped it before its end."""
    from engine.run import compiled, loops
    from engine.run.observer import RunObserver
    from recordings.headless import simulate
    from tui.cli.interrupt import stop_requests

    recorder: Any = nullcontext()
    if options.record:
        from recordings.recorder import Recorder

        recorder = Recorder(options.record, wall=None, overwrite=options.force)
    observer = RunObserver(scene)
    fitting = loops.plain if options.no_compiled else partial(compiled.tiered, ahead=steps)
    with stop_requests() as stopped, progress(f"{steps} steps") as show, recorder as recording:
        for sample in simulate(scene, options.time, recording, every, loops=fitting):
            observer.add(sample)
            show(sample.step, steps)
            if stopped() and sample.step < steps:
                return sample, observer, True
    return sample, observer, False


def _rows(sample: "Sample", observer: "RunObserver") -> list[dict[str, Any]]:
    """What became of each method.  A method that diverged has no theta to compare."""
    from engine.accuracy.study import evaluations

    exact = observer.exact.at(sample.t).theta
    rows = []
    for method, reading, judgement in zip(METHODS, sample.readings, observer.judgements, strict=True):
        end = reading.diverged_at
        rows.append(
            {
                "method": method.key,
                "theta": reading.theta,
                "omega": reading.omega,
                "energy": reading.energy,
                "energy_error": reading.energy_error,
                "max_energy_error": reading.max_energy_error,
                "theta_error": abs(reading.theta - exact) if end is None else None,
                "drift_per_second": judgement.slope,
                "verdict": judgement.verdict,
                "force_evaluations": evaluations(method, sample.step if end is None else round(end / observer.scene.h)),
                "diverged_at": end,
            }
        )
    return rows


def _print(scene: Scene, sample: "Sample", wall_seconds: float, rows: list[dict[str, Any]]) -> None:
    numbers = ", ".join(f"{name} {getattr(scene, name):g}" for name in ("theta", "omega", "length", "gravity", "h"))
    print(f"{scene.name}: {numbers} (SI units), z = h·w0 = {scene.z:.4g}")
    pace = f", {sample.step / wall_seconds / 1e6:.3g} million a second" if wall_seconds > 1 else ""
    print(f"{sample.step} steps to t = {sample.t:g} s in {wall_seconds:.2f} s{pace}\n")

    def number(value: float | None, form: str) -> str:
        return "-" if value is None else format(value, form)

    def verdict(row: dict[str, Any]) -> str:
        end = row["diverged_at"]
        return row["verdict"] if end is None else f"diverged at {end:g} s"

    print_table(
        "llrrrrr",
        ("method", "verdict", "energy error", "largest", "per second", "theta error [rad]", "force evaluations"),
        (
            (
                method.label,
                verdict(row),
                number(row["energy_error"], "+.2e"),
                number(row["max_energy_error"], ".2e"),
                number(row["drift_per_second"], "+.1e"),
                number(row["theta_error"], ".2e"),
                str(row["force_evaluations"]),
            )
            for method, row in zip(METHODS, rows, strict=True)
        ),
    )
