"""Chart speed against accuracy over a ladder of h; find the cheapest method and h."""

import argparse
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from operator import methodcaller
from shutil import get_terminal_size
from typing import Any

from pendu_tui.engine.run import loops
from pendu_tui.engine.run.loops import LoopsOf
from pendu_tui.engine.scenes import Scene, check_h
from pendu_tui.engine.studies.accuracy import (
    REASONS,
    Cost,
    ErrorKind,
    Point,
    Study,
    compilable,
    front,
    ladder,
    measured_point,
    timed,
    usual,
    with_all_methods,
)
from pendu_tui.engine.studies.recommend import Attempt, least_cost
from pendu_tui.tui.cli.errors import Exit, UserError, warn
from pendu_tui.tui.cli.scene import general_scene_of
from pendu_tui.tui.cli.workers import Work, work_of
from pendu_tui.tui.commands.report import (
    Column,
    Figure,
    Report,
    Table,
    check_output,
    fields_of,
    method_column,
    publish,
    scene_line,
)
from pendu_tui.tui.drawing.picture import PALETTES, lines_of
from pendu_tui.tui.views.accuracy import ERROR_LABELS, MARKS, accuracy_chart, accuracy_series
from pendu_tui.tui.words.studies import COSTS, few, front_words, length

MAX_COLUMNS = 100
ROWS = 24
NUMBERS = ("h", "steps", "force_evaluations", "seconds", "spread")
ATTEMPTED = ("h", "z", "steps_per_swing", "force_evaluations")

Row = dict[str, Any]


def run(options: argparse.Namespace) -> int:
    if options.all and options.methods is not None:
        raise UserError("--all and --methods exclude each other; choose one.")
    if options.cost == "seconds" and (options.workers > 1 or options.dask):
        raise UserError("seconds are measured in this process; use workers for evaluations only.")
    check_output(options)
    scene = general_scene_of(options)
    if scene.theta == scene.omega == 0:
        raise UserError("at rest there is no error to measure; use another --theta or --omega.")
    searched = scene if options.methods else with_all_methods(scene)
    seconds, rungs = _rungs(scene, options)
    results = Results(searched if options.all else scene, seconds, options)
    work = measure(results, rungs, searched)
    publish(results.report(interrupted=work.ended is not None), options)
    if results.attempts and not results.attempts[0].reached:
        warn(f"no method reaches the target over {results.time:g} s.")
        return Exit.CHECK_FAILED
    return work.conclude()


@dataclass
class Results:
    """What was asked, and what has been measured so far."""

    scene: Scene  # with the methods to chart
    time: float  # s
    options: argparse.Namespace
    points: list[Point] = field(default_factory=list)
    attempts: list[Attempt] = field(default_factory=list)  # with a target, the best first

    def __post_init__(self) -> None:
        self.kind: ErrorKind = self.options.error
        self.cost: Cost = self.options.cost

    def report(self, interrupted: bool) -> Report:
        cast = self.scene.cast
        points = list(map(self._record, self.points))
        series = accuracy_series(self.points, self.kind, self.cost, cast)
        return Report(
            name="accuracy",
            version=2,
            title=f"{scene_line(self.scene)}, over {self.time:g} s\n{ERROR_LABELS[self.kind]}\n",
            columns=self._columns(),
            rows=self._rungs(),
            notes=self._notes(),
            records=points,
            fields={
                "scene": self.scene.fields(),
                "time": self.time,
                "error": self.kind,
                "points": points,
                "front": [
                    {
                        "error": place.target,
                        "method": place.method.key,
                        "cost": place.cost,
                        "saves_over_rk4": place.saves,
                    }
                    for place in front(self.points, self.kind, self.cost)
                ],
                "recommendation": self._advice_fields() if self.attempts else None,
                "interrupted": interrupted,
            },
            figure=Figure(
                cast,
                [(each.mark, each.x, each.y) for each in series],
                x_label=COSTS[self.cost],
                y_label=ERROR_LABELS[self.kind].partition(",")[0],
                log="xy",
            ),
        )

    def _record(self, point: Point) -> Row:
        """Return a point for JSON and CSV."""
        flaw = point.flaws[self.kind]
        return {
            "method": point.method.key,
            **fields_of(point, *NUMBERS),
            "force_evaluations": point.force_evaluations or None,
            **{f"{kind}_error": error for kind, error in point.errors.items()},
            "valid": flaw is None,
            "reason": flaw and REASONS[flaw],
        }

    def _rungs(self) -> list[Row]:
        """Return a row for each h, with the points of all methods."""
        rows: dict[int, Row] = {}
        for point in self.points:
            row = rows.setdefault(point.steps, fields_of(point, "h", "z", "steps"))
            row[point.method.key] = point
        return list(rows.values())

    def _columns(self) -> list[Column]:
        columns = [
            Column("h [s]", "h", ".4g"),
            Column("z = h·w0", "z", ".3g"),
            Column("steps", "steps", "d"),
        ]
        for method in self.scene.cast:
            head = method.label
            if method.force_evaluations:
                head += f" ({method.force_evaluations}/step)"
            columns.append(Column(head, methodcaller("get", method.key), self._cell))
        return columns

    def _cell(self, point: Point) -> str:
        text = f"{point.errors[self.kind]:.1e}"
        if flaw := point.flaws[self.kind]:
            text = f"{MARKS[flaw]} {text}"
        if point.seconds is not None:
            text += f" in {length(point.seconds)}"
        return text

    def _notes(self) -> Iterator[Any]:
        flaws = {point.flaws[self.kind] for point in self.points}
        yield from (f"{mark} {REASONS[flaw]}" for flaw, mark in MARKS.items() if flaw in flaws)
        yield "n/step: force evaluations"
        yield ""
        columns = min(get_terminal_size((MAX_COLUMNS, ROWS)).columns, MAX_COLUMNS)
        series = accuracy_series(self.points, self.kind, self.cost, self.scene.cast)
        chart = accuracy_chart(series, self.kind, self.cost, columns, ROWS).picture
        yield from lines_of(chart, PALETTES["dark"])
        if self.options.all:
            yield f"\n{front_words(front(self.points, self.kind, self.cost), self.cost)}"
        if self.attempts:
            yield from self._advice_notes()

    def _advice_notes(self) -> Iterator[Any]:
        limit = f"{self.kind} error is at most {self.options.target:g} over {self.time:g} s"
        yield f"\nThe cheapest run of each method whose {limit}:"
        rows = list(map(self._attempt_fields, self.attempts))
        columns = [
            method_column([attempt.method for attempt in self.attempts]),
            Column("h [s]", "h", ".5g"),
            Column("z", "z", ".3g"),
            Column("steps per 2 pi/w0", "steps_per_swing", few),
            Column("evaluations", "force_evaluations", "d"),
            Column(f"{self.kind} error", "error", ".1e"),
            Column("times the cheapest", _times),
        ]
        if self.cost == "seconds":
            columns.insert(-2, Column("seconds", "seconds", length))
        yield Table(columns, rows)
        yield "Other steps near these may miss the target; a smaller target leaves a margin."

    def _attempt_fields(self, attempt: Attempt) -> Row:
        fields = {"method": attempt.method.key} | dict.fromkeys((*ATTEMPTED, "error", "seconds"))
        if point := attempt.point:
            fields |= fields_of(point, *ATTEMPTED, "seconds") | {"error": point.errors[self.kind]}
            fields["force_evaluations"] = point.force_evaluations or None
        return fields | {"times_the_cheapest": attempt.times, "why_not": attempt.why_not}

    def _advice_fields(self) -> Row:
        attempts = list(map(self._attempt_fields, self.attempts))
        best = attempts[0]
        if not self.attempts[0].reached:
            best = dict.fromkeys(best) | {"why_not": "no method reaches the target"}
        return {"time": self.time, "target": self.options.target, **best, "attempts": attempts}


def _rungs(scene: Scene, options: argparse.Namespace) -> tuple[float, list[int]]:
    """Return the time [s] and the numbers of steps to chart.  Raises InputError."""
    seconds, rungs = usual(scene, options.all, options.time)
    if options.h_values:
        for h in options.h_values[:2]:
            check_h(h, scene.w0)
        rungs = ladder(seconds, *options.h_values)
    return seconds, rungs


def measure(results: Results, rungs: Sequence[int], searched: Scene) -> Work:
    """Fill the results step by step, so that an interrupt keeps those that are there.

    With a target, the methods of `searched` are tried.
    """
    scene = results.scene
    options = results.options
    clock = time.perf_counter if results.cost == "seconds" else None
    study_loops: LoopsOf = loops.TieredLoops
    timed_loops: LoopsOf = loops.compiled
    # seconds compare methods only if all or none of them are compiled
    if clock and not compilable(scene.cast):
        study_loops = timed_loops = loops.PlainLoops
    tasks = list(product(rungs, scene.cast))
    search = 0
    if options.target is not None:  # to search for a method's h takes about as long as its points
        search = sum(rungs) * len(searched.cast)
    with work_of(options, "steps", sum(rungs) * len(scene.cast) + search) as work:
        for point in work.run(partial(measured_point, scene, results.time, study_loops), tasks):
            if clock:
                point = timed(point, scene, clock, timed_loops)
            results.points.append(point)
            work.step(point.steps)
        if search:
            results.attempts = least_cost(
                Study(searched, results.time, study_loops),
                kind=results.kind,
                target=options.target,
                show=lambda share: work.show(work.done + share * search, work.total),
                clock=clock,
                loops=timed_loops,
            )
    return work


def _times(row: Row) -> str:
    if row["times_the_cheapest"] is None:
        return str(row["why_not"])
    return f"{row['times_the_cheapest']:.3g}"
