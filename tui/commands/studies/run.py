"""Run a scene without the TUI, as fast as possible, and judge each method."""

import argparse
import math
import time
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from engine.methods import METHODS
from engine.run.judgement import DEFINITIONS
from engine.scenes import Scene
from recordings.errors import printable
from tui.cli.errors import Exit, UserError
from tui.cli.fail_if import FIELDS, Gate, parse
from tui.cli.files import check_free, stop_requests
from tui.cli.junit import Check, add_check_options, conclude
from tui.cli.options import add_file, count, duration
from tui.cli.output import progress, warn
from tui.cli.report import Report, add_report_options, publish
from tui.cli.scene import add_scene_options, scenes_of
from tui.cli.workers import add_worker_options
from tui.commands.studies.reports import figures
from tui.commands.studies.reports.run import (
    columns_of,
    known,
    notes_of,
    rows_of,
    title_of,
    verdict_of,
)
from tui.words.numbers import file_size

if TYPE_CHECKING:
    from engine.run.lockstep import Lockstep, Sample

EXAMPLES = """\
examples:
  pendu-tui run --time 100
  pendu-tui run --scene crossover --time 100 --record crossover.mcap
  pendu-tui run --time 60 --methods rk4,verlet --method mine.py:my_step,letter=m
  pendu-tui run --theta 170deg --time 60 --json | jq '.methods[] | {method, verdict}'
  pendu-tui run --time 60 --fail-if 'rk4.max_energy_error > 1% or any.verdict == grows'
  pendu-tui run --theta 10deg:170deg:17 --h 0.01:0.5:50 --time 10min --workers 4 -o runs.csv

verdicts:
""" + "\n".join(f"  {verdict}: {text}" for verdict, text in DEFINITIONS.items())

MAX_TIME = 1e9  # s, 30 years; a recording's clock ends there, too
MAX_POINTS = 20_000  # of a figure, from which it takes the largest
LARGE = 200e6  # bytes of a recording that deserve a warning; half a minute to write
SAMPLE_BYTES = 320  # of a recording, measured with h from 0.01 to 0.05 s


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser, lists=True)
    add = parser.add_argument
    add("--time", metavar="S", type=duration, help="simulated time: 60 (s) or 1min; required")
    add_file(
        parser,
        "--record",
        metavar="FILE",
        type=Path,
        help="record to FILE (the same bytes each time)",
    )
    add(
        "--sample-every",
        metavar="N",
        type=count,
        help="record every N steps (default: every 1/30 s)",
    )
    names = (f"{method.key}.{field}" for method in METHODS for field in (*FIELDS, "verdict"))
    meaning = (
        "exit 1 if it is true, e.g. rk4.max_energy_error > 1e-3 or any.verdict == grows (fields: "
        "see --json)"
    )
    add_check_options(parser, names, meaning)
    add("--no-compiled", action="store_true", help="do not use Numba (same results)")
    add_report_options(parser, csv=True, files=(".csv", ".json", *figures.SUFFIXES))
    add("--resume", action="store_true", help="go on with the list of runs in FILE.csv.partial")
    add_worker_options(parser)


def run(options: argparse.Namespace) -> int:
    scenes = scenes_of(options)
    gate = None if options.fail_if is None else parse(options.fail_if, cast=scenes.base.cast)
    steps = [_steps(scene, options.time) for scene in scenes.corners()]
    if len(scenes) > 1:
        _check_list(options)
        from tui.commands.studies.lists import run_list

        return run_list(scenes, options, gate)
    (scene,) = scenes
    return _run(scene, options, gate, steps[0])


def _check_list(options: argparse.Namespace) -> None:
    """Refuse what a list of runs cannot do."""
    if figures.is_figure(options.output):
        raise UserError(
            f"{options.output} would be a figure of one run; use .csv, or give each number one "
            "value."
        )
    if options.record:
        raise UserError("--record is for one run; leave it out, or give each number one value.")
    is_csv = options.output and options.output.suffix.lower() == ".csv"
    if options.resume and not is_csv:
        raise UserError("--resume is for -o FILE.csv, the rows of a list of runs.")
    if options.resume and options.fail_if:
        raise UserError("--fail-if cannot see the runs of before; leave out --resume or --fail-if.")


def _run(scene: Scene, options: argparse.Namespace, gate: Gate | None, steps: int) -> int:
    """Run one scene and report it."""
    for path in (options.record, options.output):
        if path:
            check_free(path, options.force)
    curve: list[Sample] = []
    if figures.is_figure(options.output):
        figures.check(options.output, options.force)
    began = time.perf_counter()
    sample, lockstep, stopped = _simulate(scene, options, steps, curve)
    wall_seconds = time.perf_counter() - began
    rows = rows_of(scene, sample, lockstep, stopped)
    if options.record:
        size = file_size(options.record.stat().st_size)
        warn(f"recorded {sample.t:g} s, {size}: {printable(str(options.record))}")
    report = Report(
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
            "methods": [known(row) for row in rows],
        },
        records=[{name: row[name] for name in row if name != "progress"} for row in rows],
    )
    if curve:
        figures.draw_run(options.output, options.force, scene, curve)
    else:
        publish(report, options)
    if stopped:
        warn(f"interrupted at t = {sample.t:g} s, showing the results up to then.")
        return Exit.INTERRUPTED
    failure = gate({row["method"]: row for row in rows}) if gate else ""
    found = ", ".join(f"{row['method']} {verdict_of(row)}" for row in rows)
    check = Check(f"{scene.name}: {options.fail_if or 'no check'}", found, failure or None)
    return conclude(options, f"pendu-tui run {scene.name}", [check])


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
    scene: Scene, options: argparse.Namespace, steps: int, curve: "list[Sample]"
) -> "tuple[Sample, Lockstep, bool]":
    """Return the last sample, its lockstep, and whether a signal stopped the run before its end.

    For a figure, `curve` gets the samples.
    """
    from recordings.headless import SAMPLE_EVERY, simulate
    from tui.commands.studies.lists import MAX_BATCH, lockstep_of

    batch = 16 if options.method else MAX_BATCH  # a user's method may be slow, and Ctrl+C waits
    every = options.sample_every or batch
    recorder: Any = nullcontext()
    if options.record:
        from recordings.recorder import Recorder

        every = options.sample_every or min(batch, max(1, round(SAMPLE_EVERY / scene.h)))
        _warn_of_size(steps, every)
        recorder = Recorder(options.record, wall=None, overwrite=options.force)
    wants_curve = figures.is_figure(options.output)
    if wants_curve:
        every = min(every, math.ceil(steps / MAX_POINTS))
    lockstep = lockstep_of(scene, steps, not options.no_compiled)
    with stop_requests() as stopped, progress(f"{steps:,} steps") as show, recorder as recording:
        for sample in simulate(scene, options.time, recording, every, lockstep=lockstep):
            show(sample.step, steps)
            if wants_curve and sample.step:
                curve.append(sample)
            if stopped() and sample.step < steps:
                return sample, lockstep, True
    return sample, lockstep, False


def _warn_of_size(steps: int, every: int) -> None:
    """Warn before a recording gets large."""
    size = steps / every * SAMPLE_BYTES
    if size > LARGE:
        enough = math.ceil(steps * SAMPLE_BYTES / LARGE)
        about = file_size(round(size))
        large = file_size(round(LARGE))
        advice = f"--sample-every {enough} would reduce it to {large}"
        warn(f"the recording will be about {about}; {advice}.")
