"""The measurements, recommendations and report of the accuracy command."""

import argparse
import time
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import pairwise
from operator import methodcaller
from typing import Any

from pendu_tui.engine.accuracy.front import Cheapest, front
from pendu_tui.engine.accuracy.recommend import Advice, Attempt, least_cost, least_error
from pendu_tui.engine.accuracy.references import References, references
from pendu_tui.engine.accuracy.study import (
    ALL_LADDER,
    REASONS,
    Z_LADDER,
    Clock,
    Order,
    Point,
    Study,
    compilable,
    ladder,
    measured_point,
    orders,
    timed,
    usual,
    with_all_methods,
)
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.run import compiled, loops
from pendu_tui.engine.run.loops import LoopsOf
from pendu_tui.engine.scenes import Scene, check_h
from pendu_tui.tui.cli.errors import UserError
from pendu_tui.tui.cli.report import (
    Column,
    Report,
    Table,
    console,
    fields_of,
    method_column,
    progress,
    scene_line,
)
from pendu_tui.tui.cli.workers import workers_of
from pendu_tui.tui.commands.studies.figures import lines_of
from pendu_tui.tui.drawing.palette import PALETTES
from pendu_tui.tui.views.accuracy.chart import ERROR_LABELS, MARKS, accuracy_chart, accuracy_series
from pendu_tui.tui.words.accuracy import factor_words, few, front_words, length

MAX_STEPS = 10**10  # at the smallest h: half an hour, compiled
CHART_SIZE = (100, 24)  # columns, unless the terminal has fewer, and rows
NUMBERS = (
    *("h", "steps", "force_evaluations", "seconds", "spread"),
    *("theta_error", "energy_error", "final_error"),
)
TRUTH = "the exact motion, against which errors are taken"


class Results:
    """The options of a study, and what has been measured so far."""

    def __init__(self, scene: Scene, options: argparse.Namespace) -> None:
        self.options = options
        self.scene = scene  # with the methods to chart
        self.searched = scene  # with the methods to recommend
        if not options.methods:
            self.searched = with_all_methods(scene)
        if options.all:
            self.scene = self.searched
        self.durations: list[float] = options.time or [usual(scene)[0]]
        self.time = self.durations[-1]  # s
        self.clock: Clock | None = None
        if options.cost == "seconds":
            self.clock = time.perf_counter
        self.points: list[Point] = []
        self.orders: list[Order] = []
        self.advice: list[Advice] = []  # one for each duration
        self.references: References | None = None
        self.series: Sequence[Point] = ()  # Taylor's

    @property
    def front(self) -> list[Cheapest]:
        """Return the cheapest method at each accuracy."""
        return front([*self.points, *self.series], self.options.error, self.options.cost)


def measure(results: Results) -> None:
    """Fill the results step by step, so that an interrupt keeps those that are there."""
    scene = results.scene
    rungs = _ladder(results)
    study_loops: LoopsOf = compiled.TieredLoops
    timed_loops: LoopsOf = compiled.compiled
    # seconds compare methods only if all or none of them are compiled
    fast = not results.options.no_compiled and (not results.clock or compilable(scene.cast))
    if not fast:
        study_loops = timed_loops = loops.PlainLoops
    if results.options.target is not None or results.options.budget is not None:
        _search(results, study_loops, timed_loops)
    tasks = [(index, steps) for steps in rungs for index in range(len(scene.cast))]
    done = 0
    with workers_of(results.options) as run, progress("measuring") as show:
        for point in run(partial(measured_point, scene, results.time, study_loops), tasks):
            if results.clock:
                point = timed(point, scene, results.clock, timed_loops)
            results.points.append(point)
            done += point.steps
            show(done, len(scene.cast) * sum(rungs))
    if results.options.all and results.clock:
        results.references = references(scene, results.time, results.clock, fast)
        results.series = results.references.taylor
    results.orders += orders(scene, results.time, study_loops)


def _search(results: Results, study_loops: LoopsOf, timed_loops: LoopsOf) -> None:
    kind = results.options.error
    target = results.options.target
    budget = results.options.budget
    with progress("searching") as show:
        for done, duration in enumerate(results.durations):
            study = Study(results.searched, duration, study_loops)

            def show_share(share: float, done: int = done) -> None:
                show(done + share, len(results.durations))

            if target is None:
                advice = least_error(study, kind, budget, show_share)
            else:
                goal = target / results.options.safety
                clock = results.clock
                advice = least_cost(study, kind, goal, budget, show_share, clock, timed_loops)
            results.advice.append(advice)


def _ladder(results: Results) -> list[int]:
    """Return the numbers of steps to chart.  Raises UserError and SceneError."""
    w0 = results.scene.w0
    if results.options.h_values:
        largest, smallest, rungs = results.options.h_values
    else:
        z_max, z_min, rungs = ALL_LADDER if results.options.all else Z_LADDER
        largest = min(z_max / w0, results.time)
        smallest = z_min / w0
    for h in (largest, smallest):
        check_h(h, w0)
    if largest > results.time:
        raise UserError(
            f"h = {largest:g} s is longer than the time of {results.time:g} s; use a longer --time."
        )
    if results.time / smallest > MAX_STEPS:
        raise UserError(
            f"{results.time:g} s in steps of {smallest:.2g} s take hours; use larger ones, for "
            "example --h-values 0.2:0.01:8."
        )
    return ladder(results.time, largest, smallest, rungs)


def report(results: Results, interrupted: bool) -> Report:
    kind = results.options.error
    points = list(_records(results))
    durations = [_advice_fields(results, advice) for advice in results.advice]
    return Report(
        name="accuracy",
        title=f"{scene_line(results.scene)}, over {results.time:g} s\n{ERROR_LABELS[kind]}\n",
        columns=_columns(results),
        rows=_rungs(results),
        notes=list(_notes(results)),
        records=points,
        fields={
            "scene": results.scene.fields(),
            "time": results.time,
            "error": kind,
            "points": points,
            "front": [
                {"error": place.target, "method": place.method.key, "cost": place.cost}
                | {"saves_over_rk4": place.saves}
                for place in results.front
            ],
            "absent": results.references and results.references.absent,
            "orders": list(map(_order_fields, results.orders)),
            "recommendation": durations[-1] if durations else None,
            "durations": durations,
            "interrupted": interrupted,
        },
    )


def _order_fields(order: Order) -> dict[str, Any]:
    claimed = None
    if not isinstance(order.method, OwnMethod):
        claimed = order.method.order
    return {"method": order.method.key, "claimed": claimed, "measured": order.measured}


def _records(results: Results) -> Iterator[dict[str, Any]]:
    """Yield the points of all methods, the series and the closed form, for JSON and CSV."""
    for point in (*results.points, *results.series):
        flaw = point.flaw(results.options.error)
        record = {"method": point.method.key, **fields_of(point, *NUMBERS), "valid": flaw is None}
        if point.tolerance is not None:
            record |= {"h": None, "force_evaluations": None}
        yield record | {"reason": flaw and REASONS[flaw], "tolerance": point.tolerance}
    if results.references:
        record = {"method": "closed_form", **dict.fromkeys(NUMBERS)}
        record |= {"seconds": results.references.closed_form, "valid": False}
        yield record | {"reason": TRUTH, "tolerance": None}


def _rungs(results: Results) -> list[dict[str, Any]]:
    """Return a row for each h, with the points of all methods."""
    rows: dict[int, dict[str, Any]] = {}
    for point in results.points:
        row = rows.setdefault(point.steps, fields_of(point, "h", "z", "steps"))
        row[point.method.key] = point
    return list(rows.values())


def _columns(results: Results) -> list[Column]:
    def error(point: Point) -> str:
        text = f"{point.error(results.options.error):.1e}{_seconds(point)}"
        flaw = point.flaw(results.options.error)
        return f"{MARKS[flaw]} {text}" if flaw else text

    columns = [
        Column("h [s]", "h", ".4g"),
        Column("z = h·w0", "z", ".3g"),
        Column("steps", "steps", "d"),
    ]
    for method in results.scene.cast:
        head = f"{method.label} ({method.force_evaluations}/step)"
        columns.append(Column(head, methodcaller("get", method.key), error))
    return columns


def _seconds(point: Point) -> str:
    return "" if point.seconds is None else f" in {length(point.seconds)}"


def _notes(results: Results) -> Iterator[Any]:
    kind = results.options.error
    cost = results.options.cost
    flaws = {point.flaw(kind) for point in results.points}
    yield from sorted(f"{MARKS[flaw]} {REASONS[flaw]}" for flaw in flaws if flaw)
    yield "n/step: force evaluations"
    measured = [
        f"{order.method.label} {order.measured:.2f}"
        for order in results.orders
        if order.measured is not None
    ]
    yield f"order of the theta error over at most one period: {', '.join(measured) or '-'}"
    if results.references:
        if results.references.absent:
            yield results.references.absent
        yield f"Closed form, the floor: {length(results.references.closed_form)}"
    yield ""
    cast = results.scene.cast
    series = accuracy_series(results.points, kind, cost, cast, references=results.references)
    columns, rows = CHART_SIZE
    chart = accuracy_chart(series, kind, cost, min(console(columns).width, columns), rows)
    yield from lines_of(chart, PALETTES["dark"])
    if results.options.all and results.points:
        without_series = front(results.points, kind, "evaluations")
        yield f"\n{front_words(results.front, cost, without_series)}"
        savings = factor_words(without_series)
        if savings:
            yield savings
    for advice in results.advice:
        yield from _advice_notes(results, advice)
    if len(results.advice) > 1:
        yield f"\n{_winners(results.advice)}"


def _advice_notes(results: Results, advice: Advice) -> Iterator[Any]:
    options = results.options
    kind = options.error
    wish = f"smallest {kind} error"
    if options.target is not None:
        wish = f"{kind} error up to {options.target:g}"
        if options.safety > 1:
            wish += f" with a margin of {options.safety:g}"
    if options.budget is not None:
        wish += f" within {options.budget} force evaluations"
    point = advice.point
    if point is None:
        yield f"\nNo method reaches the target over {advice.time:g} s: {wish}"
    else:
        z = f"z = {point.z:.3g}, {few(point.steps_per_swing)} steps a small swing"
        yield f"\nOver {advice.time:g} s, {wish}: {point.method.label} at h = {point.h:.5g} s ({z})"
        cost = f"{point.force_evaluations} force evaluations{_seconds(point)}"
        yield f"{cost}, {kind} error {point.error(kind):.2e}, confirmed"
        if options.target is not None and options.safety == 1:
            yield "Other steps near it may miss the target; --safety 2 leaves a margin."
    rows = [_attempt_fields(results, attempt) for attempt in advice.attempts]
    columns = [
        method_column([attempt.method for attempt in advice.attempts]),
        Column("h [s]", "h", ".5g"),
        Column("z", "z", ".3g"),
        Column("steps a swing", "steps_per_swing", few),
        Column("evaluations", "force_evaluations", "d"),
        Column(f"{kind} error", "error", ".1e"),
        Column("times the cheapest", _times),
    ]
    if any(row["seconds"] is not None for row in rows):
        columns.insert(-2, Column("seconds", "seconds", length))
    yield Table(columns, rows)


def _times(row: dict[str, Any]) -> str:
    if row["times_the_cheapest"] is None:
        return row["why_not"] or ""
    return f"{row['times_the_cheapest']:.3g}"


def _winners(advice: Sequence[Advice]) -> str:
    """Say where the cheapest method changes with the duration."""
    changes = []
    for earlier, later in pairwise(advice):
        before = _winner(earlier)
        after = _winner(later)
        if before != after:
            when = f"from {later.time:g} s on (not yet at {earlier.time:g} s)"
            changes.append(f"{after} instead of {before} {when}")
    return "; ".join(changes or [f"{_winner(advice[0])} for all these times"]) + "."


def _winner(advice: Advice) -> str:
    return advice.point.method.label if advice.point else "no method"


def _attempt_fields(results: Results, attempt: Attempt) -> dict[str, Any]:
    numbers = ("h", "z", "steps_per_swing", "force_evaluations")
    fields = {"method": attempt.method.key, **dict.fromkeys((*numbers, "error", "seconds"))}
    point = attempt.point
    if point:
        fields |= fields_of(point, *numbers, "seconds")
        fields["error"] = point.error(results.options.error)
    return fields | {"times_the_cheapest": attempt.times, "why_not": attempt.why_not}


def _advice_fields(results: Results, advice: Advice) -> dict[str, Any]:
    attempts = [_attempt_fields(results, attempt) for attempt in advice.attempts]
    options = fields_of(results.options, "target", "budget", "safety")
    best = attempts[0]
    if not advice.point:
        best = dict.fromkeys(best) | {"why_not": "no method gets there"}
    return {"time": advice.time, **options, **best, "attempts": attempts}
