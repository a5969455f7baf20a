"""Chart speed against accuracy over a ladder of h; find the cheapest method and h."""

import argparse
import time
from collections.abc import Iterator
from functools import partial
from operator import methodcaller
from typing import Any

from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.run import loops
from pendu_tui.engine.run.loops import LoopsOf
from pendu_tui.engine.scenes import Scene, check_h
from pendu_tui.engine.studies.accuracy import (
    ALL_LADDER,
    REASONS,
    Z_LADDER,
    Cheapest,
    Clock,
    ErrorKind,
    Order,
    Point,
    Study,
    compilable,
    front,
    ladder,
    measured_point,
    orders,
    timed,
    usual,
    with_all_methods,
)
from pendu_tui.engine.studies.recommend import Advice, Attempt, least_cost
from pendu_tui.tui.cli.errors import Exit, UserError, warn
from pendu_tui.tui.cli.scene import general_scene_of
from pendu_tui.tui.cli.workers import Work, work_of
from pendu_tui.tui.commands.report import (
    Column,
    Figure,
    Report,
    Table,
    check_output,
    console,
    fields_of,
    method_column,
    publish,
    scene_line,
)
from pendu_tui.tui.drawing.loglog import Series
from pendu_tui.tui.drawing.picture import PALETTES, lines_of
from pendu_tui.tui.views.accuracy import ERROR_LABELS, MARKS, accuracy_chart, accuracy_series
from pendu_tui.tui.words.studies import COSTS, factor_words, few, front_words, length

MAX_STEPS = 10**10  # at the smallest h: half an hour, compiled
CHART_SIZE = (100, 24)  # columns, unless the terminal has fewer, and rows
NUMBERS = (
    "h",
    "steps",
    "force_evaluations",
    "seconds",
    "spread",
    *(f"{kind}_error" for kind in ERROR_LABELS),
)


def run(options: argparse.Namespace) -> int:
    if options.all and options.methods is not None:
        raise UserError("--all and --methods exclude each other; choose one of them.")
    if options.cost == "seconds" and (options.workers > 1 or options.dask):
        raise UserError("seconds are measured in this process; use workers for evaluations only.")
    check_output(options)
    scene = general_scene_of(options)
    if scene.theta == scene.omega == 0:
        raise UserError(
            "the pendulum hangs at rest, so there is no error to measure; use another --theta or "
            "--omega."
        )
    results = Results(scene, options)
    work = measure(results)
    publish(report(results, interrupted=work.ended is not None), options)
    if results.advice and results.advice.point is None:
        warn(f"no method reaches the target over {results.time:g} s.")
        return Exit.CHECK_FAILED
    return work.conclude()


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
        self.time: float = options.time or usual(scene)[0]  # s
        self.kind: ErrorKind = options.error
        self.points: list[Point] = []
        self.orders: list[Order] = []
        self.advice: Advice | None = None  # with a target

    @property
    def front(self) -> list[Cheapest]:
        """Return the cheapest method at each accuracy."""
        return front(self.points, self.kind, self.options.cost)

    def series(self) -> list[Series]:
        """Return the curves of the chart."""
        return accuracy_series(self.points, self.kind, self.options.cost, self.scene.cast)


def measure(results: Results) -> Work:
    """Fill the results step by step, so that an interrupt keeps those that are there."""
    scene = results.scene
    options = results.options
    clock: Clock | None = None
    if options.cost == "seconds":
        clock = time.perf_counter
    study_loops: LoopsOf = loops.TieredLoops
    timed_loops: LoopsOf = loops.compiled
    # seconds compare methods only if all or none of them are compiled
    if options.no_compiled or (clock and not compilable(scene.cast)):
        study_loops = timed_loops = loops.PlainLoops
    rungs = _ladder(results)
    tasks = [(index, steps) for steps in rungs for index in range(len(scene.cast))]
    with work_of(options, "steps", len(scene.cast) * sum(rungs)) as work:
        for point in work.run(partial(measured_point, scene, results.time, study_loops), tasks):
            if clock:
                point = timed(point, scene, clock, timed_loops)
            results.points.append(point)
            work.step(point.steps)
        results.orders += orders(scene, results.time, study_loops)
        if options.target is not None:
            results.advice = least_cost(
                Study(results.searched, results.time, study_loops),
                kind=results.kind,
                target=options.target,
                show=lambda share: work.show(share, 1),
                clock=clock,
                loops=timed_loops,
            )
    return work


def _ladder(results: Results) -> list[int]:
    """Return the numbers of steps to chart.  Raises UserError and InputError."""
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
    kind = results.kind
    points = list(_records(results))
    return Report(
        name="accuracy",
        title=f"{scene_line(results.scene)}, over {results.time:g} s\n{ERROR_LABELS[kind]}\n",
        columns=_columns(results),
        rows=_rungs(results),
        notes=_notes(results),
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
            "orders": list(map(_order_fields, results.orders)),
            "recommendation": results.advice and _advice_fields(results, results.advice),
            "interrupted": interrupted,
        },
        figure=Figure(
            results.scene.cast,
            [(each.mark, each.x, each.y) for each in results.series()],
            x_label=COSTS[results.options.cost],
            y_label=ERROR_LABELS[kind].partition(",")[0],
            log="xy",
        ),
    )


def _order_fields(order: Order) -> dict[str, Any]:
    claimed = None
    if not isinstance(order.method, OwnMethod):
        claimed = order.method.order
    return {"method": order.method.key, "claimed": claimed, "measured": order.measured}


def _records(results: Results) -> Iterator[dict[str, Any]]:
    """Yield the points of all methods, for JSON and CSV."""
    for point in results.points:
        flaw = point.flaw(results.kind)
        record = {"method": point.method.key, **fields_of(point, *NUMBERS), "valid": flaw is None}
        record["force_evaluations"] = point.force_evaluations or None
        yield record | {"reason": flaw and REASONS[flaw]}


def _rungs(results: Results) -> list[dict[str, Any]]:
    """Return a row for each h, with the points of all methods."""
    rows: dict[int, dict[str, Any]] = {}
    for point in results.points:
        row = rows.setdefault(point.steps, fields_of(point, "h", "z", "steps"))
        row[point.method.key] = point
    return list(rows.values())


def _columns(results: Results) -> list[Column]:
    def error(point: Point) -> str:
        text = f"{point.error(results.kind):.1e}{_seconds(point)}"
        flaw = point.flaw(results.kind)
        return f"{MARKS[flaw]} {text}" if flaw else text

    columns = [
        Column("h [s]", "h", ".4g"),
        Column("z = h·w0", "z", ".3g"),
        Column("steps", "steps", "d"),
    ]
    for method in results.scene.cast:
        head = method.label
        if method.force_evaluations:
            head += f" ({method.force_evaluations}/step)"
        columns.append(Column(head, methodcaller("get", method.key), error))
    return columns


def _seconds(point: Point) -> str:
    return "" if point.seconds is None else f" in {length(point.seconds)}"


def _notes(results: Results) -> Iterator[Any]:
    kind = results.kind
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
    yield ""
    columns, rows = CHART_SIZE
    chart = accuracy_chart(results.series(), kind, cost, min(console(columns).width, columns), rows)
    yield from lines_of(chart, PALETTES["dark"])
    if results.options.all and results.points:
        yield f"\n{front_words(results.front, cost)}"
        if savings := factor_words(front(results.points, kind, "evaluations")):
            yield savings
    if results.advice:
        yield from _advice_notes(results, results.advice)


def _advice_notes(results: Results, advice: Advice) -> Iterator[Any]:
    kind = results.kind
    wish = f"{kind} error up to {results.options.target:g}"
    point = advice.point
    if point is None:
        yield f"\nNo method reaches the target over {advice.time:g} s: {wish}"
    else:
        z = f"z = {point.z:.3g}, {few(point.steps_per_swing)} steps a small swing"
        yield f"\nOver {advice.time:g} s, {wish}: {point.method.label} at h = {point.h:.5g} s ({z})"
        cost = f"{point.force_evaluations} force evaluations{_seconds(point)}"
        if not point.force_evaluations:
            cost = length(point.seconds or 0)
        yield f"{cost}, {kind} error {point.error(kind):.2e}, confirmed"
        yield "Other steps near it may miss the target; a smaller target leaves a margin."
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


def _attempt_fields(results: Results, attempt: Attempt) -> dict[str, Any]:
    numbers = ("h", "z", "steps_per_swing", "force_evaluations")
    fields = {"method": attempt.method.key, **dict.fromkeys((*numbers, "error", "seconds"))}
    point = attempt.point
    if point:
        fields |= fields_of(point, *numbers, "seconds")
        fields["force_evaluations"] = point.force_evaluations or None
        fields["error"] = point.error(results.kind)
    return fields | {"times_the_cheapest": attempt.times, "why_not": attempt.why_not}


def _advice_fields(results: Results, advice: Advice) -> dict[str, Any]:
    attempts = [_attempt_fields(results, attempt) for attempt in advice.attempts]
    best = attempts[0]
    if not advice.point:
        best = dict.fromkeys(best) | {"why_not": "no method gets there"}
    target = results.options.target
    return {"time": advice.time, "target": target, **best, "attempts": attempts}
