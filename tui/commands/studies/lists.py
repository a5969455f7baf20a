"""Lists of runs: every combination of the scenes' numbers, computed anywhere, kept as they come.

With `-o FILE.csv` the rows are appended to FILE.csv.partial, which gets its name at the end.  Each
row begins with all numbers of its scene and the time, so a file that is resumed shows which
arguments it belongs to.
"""

import argparse
import csv
import io
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import IO, Any

from engine.methods.own import OwnMethodError
from engine.run import compiled, loops
from engine.run.lockstep import Lockstep
from engine.scenes import Scene
from recordings.errors import printable, writing
from recordings.files import check_target, is_stream
from recordings.files import publish as give_name
from recordings.headless import simulate, steps_for
from recordings.library import hold, in_use
from tui.cli.errors import Exit, UserError
from tui.cli.fail_if import Gate
from tui.cli.junit import Check, conclude
from tui.cli.output import progress, warn
from tui.cli.report import Column, Report, publish
from tui.cli.scene import SceneList
from tui.cli.time_limit import limited_steps
from tui.cli.workers import workers_of
from tui.commands.studies.reports.run import columns_of, known, rows_of

MAX_BATCH = 100_000  # steps, a fifth of a second; Ctrl+C is noticed between batches

Row = dict[str, Any]


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
        numbers = {
            f"start_{name}" if name in ("theta", "omega") else name: value
            for name, value in self.scene.numbers.items()
        }
        return {"model": self.scene.model, **numbers, "time": self.time}

    @property
    def steps(self) -> int:
        return steps_for(self.scene, self.time)

    def rows(self) -> list[Row]:
        """Run and return a row for each method."""
        lockstep = lockstep_of(self.scene, self.expected_steps, self.is_compiled)
        with limited_steps():  # in a worker, too
            for sample in simulate(self.scene, self.time, None, MAX_BATCH, lockstep=lockstep):
                last = sample
        return [self.start | row for row in rows_of(self.scene, last, lockstep, stopped=False)]


def lockstep_of(scene: Scene, expected_steps: int, is_compiled: bool) -> Lockstep:
    """Return the lockstep of a run, in machine code where that pays."""
    tiered = partial(compiled.TieredLoops, expected_steps=expected_steps)
    return Lockstep(scene, loops=tiered if is_compiled else loops.PlainLoops, judged=True)


class Tasks:
    """The runs of a list, in order."""

    def __init__(self, scenes: SceneList, time: float, is_compiled: bool) -> None:
        self.scenes = scenes
        self.time = time
        hs = scenes.axes.get("h", [scenes.base.h])
        each = sum(steps_for(scenes.base.altered(h=h), time) for h in hs)
        self.steps = each * (len(scenes) // len(hs))
        models = [name for name in scenes.axes if name not in ("theta", "omega", "h")]
        self._same = self.steps if not models else 0
        self._is_compiled = is_compiled

    def __len__(self) -> int:
        return len(self.scenes)

    def __iter__(self) -> Iterator[Task]:
        for scene in self.scenes:
            yield Task(scene, self.time, self._same, self._is_compiled)


class Rows:
    """Where the rows of a list go: a stream of CSV, or memory."""

    def __init__(self, out: IO[bytes] | None = None) -> None:
        self.kept: list[Row] = []  # without a stream
        self.done = 0  # runs
        self._out = out

    def add(self, rows: Sequence[Row]) -> None:
        """Take the rows of a run; in a stream, they can be read at once."""
        if self._out is None:
            self.kept += rows
        else:
            self._out.write(text_of(rows, with_head=not self.done))
            self._out.flush()
        self.done += 1


def text_of(rows: Sequence[Row], with_head: bool) -> bytes:
    """Return rows as CSV; numbers read back the same, None is an empty field."""
    text = io.StringIO()
    names = [name for name in rows[0] if name != "progress"]
    writer = csv.DictWriter(text, names, lineterminator="\n", extrasaction="ignore")
    if with_head:
        writer.writeheader()
    writer.writerows(rows)
    return text.getvalue().encode()


def partial_of(path: Path) -> Path:
    """Return the name of a file of rows until all of them are there."""
    return path.with_name(f"{path.name}.partial")


@contextmanager
def kept_rows(path: Path, tasks: Tasks, options: argparse.Namespace) -> Iterator[Rows]:
    """Yield the rows of FILE.partial, which gets its name `path` once it has all of them.

    Raises DiskError if a name is taken, and UserError if what is to be resumed is not of these
    tasks.
    """
    check_target(path, options.force)
    part = partial_of(path)
    if part.exists() and in_use(part):
        raise UserError(f"{printable(str(part))} is being written by another process.", Exit.DISK)
    if part.exists() and not (options.resume or options.force):
        raise UserError(
            f"{printable(str(part))} is there: --resume goes on with it, --force starts anew.",
            Exit.DISK,
        )
    mode = "r+b" if part.exists() and options.resume else "w+b"
    with writing(part), part.open(mode) as file:
        hold(file)
        rows = Rows(file)
        rows.done = resumed(file, tasks)
        yield rows
        if rows.done == len(tasks):
            os.fsync(file.fileno())
            give_name(part, path, options.force)
        elif not rows.done:
            part.unlink()


def resumed(file: IO[bytes], tasks: Tasks) -> int:
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
        for method, line in zip(task.scene.cast, lines, strict=True):
            begins = ",".join(str(value) for value in (*task.start.values(), method.key, ""))
            if line.endswith(b"\n") and not line.startswith(begins.encode()):
                raise UserError(f"{name} was begun with other arguments; {begins} is missing.")
        if not lines[-1].endswith(b"\n"):
            break
        end = file.tell()
        done += 1
        last = task, b"".join(lines)
    else:
        if file.readline():
            raise UserError(f"{name} was begun with other arguments; it has more runs.")
    if last is not None and text_of(last[0].rows(), with_head=True) != head + last[1]:
        raise UserError(
            f"the last run in {name} gives other numbers when it is repeated, so its method, this"
            " machine or pendu-tui has changed; start anew with --force."
        )
    file.seek(end)
    file.truncate()
    return done


def run_list(scenes: SceneList, options: argparse.Namespace, gate: Gate | None) -> int:
    """Run every combination, and print or keep the rows."""
    tasks = Tasks(scenes, options.time, not options.no_compiled)
    path: Path | None = options.output
    into: AbstractContextManager[Rows] = nullcontext(Rows())
    if path is not None and path.suffix.lower() == ".csv" and not is_stream(path):
        into = kept_rows(path, tasks, options)
    elif options.csv:
        into = nullcontext(Rows(sys.stdout.buffer))
    checks: list[Check] = []
    with into as rows:
        ended = _fill(rows, tasks, options, gate, checks)
    if rows.kept:
        publish(_report(scenes, options.time, rows.kept, is_whole=ended is None), options)
    if ended is not None:
        if not rows.done:
            raise ended
        kept = f"{rows.done} of {len(tasks)} runs are done"
        if path is not None and rows.done and not rows.kept:
            kept += f" and kept in {printable(str(partial_of(path)))}; --resume goes on"
        warn(f"{str(ended).rstrip('.')}: {kept}.")
        return ended.code
    return conclude(options, f"pendu-tui run, {len(tasks)} runs", checks)


def _fill(
    rows: Rows, tasks: Tasks, options: argparse.Namespace, gate: Gate | None, checks: list[Check]
) -> UserError | None:
    """Add the rows of all tasks that are not done; return why it ended early."""
    rest = islice(tasks, rows.done, None)
    steps = sum(each.steps for each in islice(tasks, rows.done))
    names = list(tasks.scenes.axes)
    try:
        with workers_of(options) as workers, progress(f"{len(tasks):,} runs") as show:
            for task, found in workers.map(_computed, rest):
                rows.add(found)
                if gate:
                    where = ", ".join(f"{name} {task.scene.numbers[name]:g}" for name in names)
                    verdicts = ", ".join(f"{row['method']} {row['verdict']}" for row in found)
                    failure = gate({row["method"]: row for row in found})
                    checks.append(Check(where, verdicts, failure or None))
                steps += task.steps
                show(steps, tasks.steps)
    except KeyboardInterrupt:
        return UserError("interrupted.", Exit.INTERRUPTED)
    except (UserError, OwnMethodError) as error:
        return UserError(str(error), getattr(error, "code", Exit.USAGE))
    return None


def _computed(task: Task) -> tuple[Task, list[Row]]:
    return task, task.rows()


def _report(scenes: SceneList, time: float, rows: Sequence[Row], is_whole: bool) -> Report:
    """Return the report of the runs that are done."""
    varied = [name for name, axis in scenes.axes.items() if len(axis) > 1]
    starts = [f"start_{name}" if name in ("theta", "omega") else name for name in varied]
    return Report(
        name="runs",
        columns=[*(Column(name, name, ".6g") for name in starts), *columns_of(scenes.base)],
        rows=rows,
        fields={"time": time, "runs": [known(row) for row in rows], "interrupted": not is_whole},
        records=[{name: row[name] for name in row if name != "progress"} for row in rows],
    )
