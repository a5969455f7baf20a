"""Simulate a scene as fast as possible, without the TUI, and judge each method."""

import math
import time
from argparse import Namespace
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from functools import partial
from typing import Any

from pendu_tui.engine import quantities
from pendu_tui.engine.methods import Method
from pendu_tui.engine.models import NUMBERS
from pendu_tui.engine.run import loops
from pendu_tui.engine.run.lockstep import Lockstep, Reading, Sample
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.events import SAMPLE_EVERY, simulate, steps_for
from pendu_tui.tui.cli.cast import check_fits
from pendu_tui.tui.cli.checks import Check, Gate, conclude, parse
from pendu_tui.tui.cli.errors import Exit, UserError, progress, warn
from pendu_tui.tui.cli.files import keep_older, stop_requests
from pendu_tui.tui.cli.scene import scenes_of
from pendu_tui.tui.cli.watchdog import watchdog
from pendu_tui.tui.cli.workers import work_of
from pendu_tui.tui.commands.report import (
    Column,
    Figure,
    Line,
    Report,
    check_output,
    fields_of,
    form_of,
    method_column,
    publish,
    scene_line,
)
from pendu_tui.tui.words.insight import irregular, milestone_insight
from pendu_tui.tui.words.numbers import counted, z_text

MAX_BATCH = 100_000  # steps, a fifth of a second; Ctrl+C is noticed between batches
MAX_POINTS = 20_000  # samples for a figure
MAX_PARTS = 400  # of a figure, each drawn as its largest error

Row = dict[str, Any]
APART = (*quantities.EXTREMES, quantities.DIVERGED_AT.name, quantities.INVARIANT.name)
"""Recorded fields that have another place in --json, or none."""
RECORDED = [each.name for each in quantities.RECORDED if each.name not in APART]


def run(options: Namespace) -> int:
    scenes = scenes_of(options)
    if options.time is None:
        raise UserError("--time is missing; use, for example, --time 60.")
    gate = parse(options.fail_if, cast=scenes[0].cast)
    coarsest = max(scenes, key=lambda scene: scene.h)
    if steps_for(coarsest, options.time) == 0:
        raise UserError(f"--time {options.time:g} s is shorter than one step of {coarsest.h:g} s.")
    form = check_output(options)
    if len(scenes) == 1:
        return run_one(scenes[0], options, gate)
    if options.record or form == "figure":
        raise UserError("--record and a figure are for one run; give each number one value.")
    return run_list(scenes, options, gate)


def run_one(scene: Scene, options: Namespace, gate: Gate) -> Exit:
    if options.record:
        check_fits(scene.cast)
    steps = steps_for(scene, options.time)
    lockstep = lockstep_of(scene, steps)
    began = time.perf_counter()
    samples = _simulate(lockstep, options, steps)
    wall_seconds = time.perf_counter() - began
    sample = samples[-1]
    is_whole = sample.step == steps
    rows = rows_of(lockstep, sample, is_whole)
    if not is_whole:
        keep_older(options.output)
    publish(_report(lockstep, samples, rows, wall_seconds), options)
    if not is_whole:
        warn(f"interrupted at t = {sample.t:g} s, showing the results up to then.")
        return Exit.INTERRUPTED
    return conclude(options.fail_if, [Check(scene.name, gate(by_method(rows)))])


def lockstep_of(scene: Scene, expected_steps: int) -> Lockstep:
    """Return the lockstep of a run, compiled if that pays."""
    tiered = partial(loops.TieredLoops, expected_steps=expected_steps)
    return Lockstep(scene, loops=tiered, judged=True)


def _simulate(lockstep: Lockstep, options: Namespace, steps: int) -> list[Sample]:
    """Run to the end or until a signal; return the last sample, or for a figure all of them."""
    scene = lockstep.scene
    recorder: Any = nullcontext()
    every = MAX_BATCH
    if options.method:  # a method of the user's own may be slow, and Ctrl+C waits for a batch
        every = 16
    if options.record:
        from pendu_tui.recordings.recorder import Recorder  # slow to load

        recorder = Recorder(options.record, overwrite=options.force)
        every = min(every, max(1, round(SAMPLE_EVERY / scene.h)))
    every = options.sample_every or every
    samples: deque[Sample] = deque(maxlen=1)
    if form_of(options) == "figure":
        every = min(every, math.ceil(steps / MAX_POINTS))
        samples = deque()
    with stop_requests() as stopped, progress(f"{steps:,} steps") as show, recorder as recording:
        for sample in simulate(
            scene, options.time, recording and recording.add, every, lockstep=lockstep
        ):
            show(sample.step, steps)
            samples.append(sample)
            if stopped():
                if recording:
                    recording.keep_older()
                break
    if recording:
        warn(f"wrote {recording.path}")
    return list(samples)


def _lines(scene: Scene, samples: Sequence[Sample]) -> Iterator[Line]:
    """Yield the largest energy error of each half swing, or of longer parts of a long run."""
    swing = scene.exact().period or math.tau / scene.w0
    size = math.ceil(len(samples) / max(1, min(MAX_PARTS, 2 * samples[-1].t / swing)))
    parts = [samples[begin : begin + size] for begin in range(0, len(samples), size)]
    name = scene.equations.error.name
    for place, method in enumerate(scene.cast):
        errors = [max(abs(getattr(each.readings[place], name)) for each in part) for part in parts]
        yield method.letter, [part[0].t for part in parts], errors


def rows_of(lockstep: Lockstep, sample: Sample, is_whole: bool) -> list[Row]:
    """Return the results of each method, as in --json."""
    scene = lockstep.scene
    model = scene.equations
    exact = scene.exact().at(sample.t).theta
    rows = []
    methods = zip(scene.cast, sample.readings, lockstep.judgements, strict=True)
    for method, reading, judgement in methods:
        row = {"method": method.key, **fields_of(reading, *RECORDED)}
        if not model.conserves_energy:
            row[quantities.LOG_ENERGY_ERROR.name] = row[model.error.name]
        if reading.max_invariant_error is not None:
            row[quantities.INVARIANT.name] = reading.max_invariant_error
        row |= {variable.name: reading.extra.get(variable.name) for variable in model.variables}
        theta_error = None
        if reading.diverged_at is None:
            theta_error = abs(model.theta_error(reading.theta, exact))
        row |= {
            "theta_error": theta_error,
            "drift_per_second": judgement.trend,
            **fields_of(judgement, "slope", "uncertainty", "bound", "share", "verdict", "rests"),
            "reason": str(judgement.progress or judgement.reason),
            "progress": judgement.progress and judgement.progress._asdict(),
            "lyapunov_per_second": judgement.lyapunov,
            "force_evaluations": _evaluations(scene, method, reading, sample.step, is_whole),
            "diverged_at": reading.diverged_at,
        }
        rows.append(row)
    return rows


def _evaluations(
    scene: Scene, method: Method, reading: Reading, steps: int, is_whole: bool
) -> float:
    """Return the force evaluations; if they vary, count them by repeating a whole run."""
    if reading.diverged_at is not None:
        return method.evaluations(round(reading.diverged_at / scene.h))
    if method.varies and is_whole:
        start = scene.equations.start(scene.theta, scene.omega)
        return loops.count_evaluations(method, scene.equations, start, scene.h, steps)
    return method.evaluations(steps)


def _report(
    lockstep: Lockstep, samples: Sequence[Sample], rows: Sequence[Row], wall_seconds: float
) -> Report:
    scene = lockstep.scene
    sample = samples[-1]
    return Report(
        name="run",
        title=f"{scene_line(scene, 'h')}, {z_text(scene)}\n"
        f"{counted(sample.step, 'step')} to t = {sample.t:g} s in {wall_seconds:.2f} s\n",
        columns=columns_of(scene, quantity_column(quantities.TREND)),
        rows=rows,
        notes=_notes(lockstep),
        fields={
            "scene": scene.fields(),
            "time": sample.t,
            "steps": sample.step,
            "wall_seconds": wall_seconds,
            "methods": rows,
        },
        records=for_csv(rows),
        figure=Figure(
            scene.cast,
            _lines(scene, samples[1:] or samples),
            x_label="time / s",
            y_label=f"largest {scene.equations.error.chart.magnitude} per half period",
            log="y",
        ),
    )


def _notes(lockstep: Lockstep) -> Iterator[str]:
    """Yield what happened, why a method is undecided, and how fast orbits separate."""
    scene = lockstep.scene
    for milestone in lockstep.milestones:
        if milestone.kind in ("over the top", "errors cross"):
            yield milestone_insight(milestone, scene.equations.conserves_energy).text
    for method, judgement in zip(scene.cast, lockstep.judgements, strict=True):
        if judgement.reason and not judgement.progress:
            yield f"{method.label} is undecided: {judgement.reason}."
        insight = irregular(method, judgement, 0.0)
        if judgement.lyapunov and insight:
            yield insight.text


def by_method(rows: Sequence[Row]) -> dict[str, Row]:
    """Return the values for a gate; the drift is the slope even where there is no evident trend."""
    drift = quantities.TREND.name
    return {row["method"]: row | {drift: row["slope"]} for row in rows}


def for_csv(rows: Sequence[Row]) -> list[Row]:
    return [{name: row[name] for name in row if name != "progress"} for row in rows]


def quantity_column(quantity: quantities.Quantity) -> Column:
    return Column(quantity.label, quantity.name, quantity.form)


def columns_of(scene: Scene, *trend: Column) -> list[Column]:
    model = scene.equations
    return [
        method_column(scene.cast),
        Column("verdict", verdict_of),
        *(
            Column(each.chart.title, each.name, ".4g")
            for each in model.variables
            if each.chart.title
        ),
        quantity_column(model.error),
        quantity_column(quantities.LARGEST),
        *trend,
        quantity_column(quantities.THETA_ERROR),
        quantity_column(quantities.EVALUATIONS),
    ]


def verdict_of(row: Row) -> str:
    """Return the verdict with the progress towards one, or when the method failed."""
    if row["diverged_at"] is not None:
        return f"failed at {row['diverged_at']:g} s"
    if row["progress"] is None:
        return str(row["verdict"])
    return f"{row['verdict']}: {row['reason']}"


def _rows_of_list(time: float, expected_steps: int, scene: Scene) -> list[Row]:
    """Return the rows of one run of a list, which begin with its numbers; for a worker."""
    lockstep = lockstep_of(scene, expected_steps)
    watchdog()  # in a worker, too
    for sample in simulate(scene, time, None, MAX_BATCH, lockstep=lockstep):
        last = sample
    numbers = {_column(name): value for name, value in scene.numbers.items()}
    start = {"model": scene.model, **numbers, "time": last.t}
    return [start | row for row in rows_of(lockstep, last, is_whole=True)]


def _column(name: str) -> str:
    if name in ("theta", "omega"):
        return f"start_{name}"
    return name


def run_list(scenes: Sequence[Scene], options: Namespace, gate: Gate) -> Exit:
    """Run every scene and print the rows; an interrupt keeps those that are there."""
    lists = {name: _column(name) for name in NUMBERS if len(getattr(options, name) or "") > 1}
    steps = 0  # compiled loops cannot be shared by runs with other parameters
    if lists.keys() <= {"theta", "omega", "h"}:
        steps = sum(steps_for(scene, options.time) for scene in scenes)
    kept: list[Row] = []
    checks: list[Check] = []
    run = partial(_rows_of_list, options.time, steps)
    with work_of(options, "runs", len(scenes)) as work:
        for rows in work.run(run, scenes):
            kept += rows
            place = ", ".join(f"{name} {rows[0][column]:g}" for name, column in lists.items())
            checks.append(Check(place, gate(by_method(rows))))
            work.step()
    report = Report(
        name="runs",
        columns=[*(Column(name, name, ".6g") for name in lists.values()), *columns_of(scenes[0])],
        rows=kept,
        fields={"time": options.time, "runs": kept, "interrupted": bool(work.ended)},
        records=for_csv(kept),
    )
    publish(report, options)
    return work.conclude() or conclude(options.fail_if, checks)
