"""What the accuracy command measures and recommends, and its report."""

import argparse
import time
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import pairwise
from operator import methodcaller
from typing import Any

from engine.accuracy.front import Cheapest, front
from engine.accuracy.recommend import Advice, Attempt, least_cost, least_error
from engine.accuracy.references import References, references
from engine.accuracy.study import (
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
from engine.methods.own import OwnMethod
from engine.run import compiled, loops
from engine.run.loops import LoopsOf
from engine.scenes import Scene, check_h
from tui.cli.errors import UserError
from tui.cli.report import (
    Column,
    Report,
    Table,
    console,
    fields_of,
    method_column,
    progress,
    scene_line,
)
from tui.cli.workers import workers_of
from tui.commands.studies.figures import lines_of
from tui.drawing.palette import PALETTES
from tui.views.accuracy.chart import ERROR_LABELS, MARKS, accuracy_chart, accuracy_series
from tui.words.accuracy import factor_words, few, front_words, length

MAX_STEPS = 10**10  # of the finest rung: half an hour, compiled
CHART_SIZE = (100, 24)  # columns at most, rows
NUMBERS = (
    *("h", "steps", "force_evaluations", "seconds", "spread"),
    *("theta_error", "energy_error", "final_error"),
)
HEADS = {
    "theta": "largest theta error",
    "energy": "largest energy error",
    "final": "last theta error",
}
TRUTH = "the exact motion, against which errors are taken"


class Findings:
    """What was asked for, and what has been found so far."""

    def __init__(self, scene: Scene, options: argparse.Namespace) -> None:
        self.options = options
        self.scene = self.searched = scene
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
        self.advice: list[Advice] = []  # one for each time asked for
        self.references: References | None = None
        self.series: Sequence[Point] = ()  # of Taylor

    @property
    def front(self) -> list[Cheapest]:
        """Return the cheapest method at each accuracy."""
        points = [*self.points, *self.series]
        return front(points, self.options.error, self.options.cost)


def measure(found: Findings) -> None:
    """Add what was asked for to the findings, so that an interrupt keeps what was found."""
    scene = found.scene
    rungs = _ladder(found)
    study_loops: LoopsOf = compiled.TieredLoops
    timed_loops: LoopsOf = compiled.compiled
    # seconds are those of compiled methods, or of none
    fast = not found.options.no_compiled and (not found.clock or compilable(scene.cast))
    if not fast:
        study_loops = timed_loops = loops.PlainLoops
    if found.options.target is not None or found.options.budget is not None:
        _search(found, study_loops, timed_loops)
    tasks = [(index, steps) for steps in rungs for index in range(len(scene.cast))]
    done = 0
    with workers_of(found.options) as workers, progress("measuring") as show:
        for point in workers.map(partial(measured_point, scene, found.time, study_loops), tasks):
            if found.clock:
                point = timed(point, scene, found.clock, timed_loops)
            found.points.append(point)
            done += point.steps
            show(done, len(scene.cast) * sum(rungs))
    if found.options.all and found.clock:
        found.references = references(scene, found.time, found.clock, fast)
        found.series = found.references.taylor
    found.orders += orders(scene, found.time, study_loops)


def _search(found: Findings, study_loops: LoopsOf, timed_loops: LoopsOf) -> None:
    options = found.options
    with progress("searching") as show:
        for number, duration in enumerate(found.durations):
            study = Study(found.searched, duration, study_loops)

            def show_share(share: float, number: int = number) -> None:
                show(number + share, len(found.durations))

            if options.target is None:
                advice = least_error(study, options.error, options.budget, show_share)
            else:
                wish = (options.error, options.target / options.safety, options.budget)
                advice = least_cost(study, *wish, show_share, found.clock, timed_loops)
            found.advice.append(advice)


def _ladder(found: Findings) -> list[int]:
    w0 = found.scene.w0
    z_max, z_min, rungs = Z_LADDER
    if found.options.all:
        z_max, z_min, rungs = ALL_LADDER
    largest, smallest, rungs = found.options.h_values or (
        min(z_max / w0, found.time),
        z_min / w0,
        rungs,
    )
    for h in (largest, smallest):
        check_h(h, w0)
    if largest > found.time:
        raise UserError(
            f"h = {largest:g} s is longer than the time of {found.time:g} s; use a longer --time."
        )
    if found.time / smallest > MAX_STEPS:
        raise UserError(
            f"{found.time:g} s in steps of {smallest:.2g} s take hours; use --h-values, for "
            "example 0.2:0.01:8."
        )
    return ladder(found.time, largest, smallest, rungs)


def report(found: Findings, interrupted: bool) -> Report:
    kind = found.options.error
    points = list(_records(found))
    durations = [_advice_fields(found, advice) for advice in found.advice]
    return Report(
        name="accuracy",
        title=f"{scene_line(found.scene)}, over {found.time:g} s\n{ERROR_LABELS[kind]}\n",
        columns=_columns(found),
        rows=_rungs(found),
        notes=list(_notes(found)),
        records=points,
        fields={
            "scene": found.scene.fields(),
            "time": found.time,
            "error": kind,
            "points": points,
            "front": [
                {"error": one.target, "method": one.method.key, "cost": one.cost}
                | {"saves_over_rk4": one.saves}
                for one in found.front
            ],
            "absent": found.references and found.references.absent,
            "orders": list(map(_order_fields, found.orders)),
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


def _records(found: Findings) -> Iterator[dict[str, Any]]:
    """Yield the points of all lines, in the fields of JSON and CSV."""
    for point in (*found.points, *found.series):
        flaw = point.flaw(found.options.error)
        record = {"method": point.method.key, **fields_of(point, *NUMBERS), "valid": flaw is None}
        if point.tolerance is not None:
            record |= {"h": None, "force_evaluations": None}
        yield record | {"reason": flaw and REASONS[flaw], "tolerance": point.tolerance}
    if found.references:
        record = {"method": "closed_form", **dict.fromkeys(NUMBERS)}
        record |= {"seconds": found.references.closed_form, "valid": False}
        yield record | {"reason": TRUTH, "tolerance": None}


def _rungs(found: Findings) -> list[dict[str, Any]]:
    """Return the rows of the table: the points of all methods with one h."""
    rows: dict[int, dict[str, Any]] = {}
    for point in found.points:
        row = rows.setdefault(point.steps, fields_of(point, "h", "z", "steps"))
        row[point.method.key] = point
    return list(rows.values())


def _columns(found: Findings) -> list[Column]:
    def error(point: Point) -> str:
        text = f"{point.error(found.options.error):.1e}{_seconds(point)}"
        flaw = point.flaw(found.options.error)
        return f"{MARKS[flaw]} {text}" if flaw else text

    columns = [Column("h [s]", "h", ".4g"), Column("z = h·w0", "z", ".3g")]
    columns.append(Column("steps", "steps", "d"))
    for method in found.scene.cast:
        head = f"{method.label} ({method.force_evaluations}/step)"
        columns.append(Column(head, methodcaller("get", method.key), error))
    return columns


def _seconds(point: Point) -> str:
    return "" if point.seconds is None else f" in {length(point.seconds)}"


def _notes(found: Findings) -> Iterator[Any]:
    kind = found.options.error
    cost = found.options.cost
    flaws = {point.flaw(kind) for point in found.points}
    yield from sorted(f"{MARKS[flaw]} {REASONS[flaw]}" for flaw in flaws if flaw)
    yield "n/step: force evaluations"
    known = (order for order in found.orders if order.measured is not None)
    measured = [f"{order.method.label} {order.measured:.2f}" for order in known]
    yield f"order of the theta error over at most one period: {', '.join(measured) or '-'}"
    if found.references:
        yield from filter(None, [found.references.absent])
        yield f"Closed form, the floor: {length(found.references.closed_form)}"
    yield ""
    series = accuracy_series(
        found.points, kind, cost, found.scene.cast, references=found.references
    )
    columns, rows = CHART_SIZE
    chart = accuracy_chart(series, kind, cost, min(console(columns).width, columns), rows)
    yield from lines_of(chart, PALETTES["dark"])
    if found.options.all and found.points:
        alone = front(found.points, kind, "evaluations")
        yield f"\n{front_words(found.front, cost, alone)}"
        yield from filter(None, [factor_words(alone)])
    for advice in found.advice:
        yield from _advice_notes(found, advice)
    if len(found.advice) > 1:
        yield f"\n{_winners(found.advice)}"


def _advice_notes(found: Findings, advice: Advice) -> Iterator[Any]:
    options = found.options
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
            yield "Steps near it may miss the target; --safety 2 leaves a margin."
    rows = [_attempt_fields(found, attempt) for attempt in advice.attempts]
    timed = [Column("seconds", "seconds", length)]
    columns = [
        method_column([attempt.method for attempt in advice.attempts]),
        Column("h [s]", "h", ".5g"),
        Column("z", "z", ".3g"),
        Column("steps a swing", "steps_per_swing", few),
        Column("evaluations", "force_evaluations", "d"),
        *(timed if any(row["seconds"] is not None for row in rows) else ()),
        Column(HEADS[kind], "error", ".1e"),
        Column("times the cheapest", _times),
    ]
    yield Table(columns, rows)


def _times(row: dict[str, Any]) -> str:
    if row["times_the_cheapest"] is None:
        return row["why_not"] or ""
    return f"{row['times_the_cheapest']:.3g}"


def _winners(advice: Sequence[Advice]) -> str:
    changes = []
    for earlier, later in pairwise(advice):
        before, after = map(_winner, (earlier, later))
        if before != after:
            when = f"from {later.time:g} s on (not yet at {earlier.time:g} s)"
            changes.append(f"{after} instead of {before} {when}")
    return "; ".join(changes or [f"{_winner(advice[0])} for all these times"]) + "."


def _winner(advice: Advice) -> str:
    return advice.point.method.label if advice.point else "no method"


def _attempt_fields(found: Findings, attempt: Attempt) -> dict[str, Any]:
    numbers = ("h", "z", "steps_per_swing", "force_evaluations", "error", "seconds")
    fields = {"method": attempt.method.key, **dict.fromkeys(numbers)}
    if point := attempt.point:
        fields |= {name: getattr(point, name) for name in numbers if name != "error"}
        fields["error"] = point.error(found.options.error)
    return fields | {"times_the_cheapest": attempt.times, "why_not": attempt.why_not}


def _advice_fields(found: Findings, advice: Advice) -> dict[str, Any]:
    attempts = [_attempt_fields(found, attempt) for attempt in advice.attempts]
    options = fields_of(found.options, "target", "budget", "safety")
    best = attempts[0]
    if not advice.point:
        best = dict.fromkeys(best) | {"why_not": "no method gets there"}
    return {"time": advice.time, **options, **best, "attempts": attempts}
