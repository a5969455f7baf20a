"""Lists of runs: every combination of the scenes' numbers, computed anywhere, kept as they come.

With `-o FILE.csv` the rows are appended to FILE.csv.partial, which gets its name at the end.  Each
row begins with all numbers of its scene and the time, so a file that is resumed shows which
arguments it belongs to.
"""

import argparse
import csv
import io
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import IO

from engine.methods.own import OwnMethodError
from engine.scenes import Scene
from recordings.errors import printable, writing
from recordings.files import is_stream
from recordings.files import publish as give_name
from recordings.headless import simulate, steps_for
from recordings.library import hold, in_use
from tui.cli.checks import Check, Gate, conclude
from tui.cli.errors import Exit, UserError, explained
from tui.cli.report import Column, Report, progress, publish, warn
from tui.cli.scene import SceneList
from tui.cli.time_limit import limited_steps
from tui.cli.workers import workers_of
from tui.commands.studies.run import (
    MAX_BATCH,
    Row,
    check_of,
    columns_of,
    for_csv,
    for_json,
    lockstep_of,
    rows_of,
)


@dataclass(frozen=True, slots=True)
class Task:
    """One run of a list."""

    scene: Scene
    time: float  # s
    expected_steps: int  # of all runs together, which decides whether compiling pays
    is_compiled: bool

    @property
    def start(self) -> Row:
        """The fields that its rows begin with."""
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


def _tasks(scenes: SceneList, options: argparse.Namespace) -> Iterator[Task]:
    """Yield the runs of a list, in order."""
    steps = 0  # loops are compiled for one model
    if scenes.axes.keys() <= {"theta", "omega", "h"}:
        corners = scenes.corners()
        total = sum(steps_for(scene, options.time) for scene in corners)
        steps = total * len(scenes) // len(corners)
    for scene in scenes:
        yield Task(scene, options.time, steps, not options.no_compiled)


def _text_of(rows: Sequence[Row], with_head: bool) -> bytes:
    text = io.StringIO()
    records = for_csv(rows)
    writer = csv.DictWriter(text, records[0], lineterminator="\n")
    if with_head:
        writer.writeheader()
    writer.writerows(records)
    return text.getvalue().encode()


def partial_of(path: Path) -> Path:
    """Return the name of a file of rows until all of them are there."""
    return path.with_name(f"{path.name}.partial")


@contextmanager
def _opened(options: argparse.Namespace) -> Iterator[IO[bytes] | None]:
    """Yield FILE.partial for rows of CSV.  Raises UserError if it is taken."""
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
            f"{printable(str(part))} is there: --resume goes on with it, --force starts anew.",
            Exit.DISK,
        )
    mode = "w+b"
    if is_there and options.resume:
        mode = "r+b"
    with writing(part), part.open(mode) as file:
        hold(file)
        yield file


def _resumed(file: IO[bytes], tasks: Iterator[Task], runs: int) -> int:
    """Return how many whole runs a file has, and cut it after them.

    Raises UserError if its rows are not of these tasks, or if the last run gives other numbers now.
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
            begins = ",".join(map(str, (*task.start.values(), method.key, "")))
            if not line.startswith(begins.encode()):
                raise UserError(f"{name} was begun with other arguments; {begins} is missing.")
        end = file.tell()
        done += 1
        last = task, b"".join(lines)
    if done == runs and file.readline():
        raise UserError(f"{name} was begun with other arguments; it has more runs.")
    if last is not None and _text_of(last[0].rows(), with_head=True) != head + last[1]:
        raise UserError(
            f"the last run in {name} gives other numbers when it is repeated, so its method, this"
            " machine or pendu-tui has changed; start anew with --force."
        )
    file.seek(end)
    file.truncate()
    return done


def _check(options: argparse.Namespace, is_figure: bool) -> None:
    if options.record:
        raise UserError("--record is for one run; leave it out, or give each number one value.")
    if is_figure:
        raise UserError("a figure is of one run; write a .csv, or give each number one value.")
    is_csv = options.output and options.output.suffix.lower() == ".csv"
    if options.resume and not is_csv:
        raise UserError("--resume is for -o FILE.csv, the rows of a list of runs.")
    if options.resume and options.fail_if:
        raise UserError("--fail-if cannot see the runs of before; leave out --resume or --fail-if.")


def run_list(
    scenes: SceneList, options: argparse.Namespace, gate: Gate | None, is_figure: bool
) -> Exit:
    """Run every combination, and print the rows, or keep them in the file as they come."""
    _check(options, is_figure)
    runs = len(scenes)
    kept: list[Row] = []
    checks: list[Check] = []
    ended: UserError | None = None
    with _opened(options) as file:
        done = 0
        if file:
            done = _resumed(file, _tasks(scenes, options), runs)
        rest = islice(_tasks(scenes, options), done, None)
        try:
            with workers_of(options) as workers, progress(f"{runs:,} runs") as show:
                for task, rows in workers.map(_computed, rest):
                    if file:
                        file.write(_text_of(rows, with_head=not done))
                        file.flush()
                    else:
                        kept += rows
                    done += 1
                    show(done, runs)
                    if gate:
                        checks.append(check_of(_place(scenes, task), rows, gate))
        except (KeyboardInterrupt, UserError, OwnMethodError) as error:
            ended = explained(error)
        if file and done == runs:
            os.fsync(file.fileno())
            give_name(partial_of(options.output), options.output, options.force)
        elif file and not done:
            partial_of(options.output).unlink()
    if kept:
        publish(_report(scenes, options.time, kept, is_whole=ended is None), options)
    if ended is None:
        return conclude(options, f"pendu-tui run, {runs} runs", checks)
    if not done:
        raise ended
    _warn_of(ended, f"{done} of {runs} runs are done", None if kept else options.output)
    return ended.code


def _warn_of(ended: UserError, what: str, path: Path | None) -> None:
    if path:
        what += f" and kept in {printable(str(partial_of(path)))}; --resume goes on"
    warn(f"{str(ended).rstrip('.')}: {what}.")


def _computed(task: Task) -> tuple[Task, list[Row]]:
    return task, task.rows()


def _place(scenes: SceneList, task: Task) -> str:
    return ", ".join(f"{name} {task.scene.numbers[name]:g}" for name in scenes.axes)


def _report(scenes: SceneList, time: float, rows: Sequence[Row], is_whole: bool) -> Report:
    starts = [_column(name) for name, axis in scenes.axes.items() if len(axis) > 1]
    return Report(
        name="runs",
        columns=[*(Column(name, name, ".6g") for name in starts), *columns_of(scenes.base)],
        rows=rows,
        fields={"time": time, "runs": for_json(rows), "interrupted": not is_whole},
        records=for_csv(rows),
    )
