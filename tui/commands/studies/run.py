"""One run, its numbers, its table and its sentences."""

import math
import time
from argparse import Namespace
from collections.abc import Sequence
from contextlib import nullcontext
from functools import partial
from typing import Any

from engine.run import compiled, loops
from engine.run.judgement import Judgement, Progress
from engine.run.lockstep import Lockstep, Sample
from engine.scenes import Scene
from recordings.errors import printable
from recordings.fields import NUMBERS, OPTIONAL
from recordings.headless import SAMPLE_EVERY, simulate, steps_for
from recordings.recorder import Recorder
from tui.cli.checks import Check, Gate, conclude
from tui.cli.errors import Exit
from tui.cli.files import stop_requests
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
    curve: list[Sample] = []
    steps = steps_for(scene, options.time)
    lockstep = lockstep_of(scene, steps, not options.no_compiled)
    began = time.perf_counter()
    sample = _simulate(lockstep, options, steps, curve if is_figure else None)
    wall_seconds = time.perf_counter() - began
    is_whole = sample.step == steps
    rows = rows_of(scene, sample, lockstep, is_whole)
    if options.record:
        size = file_size(options.record.stat().st_size)
        warn(f"recorded {sample.t:g} s, {size}: {printable(str(options.record))}")
    if is_figure:
        figures.draw_run(options, scene, curve)
    else:
        publish(_report(scene, sample, lockstep, rows, wall_seconds), options)
    if not is_whole:
        warn(f"interrupted at t = {sample.t:g} s, showing the results up to then.")
        return Exit.INTERRUPTED
    failure = gate({row["method"]: row for row in rows}) if gate else ""
    found = ", ".join(f"{row['method']} {verdict_of(row)}" for row in rows)
    check = Check(f"{scene.name}: {options.fail_if or 'no check'}", found, failure or None)
    return conclude(options, f"pendu-tui run {scene.name}", [check])


def lockstep_of(scene: Scene, expected_steps: int, is_compiled: bool) -> Lockstep:
    """Return the lockstep of a run, in machine code where that pays."""
    tiered = partial(compiled.TieredLoops, expected_steps=expected_steps)
    return Lockstep(scene, loops=tiered if is_compiled else loops.PlainLoops, judged=True)


def _simulate(
    lockstep: Lockstep, options: Namespace, steps: int, curve: list[Sample] | None
) -> Sample:
    """Run to the end, or until a signal; return the last sample, and append all to the curve."""
    scene = lockstep.scene
    batch = 16 if options.method else MAX_BATCH  # a user's method may be slow, and Ctrl+C waits
    every = options.sample_every or batch
    recorder: Any = nullcontext()
    if options.record:
        every = options.sample_every or min(batch, max(1, round(SAMPLE_EVERY / scene.h)))
        recorder = Recorder(options.record, wall=None, overwrite=options.force)
    if curve is not None:
        every = min(every, math.ceil(steps / MAX_POINTS))
    with stop_requests() as stopped, progress(f"{steps:,} steps") as show, recorder as recording:
        for sample in simulate(scene, options.time, recording, every, lockstep=lockstep):
            show(sample.step, steps)
            if curve is not None and sample.step:
                curve.append(sample)
            if stopped():
                break
    return sample


def rows_of(scene: Scene, sample: Sample, lockstep: Lockstep, is_whole: bool) -> list[Row]:
    """Return the results by method, as in --json.  A method that failed has no theta to compare.

    Where evaluations vary they are counted, by running again, unless the run was interrupted.
    """
    model = scene.equations
    exact = scene.exact().at(sample.t).theta
    rows = []
    for method, reading, judgement in zip(
        scene.cast, sample.readings, lockstep.judgements, strict=True
    ):
        end = reading.diverged_at
        error = model.theta_error(reading.theta, exact)
        steps = sample.step if end is None else round(end / scene.h)
        evaluations = method.evaluations(steps)
        if method.varies and end is None and steps and is_whole:
            start = model.start(scene.theta, scene.omega)
            evaluations = loops.count_evaluations(method, model, start, scene.h, steps)
        row = {"method": method.key, **fields_of(reading, *NUMBERS)}
        if not model.energy_error.conserved:
            row["log_energy_error"] = reading.energy_error
        optional = fields_of(reading, *OPTIONAL)
        row |= {name: value for name, value in optional.items() if value is not None}
        row |= {variable.name: reading.extra.get(variable.name) for variable in model.variables}
        rows.append(
            row
            | {
                "theta_error": None if math.isnan(error) or end is not None else abs(error),
                "drift_per_second": judgement.slope,
                "verdict": judgement.verdict,
                "progress": judgement.progress and judgement.progress._asdict(),
                "lyapunov_per_second": judgement.lyapunov,
                "force_evaluations": evaluations,
                "diverged_at": end,
            }
        )
    return rows


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
