"""One run, its numbers, its table and its sentences."""

import math
import time
from argparse import Namespace
from collections.abc import Sequence
from contextlib import nullcontext
from functools import partial
from typing import Any

from engine.methods import Method
from engine.run import compiled, loops
from engine.run.judgement import Judgement, Progress
from engine.run.lockstep import Lockstep, Reading, Sample
from engine.scenes import Scene
from recordings.errors import printable
from recordings.fields import NUMBERS, OPTIONAL
from recordings.headless import SAMPLE_EVERY, simulate, steps_for
from recordings.recorder import Recorder
from tui.cli.checks import Check, Gate, conclude
from tui.cli.errors import Exit
from tui.cli.files import check_free, stop_requests
from tui.cli.report import (
    Column,
    Report,
    fields_of,
    method_column,
    progress,
    publish,
    scene_line,
    warn,
)
from tui.commands.studies import figures
from tui.words.insight import irregular, milestone_insight, sentence
from tui.words.numbers import file_size, z_text

MAX_BATCH = 100_000  # steps, a fifth of a second; Ctrl+C is noticed between batches
MAX_POINTS = 20_000  # of a figure, from which it takes the largest

Row = dict[str, Any]


def run_one(scene: Scene, options: Namespace, gate: Gate | None, is_figure: bool) -> Exit:
    if options.record:
        check_free(options.record, options.force)
    steps = steps_for(scene, options.time)
    lockstep = lockstep_of(scene, steps, not options.no_compiled)
    began = time.perf_counter()
    samples = _simulate(lockstep, options, steps, is_figure)
    wall_seconds = time.perf_counter() - began
    sample = samples[-1]
    is_whole = sample.step == steps
    rows = rows_of(scene, sample, lockstep, is_whole)
    if options.record:
        size = file_size(options.record.stat().st_size)
        warn(f"recorded {sample.t:g} s, {size}: {printable(str(options.record))}")
    if is_figure:
        figures.draw_run(options, scene, samples[1:] or samples)
    else:
        publish(_report(scene, sample, lockstep, rows, wall_seconds), options)
    if not is_whole:
        warn(f"interrupted at t = {sample.t:g} s, showing the results up to then.")
        return Exit.INTERRUPTED
    check = check_of(f"{scene.name}: {options.fail_if or 'no check'}", rows, gate)
    return conclude(options, f"pendu-tui run {scene.name}", [check])


def lockstep_of(scene: Scene, expected_steps: int, is_compiled: bool) -> Lockstep:
    """Return the lockstep of a run, in machine code where that pays."""
    if not is_compiled:
        return Lockstep(scene, judged=True)
    tiered = partial(compiled.TieredLoops, expected_steps=expected_steps)
    return Lockstep(scene, loops=tiered, judged=True)


def _simulate(lockstep: Lockstep, options: Namespace, steps: int, is_figure: bool) -> list[Sample]:
    """Run to the end, or until a signal; return the last sample, or for a figure all of them."""
    scene = lockstep.scene
    batch = MAX_BATCH
    if options.method:  # the user's own may be slow, and Ctrl+C waits
        batch = 16
    every = options.sample_every or batch
    recorder: Any = nullcontext()
    if options.record:
        every = options.sample_every or min(batch, max(1, round(SAMPLE_EVERY / scene.h)))
        recorder = Recorder(options.record, wall=None, overwrite=options.force)
    if is_figure:
        every = min(every, math.ceil(steps / MAX_POINTS))
    samples: list[Sample] = []
    with stop_requests() as stopped, progress(f"{steps:,} steps") as show, recorder as recording:
        for sample in simulate(scene, options.time, recording, every, lockstep=lockstep):
            show(sample.step, steps)
            if not is_figure:
                samples.clear()
            samples.append(sample)
            if stopped():
                break
    return samples


def rows_of(scene: Scene, sample: Sample, lockstep: Lockstep, is_whole: bool) -> list[Row]:
    """Return the results by method, as in --json.

    Where evaluations vary they are counted, by running again, unless the run was interrupted.
    """
    exact = scene.exact().at(sample.t).theta
    each = zip(scene.cast, sample.readings, lockstep.judgements, strict=True)
    return [_row(scene, sample.step, exact, is_whole, *one) for one in each]


def _row(
    scene: Scene,
    steps: int,
    exact: float,
    is_whole: bool,
    method: Method,
    reading: Reading,
    judgement: Judgement,
) -> Row:
    model = scene.equations
    error = abs(model.theta_error(reading.theta, exact))
    if reading.diverged_at is not None:  # no theta to compare
        steps = round(reading.diverged_at / scene.h)
        error = math.nan
    evaluations = method.evaluations(steps)
    if method.varies and reading.diverged_at is None and steps and is_whole:
        start = model.start(scene.theta, scene.omega)
        evaluations = loops.count_evaluations(method, model, start, scene.h, steps)
    row = {"method": method.key, **fields_of(reading, *NUMBERS)}
    if not model.energy_error.conserved:
        row["log_energy_error"] = reading.energy_error
    optional = fields_of(reading, *OPTIONAL)
    row |= {name: value for name, value in optional.items() if value is not None}
    row |= {variable.name: reading.extra.get(variable.name) for variable in model.variables}
    return row | {
        "theta_error": None if math.isnan(error) else error,
        "drift_per_second": judgement.slope,
        "verdict": judgement.verdict,
        "progress": judgement.progress and judgement.progress._asdict(),
        "lyapunov_per_second": judgement.lyapunov,
        "force_evaluations": evaluations,
        "diverged_at": reading.diverged_at,
    }


def check_of(name: str, rows: Sequence[Row], gate: Gate | None) -> Check:
    found = ", ".join(f"{row['method']} {verdict_of(row)}" for row in rows)
    failure = gate and gate({row["method"]: row for row in rows})
    return Check(name, found, failure or None)


def _report(
    scene: Scene, sample: Sample, lockstep: Lockstep, rows: Sequence[Row], wall_seconds: float
) -> Report:
    notes = [
        sentence(milestone_insight(each, scene.equations.energy_error.conserved))
        for each in lockstep.milestones
        if each.kind in ("over the top", "errors cross")
    ]
    for method, judgement in zip(scene.cast, lockstep.judgements, strict=True):
        if judgement.lyapunov and (found := irregular(method, judgement, 0.0)):
            notes.append(sentence(found))
    return Report(
        name="run",
        title=f"{scene_line(scene, 'h')}, {z_text(scene)}\n"
        f"{sample.step} steps to t = {sample.t:g} s in {wall_seconds:.2f} s\n",
        columns=columns_of(scene, Column("per second", "drift_per_second", "+.1e")),
        rows=rows,
        notes=notes,
        fields={
            "scene": scene.fields(),
            "time": sample.t,
            "steps": sample.step,
            "wall_seconds": wall_seconds,
            "methods": for_json(rows),
        },
        records=for_csv(rows),
    )


def for_json(rows: Sequence[Row]) -> list[Row]:
    """Return rows for JSON, where only an irregular orbit has a Lyapunov number."""
    lyapunov = "lyapunov_per_second"
    return [{name: row[name] for name in row if name != lyapunov or row[name]} for row in rows]


def for_csv(rows: Sequence[Row]) -> list[Row]:
    return [{name: row[name] for name in row if name != "progress"} for row in rows]


def columns_of(scene: Scene, *trend: Column) -> list[Column]:
    return [
        method_column(scene.cast),
        Column("verdict", verdict_of),
        *(Column(each.label, each.name, ".4g") for each in scene.equations.quantities()),
        Column(scene.equations.energy_error.name, "energy_error", "+.2e"),
        Column("largest", "max_energy_error", ".2e"),
        *trend,
        Column("last theta error [rad]", "theta_error", ".2e"),
        Column("force evaluations", "force_evaluations", "d"),
    ]


def verdict_of(row: Row) -> str:
    """Return the verdict, how much of the evidence there is, or when the method failed."""
    if row["diverged_at"] is not None:
        return f"failed at {row['diverged_at']:g} s"
    if row["progress"] is None:
        return str(row["verdict"])
    return str(Judgement(row["verdict"], progress=Progress(**row["progress"])))
