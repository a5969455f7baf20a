"""Run a scene without the TUI, as fast as possible, and judge each method."""

import argparse
import math
import time
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from engine.methods import METHODS
from engine.run.judgement import DEFINITIONS
from engine.scenes import Scene
from recordings.errors import printable
from tui.cli.errors import Exit, UserError
from tui.cli.fail_if import FIELDS, parse
from tui.cli.files import check_free, stop_requests
from tui.cli.options import Suggestions, add_file, count, positive
from tui.cli.output import progress, warn
from tui.cli.report import Report, add_report_options, form_of
from tui.cli.scene import add_scene_options, scene_of
from tui.commands.studies.reports.run import columns_of, notes_of, rows_of, title_of
from tui.words.numbers import file_size

if TYPE_CHECKING:
    from engine.run.lockstep import Lockstep, Sample

EXAMPLES = """\
examples:
  pendu-tui run --time 100
  pendu-tui run --scene crossover --time 100 --record crossover.mcap
  pendu-tui run --time 60 --methods rk4,verlet --method mine.py:my_step,letter=m
  pendu-tui run --theta 170deg --time 60 --json | jq '.methods[] | {method, verdict}'
  pendu-tui run --time 60 --fail-if 'rk4.max_energy_error > 1e-2 or rk4.verdict == grows'

verdicts:
""" + "\n".join(f"  {verdict}: {text}" for verdict, text in DEFINITIONS.items())

MAX_TIME = 1e9  # s, 30 years; a recording's clock ends there, too
LARGE = 200e6  # bytes of a recording that deserve a warning; half a minute to write
SAMPLE_BYTES = 320  # of a recording, measured with h from 0.01 to 0.05 s
MAX_BATCH = 1_000_000  # steps, about a second; Ctrl+C is noticed between batches


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument("--time", metavar="S", type=positive, help="simulated time in s; required")
    add_file(
        parser,
        "--record",
        metavar="FILE",
        type=Path,
        help="record to FILE (the same bytes each time)",
    )
    parser.add_argument("--force", action="store_true", help="overwrite FILE")
    parser.add_argument(
        "--sample-every",
        metavar="N",
        type=count,
        help="record every N steps (default: every 1/30 s)",
    )
    names = (f"{method.key}.{field}" for method in METHODS for field in (*FIELDS, "verdict"))
    parser.add_argument(
        "--fail-if",
        metavar="EXPR",
        choices=Suggestions(names),
        help="exit 1 if it is true, e.g. rk4.max_energy_error > 1e-3 (fields: see --json)",
    )
    parser.add_argument(
        "--no-compiled", action="store_true", help="do not use Numba (same results)"
    )
    add_report_options(parser, csv=True)


def run(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    gate = None if options.fail_if is None else parse(options.fail_if, cast=scene.cast)
    steps = _steps(scene, options.time)
    if options.record:
        check_free(options.record, options.force)
    began = time.perf_counter()
    sample, lockstep, stopped = _simulate(scene, options, steps)
    wall_seconds = time.perf_counter() - began
    rows = rows_of(scene, sample, lockstep, stopped)
    if options.record:
        size = file_size(options.record.stat().st_size)
        warn(f"recorded {sample.t:g} s, {size}: {printable(str(options.record))}")
    Report(
        name="run",
        title=title_of(scene, sample, wall_seconds),
        columns=columns_of(scene, lockstep),
        rows=rows,
        notes=notes_of(scene, lockstep),
        fields={
            "scene": scene.fields(),
            "time": sample.t,
            "steps": sample.step,
            "wall_seconds": wall_seconds,
            "methods": rows,
        },
    ).show(form_of(options))
    if stopped:
        warn(f"interrupted at t = {sample.t:g} s, showing the results up to then.")
        return Exit.INTERRUPTED
    if gate and (found := gate({row["method"]: row for row in rows})):
        warn(f"the check failed: {options.fail_if} ({found})")
        return Exit.CHECK_FAILED
    return Exit.FINE


def _steps(scene: Scene, seconds: float | None) -> int:
    """Return the steps of the run.  Raises UserError if there are none, or far too many."""
    from recordings.headless import steps_for

    if seconds is None:  # last: argparse would say it before what else is wrong
        raise UserError("--time is missing: how many seconds to simulate, for example --time 60.")
    if seconds > MAX_TIME:
        raise UserError(f"--time {seconds:g} is out of range; use at most {MAX_TIME:g} s.")
    steps = steps_for(scene, seconds)
    if steps == 0:
        raise UserError(
            f"--time {seconds:g} s is shorter than one step of {scene.h:g} s; use a longer time."
        )
    return steps


def _simulate(
    scene: Scene, options: argparse.Namespace, steps: int
) -> "tuple[Sample, Lockstep, bool]":
    """Return the last sample, its lockstep, and whether a signal stopped the run before its end."""
    from engine.run import compiled, loops
    from engine.run.lockstep import Lockstep
    from recordings.headless import SAMPLE_EVERY, simulate

    every = options.sample_every or MAX_BATCH
    recorder: Any = nullcontext()
    if options.record:
        from recordings.recorder import Recorder

        every = options.sample_every or min(MAX_BATCH, max(1, round(SAMPLE_EVERY / scene.h)))
        _warn_of_size(steps, every)
        recorder = Recorder(options.record, wall=None, overwrite=options.force)
    tiered = partial(compiled.TieredLoops, expected_steps=steps)
    lockstep = Lockstep(
        scene, loops=loops.PlainLoops if options.no_compiled else tiered, judged=True
    )
    with stop_requests() as stopped, progress(f"{steps:,} steps") as show, recorder as recording:
        for sample in simulate(scene, options.time, recording, every, lockstep=lockstep):
            show(sample.step, steps)
            if stopped() and sample.step < steps:
                return sample, lockstep, True
    return sample, lockstep, False


def _warn_of_size(steps: int, every: int) -> None:
    """Warn before a recording gets large."""
    size = steps / every * SAMPLE_BYTES
    if size > LARGE:
        enough = math.ceil(steps * SAMPLE_BYTES / LARGE)
        about, large = file_size(round(size)), file_size(round(LARGE))
        advice = f"--sample-every {enough} would reduce it to {large}"
        warn(f"the recording will be about {about}; {advice}.")
