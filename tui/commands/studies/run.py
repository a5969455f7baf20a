"""One run, or a list of runs with every combination of the scene's numbers.

With `-o FILE.csv`, rows of a list are appended to FILE.csv.partial, which is renamed at the end.
Each row begins with all numbers of its scene and the time, so that --resume can check that the
file belongs to its arguments.
"""

import io
import math
import os
import time
from argparse import Namespace
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import IO, Any

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.own import OwnMethodError
from pendu_tui.engine.run import compiled, loops
from pendu_tui.engine.run.lockstep import Lockstep, Reading, Sample
from pendu_tui.engine.run.verdicts import Judgement, Progress
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.errors import printable, writing
from pendu_tui.recordings.fields import NUMBERS, OPTIONAL
from pendu_tui.recordings.files import is_stream
from pendu_tui.recordings.files import publish as give_name
from pendu_tui.recordings.headless import SAMPLE_EVERY, simulate, steps_for
from pendu_tui.recordings.library import hold, in_use
from pendu_tui.recordings.recorder import Recorder
from pendu_tui.tui.cli.checks import Check, Gate, conclude
from pendu_tui.tui.cli.errors import Exit, UserError, explained
from pendu_tui.tui.cli.files import check_free, stop_requests
from pendu_tui.tui.cli.report import (
    Column,
    Report,
    fields_of,
    method_column,
    progress,
    publish,
    scene_line,
    warn,
    write_records,
)
from pendu_tui.tui.cli.scene import SceneList
from pendu_tui.tui.cli.time_limit import limited_steps
from pendu_tui.tui.cli.workers import workers_of
from pendu_tui.tui.commands.studies import figures
from pendu_tui.tui.words.insight import irregular, milestone_insight, sentence
from pendu_tui.tui.words.numbers import counted, file_size, z_text

MAX_BATCH = 100_000  # steps, a fifth of a second; Ctrl+C is noticed between batches
MAX_POINTS = 20_000  # samples for a figure

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
    return conclude(options.fail_if, [check_of(scene.name, rows, gate)])


def lockstep_of(scene: Scene, expected_steps: int, is_compiled: bool) -> Lockstep:
    """Return the lockstep of a run, compiled if that pays."""
    if not is_compiled:
        return Lockstep(scene, judged=True)
    tiered = partial(compiled.TieredLoops, expected_steps=expected_steps)
    return Lockstep(scene, loops=tiered, judged=True)


def _simulate(lockstep: Lockstep, options: Namespace, steps: int, is_figure: bool) -> list[Sample]:
    """Run to the end or until a signal; return the last sample, or for a figure all of them."""
    scene = lockstep.scene
    recorder: Any = nullcontext()
    every = MAX_BATCH
    if options.method:  # a method of the user's own may be slow, and Ctrl+C waits for a batch
        every = 16
    if options.record:
        recorder = Recorder(options.record, wall=None, overwrite=options.force)
        every = min(every, max(1, round(SAMPLE_EVERY / scene.h)))
    every = options.sample_every or every
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
    """Return the results of each method, as in --json."""
    model = scene.equations
    exact = scene.exact().at(sample.t).theta
    rows = []
    methods = zip(scene.cast, sample.readings, lockstep.judgements, strict=True)
    for method, reading, judgement in methods:
        row = {"method": method.key, **fields_of(reading, *NUMBERS)}
        if not model.energy_error.conserved:
            row["log_energy_error"] = reading.energy_error
        optional = fields_of(reading, *OPTIONAL)
        row |= {name: value for name, value in optional.items() if value is not None}
        row |= {variable.name: reading.extra.get(variable.name) for variable in model.variables}
        theta_error = math.nan
        if reading.diverged_at is None:
            theta_error = abs(model.theta_error(reading.theta, exact))
        rows.append(
            row
            | {
                "theta_error": None if math.isnan(theta_error) else theta_error,
                "drift_per_second": judgement.slope,
                "verdict": judgement.verdict,
                "progress": judgement.progress and judgement.progress._asdict(),
                "lyapunov_per_second": judgement.lyapunov,
                "force_evaluations": _evaluations(scene, method, reading, sample.step, is_whole),
                "diverged_at": reading.diverged_at,
            }
        )
    return rows


def _evaluations(
    scene: Scene, method: Method, reading: Reading, steps: int, is_whole: bool
) -> float:
    """Return the force evaluations; if they vary, count them by repeating a whole run."""
    if reading.diverged_at is not None:
        return method.evaluations(round(reading.diverged_at / scene.h))
    if method.varies and steps and is_whole:
        start = scene.equations.start(scene.theta, scene.omega)
        return loops.count_evaluations(method, scene.equations, start, scene.h, steps)
    return method.evaluations(steps)


def check_of(name: str, rows: Sequence[Row], gate: Gate | None) -> Check:
    failure = gate({row["method"]: row for row in rows}) if gate else ""
    return Check(name, failure)


def _report(
    scene: Scene, sample: Sample, lockstep: Lockstep, rows: Sequence[Row], wall_seconds: float
) -> Report:
    notes = [
        sentence(milestone_insight(milestone, scene.equations.energy_error.conserved))
        for milestone in lockstep.milestones
        if milestone.kind in ("over the top", "errors cross")
    ]
    for method, judgement in zip(scene.cast, lockstep.judgements, strict=True):
        insight = irregular(method, judgement, 0.0)
        if judgement.lyapunov and insight:
            notes.append(sentence(insight))
    return Report(
        name="run",
        title=f"{scene_line(scene, 'h')}, {z_text(scene)}\n"
        f"{counted(sample.step, 'step')} to t = {sample.t:g} s in {wall_seconds:.2f} s\n",
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
    """Return rows for JSON, in which only irregular orbits have a Lyapunov number."""
    lyapunov = "lyapunov_per_second"
    return [{name: row[name] for name in row if name != lyapunov or row[name]} for row in rows]


def for_csv(rows: Sequence[Row]) -> list[Row]:
    return [{name: row[name] for name in row if name != "progress"} for row in rows]


def columns_of(scene: Scene, *trend: Column) -> list[Column]:
    return [
        method_column(scene.cast),
        Column("verdict", verdict_of),
        *(Column(value.label, value.name, ".4g") for value in scene.equations.quantities()),
        Column(scene.equations.energy_error.name, "energy_error", "+.2e"),
        Column("largest", "max_energy_error", ".2e"),
        *trend,
        Column("theta error [rad]", "theta_error", ".2e"),
        Column("force evaluations", "force_evaluations", "d"),
    ]


def verdict_of(row: Row) -> str:
    """Return the verdict with the progress towards one, or when the method failed."""
    if row["diverged_at"] is not None:
        return f"failed at {row['diverged_at']:g} s"
    if row["progress"] is None:
        return str(row["verdict"])
    return str(Judgement(row["verdict"], progress=Progress(**row["progress"])))


@dataclass(frozen=True, slots=True)
class Task:
    """One run of a list."""

    scene: Scene
    time: float  # s
    expected_steps: int  # of all runs together, to decide whether compiling pays
    is_compiled: bool

    @property
    def start(self) -> Row:
        """The fields with which its rows begin."""
        numbers = {_column(name): value for name, value in self.scene.numbers.items()}
        return {"model": self.scene.model, **numbers, "time": self.time}

    def rows(self) -> list[Row]:
        lockstep = lockstep_of(self.scene, self.expected_steps, self.is_compiled)
        with limited_steps():  # in a worker, too
            for sample in simulate(self.scene, self.time, None, MAX_BATCH, lockstep=lockstep):
                last = sample
        return [self.start | row for row in rows_of(self.scene, last, lockstep, is_whole=True)]


def _column(name: str) -> str:
    return f"start_{name}" if name in ("theta", "omega") else name


def _tasks(scenes: SceneList, options: Namespace) -> Iterator[Task]:
    """Yield the runs of a list, in order."""
    steps = 0  # compiled loops cannot be shared by runs with other parameters
    if scenes.axes.keys() <= {"theta", "omega", "h"}:
        corners = scenes.corners()
        total = sum(steps_for(scene, options.time) for scene in corners)
        steps = total * len(scenes) // len(corners)
    for scene in scenes:
        yield Task(scene, options.time, steps, not options.no_compiled)


def _text_of(rows: Sequence[Row], with_head: bool) -> bytes:
    out = io.StringIO()
    write_records(for_csv(rows), out)
    text = out.getvalue()
    if not with_head:
        text = text.partition("\n")[2]
    return text.encode()


def partial_of(path: Path) -> Path:
    """Return the name of the file until all its rows are there."""
    return path.with_name(f"{path.name}.partial")


@contextmanager
def _opened(options: Namespace) -> Iterator[IO[bytes] | None]:
    """Yield FILE.csv.partial, or None without one.  Raises UserError if it is taken."""
    path: Path | None = options.output
    if path is None or path.suffix.lower() != ".csv" or is_stream(path):
        yield None
        return
    part = partial_of(path)
    is_there = part.exists()
    if is_there and in_use(part):
        raise UserError(f"{printable(str(part))} is being written by another process.", Exit.DISK)
    if is_there and not (options.resume or options.force):
        raise UserError(
            f"{printable(str(part))} exists: --resume continues it, --force starts again.",
            Exit.DISK,
        )
    with writing(part), part.open("a+b") as file:
        hold(file)
        file.seek(0)
        if not options.resume:
            file.truncate()
        yield file


def _resumed(file: IO[bytes], tasks: Iterator[Task], runs: int) -> int:
    """Return the number of whole runs in a file, and cut it after them.

    Raises UserError if its rows belong to other tasks, or if repeating the last run gives other
    numbers.
    """
    name = printable(file.name)
    head = file.readline()
    end = 0
    done = 0
    last: tuple[Task, bytes] | None = None
    for task in tasks:
        lines = [file.readline() for _ in task.scene.cast]
        if not lines[-1].endswith(b"\n"):
            break
        for method, line in zip(task.scene.cast, lines, strict=True):
            start = ",".join(map(str, (*task.start.values(), method.key, "")))
            if not line.startswith(start.encode()):
                raise UserError(f"{name} was begun with other arguments; {start} is missing.")
        end = file.tell()
        done += 1
        last = task, b"".join(lines)
    if done == runs and file.readline():
        raise UserError(f"{name} was begun with other arguments; it has more runs.")
    if last is not None and _text_of(last[0].rows(), with_head=True) != head + last[1]:
        raise UserError(
            f"repeating the last run in {name} gives other numbers, so its method, this machine or "
            "pendu-tui has changed; start again with --force."
        )
    file.seek(end)
    file.truncate()
    return done


def _check(options: Namespace, is_figure: bool) -> None:
    if options.record:
        raise UserError("--record is for one run; leave it out, or give each number one value.")
    if is_figure:
        raise UserError("a figure shows one run; write a .csv, or give each number one value.")
    is_csv = options.output and options.output.suffix.lower() == ".csv"
    if options.resume and not is_csv:
        raise UserError("--resume is for -o FILE.csv, the rows of a list of runs.")
    if options.resume and options.fail_if:
        raise UserError("--fail-if cannot check the earlier runs; leave out --resume or --fail-if.")


def run_list(scenes: SceneList, options: Namespace, gate: Gate | None, is_figure: bool) -> Exit:
    """Run every combination, and print the rows or append them to the file as they come."""
    _check(options, is_figure)
    runs = len(scenes)
    kept: list[Row] = []
    checks: list[Check] = []
    ended = None
    with _opened(options) as file:
        done = _resumed(file, _tasks(scenes, options), runs) if file else 0
        rest = islice(_tasks(scenes, options), done, None)
        try:
            with workers_of(options) as workers, progress(f"{runs:,} runs") as show:
                for rows in workers.map(Task.rows, rest):
                    if file:
                        file.write(_text_of(rows, with_head=not done))
                        file.flush()
                    else:
                        kept += rows
                    done += 1
                    show(done, runs)
                    if gate:
                        checks.append(check_of(_place(scenes, rows[0]), rows, gate))
        except (KeyboardInterrupt, UserError, OwnMethodError) as error:
            ended = explained(error)
        if file and done == runs:
            os.fsync(file.fileno())
            give_name(partial_of(options.output), options.output, options.force)
        elif file and not done:
            partial_of(options.output).unlink()
    if kept:
        publish(_list_report(scenes, options.time, kept, is_whole=ended is None), options)
    if ended is None:
        return conclude(options.fail_if, checks)
    if not done:
        raise ended
    where = ""
    if not kept:
        where = f" and kept in {printable(str(partial_of(options.output)))}; --resume continues"
    warn(f"{str(ended).rstrip('.')}: {done} of {runs} runs are done{where}.")
    return ended.code


def _place(scenes: SceneList, row: Row) -> str:
    return ", ".join(f"{name} {row[_column(name)]:g}" for name in scenes.axes)


def _list_report(scenes: SceneList, time: float, rows: Sequence[Row], is_whole: bool) -> Report:
    starts = [_column(name) for name, axis in scenes.axes.items() if len(axis) > 1]
    return Report(
        name="runs",
        columns=[*(Column(name, name, ".6g") for name in starts), *columns_of(scenes.base)],
        rows=rows,
        fields={"time": time, "runs": for_json(rows), "interrupted": not is_whole},
        records=for_csv(rows),
    )
