"""What the accuracy command prints: table, chart, recommendation; JSON; CSV."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import groupby, pairwise
from typing import Any, TextIO

from rich.text import Text

from engine.accuracy.advice import Advice
from engine.accuracy.front import Cheapest, Cost, front
from engine.accuracy.growth import Growth
from engine.accuracy.references import AnyPoint, Reference, References
from engine.accuracy.study import REASONS, ErrorKind, Order, Point
from engine.methods import Method
from engine.scenes import Scene
from tui.cli.output import console, fields_of, print_picture, scene_line, write_csv, write_json
from tui.cli.report import print_table
from tui.commands.studies.reports.orders import claimed, order_remarks
from tui.commands.studies.reports.references import print_references, rows_of
from tui.drawing.palette import PALETTES
from tui.views.accuracy.chart import ERROR_LABELS, MARKS, accuracy_chart, accuracy_series
from tui.words.accuracy import WORTH_SAYING, factor_words, front_words, growth_words, length

CHART_SIZE = (100, 24)  # columns at most, rows


@dataclass(slots=True)
class Findings:
    """What was asked for, and what has been found so far."""

    scene: Scene
    time: float  # s
    kind: ErrorKind
    cost: Cost
    target: float | None
    budget: int | None
    points: list[Point] = field(default_factory=list)
    orders: list[Order] = field(default_factory=list)
    growth: list[Growth] = field(default_factory=list)  # of the theta error, at the scene's h
    advice: list[Advice] = field(default_factory=list)  # one for each time asked for
    all: bool = False
    references: References | None = None
    interrupted: bool = False

    @property
    def front(self) -> list[Cheapest]:
        """The cheapest method at each accuracy."""
        taylor = self.references.taylor if self.references else ()
        return front([*self.points, *taylor], self.kind, self.cost)

    @property
    def wish(self) -> str:
        """What was asked for, in words."""
        within = f" within {self.budget} force evaluations" if self.budget else ""
        return (f"{self.kind} error up to {self.target:g}" if self.target else f"smallest {self.kind} error") + within


def print_text(found: Findings) -> None:
    """Print the table, the chart, and what is recommended."""
    print(f"{scene_line(found.scene)}, over {found.time:g} s\n{ERROR_LABELS[found.kind]}\n")
    _print_points(found)
    if found.references:
        print_references(found.references, found.kind)
    print()
    _print_chart(found)
    if found.all and found.points:
        alone = front(found.points, found.kind, "evaluations")
        print(f"\n{front_words(found.front, found.cost, alone)}")
        if words := factor_words(alone):
            print(words)
    for advice in found.advice:
        print()
        _print_advice(found, advice)
    if len(found.advice) > 1:
        print(f"\n{winners(found.advice)}")


def print_json(found: Findings) -> None:
    """Print one object: points, orders, recommendation, and the recommendation for each time asked for."""
    durations = [_advice_fields(found, advice) for advice in found.advice]
    write_json(
        "accuracy",
        {
            "scene": found.scene.fields(),
            "time": found.time,
            "error": found.kind,
            "points": rows_of(found.points, found.references, found.kind),
            "front": [
                {"error": a.target, "method": a.method.key, "cost": a.cost, "saves_over_rk4": a.saves}
                for a in found.front
            ],
            "absent": found.references and found.references.absent,
            "orders": [
                {"method": o.method.key, "claimed": claimed(o.method), "measured": o.measured} for o in found.orders
            ],
            "recommendation": durations[-1] if durations else None,
            "durations": durations,
            "interrupted": found.interrupted,
        },
    )


def print_csv(found: Findings, out: TextIO) -> None:
    """Write a line for each point."""
    rows = rows_of(found.points, found.references, found.kind)
    if rows:
        write_csv(out, list(rows[0]), (list(row.values()) for row in rows))


def _print_points(found: Findings) -> None:
    cast = found.scene.cast
    rungs = [(steps, list(ours)) for steps, ours in groupby(found.points, key=lambda point: point.steps)]
    rows = [
        (f"{ours[0].h:.4g}", f"{ours[0].h * found.scene.w0:.3g}", str(steps), *(_cell(found, ours, m) for m in cast))
        for steps, ours in rungs
    ]
    if found.orders:
        measured = ("-" if order.measured is None else f"{order.measured:.2f}" for order in found.orders)
        rows.append(("order", "", "measured", *measured))
        rows.append(("", "", "claimed", *(str(claimed(order.method) or "-") for order in found.orders)))
    names = (f"{method.label} ({method.force_evaluations}/step)" for method in cast)
    print_table("rrr" + "r" * len(cast), ("h [s]", "z = h·w0", "steps", *names), rows)
    flaws = {flaw for point in found.points if (flaw := point.flaw(found.kind))}
    for mark in sorted({MARKS[flaw] for flaw in flaws}):
        print(f"{mark} {'; '.join(REASONS[flaw] for flaw in flaws if MARKS[flaw] == mark)}")
    print("order measured on the theta error over at most one period; n/step: force evaluations")
    for remark in order_remarks(found.scene, found.orders):
        print(remark)
    if said := growth_words(found.growth):
        print(f"at h = {found.scene.h:g} s, {said}")


def _cell(found: Findings, rung: Sequence[Point], method: Method) -> str:
    for point in rung:
        if point.method == method:
            flaw = point.flaw(found.kind)
            seconds = "" if point.seconds is None else f" in {length(point.seconds)}"
            return f"{MARKS[flaw] if flaw else ''} {point.error(found.kind):.1e}{seconds}"
    return ""


def _print_chart(found: Findings) -> None:
    on, rows, palette = console(CHART_SIZE[0]), CHART_SIZE[1], PALETTES["dark"]
    width = min(on.width, CHART_SIZE[0])
    series = accuracy_series(found.points, found.kind, found.cost, references=found.references)
    chart = accuracy_chart(series, found.kind, found.cost, width, rows)
    lines = [
        Text.assemble(*((text, palette.colour(ink)) for text, ink in row if isinstance(ink, int))) for row in chart.rows
    ]
    for line in lines:
        line.rstrip()
    print_picture(on, lines)


def _print_advice(found: Findings, advice: Advice) -> None:
    kind, point = found.kind, advice.point
    if point is None:
        print(f"No method reaches the target over {advice.time:g} s: {found.wish}")
    else:
        seconds = "" if point.seconds is None else f" in {length(point.seconds)}"
        print(f"Over {advice.time:g} s, {found.wish}: {point.method.label} at h = {point.h:.5g} s")
        print(f"{point.force_evaluations} force evaluations{seconds}, {kind} error {point.error(kind):.2e}, confirmed")
        if advice.rk4 and advice.saves and advice.saves >= WORTH_SAYING:
            print(f"RK4 takes {advice.saves:.2g} times as many force evaluations, {advice.rk4.force_evaluations}")
    timed = any(attempt.point and attempt.point.seconds is not None for attempt in advice.attempts)
    rows = []
    for method, tried, why_not in _tries(advice):
        note = why_not or ("recommended" if tried is point else "")
        cells = (
            f"{tried.h:.5g}" if isinstance(tried, Point) else "-",
            str(tried.force_evaluations) if isinstance(tried, Point) else "-",
            *([length(tried.seconds) if tried and tried.seconds is not None else "-"] if timed else []),
            f"{tried.error(kind):.2e}" if tried else "-",
        )
        rows.append((method.label, *cells, note))
    headers = ("method", "h [s]", "force evaluations", *(["seconds"] if timed else []), f"{kind} error", "")
    print_table("lrr" + "r" * timed + "rl", headers, rows)


def _tries(advice: Advice) -> list[tuple[Method | Reference, AnyPoint | None, str | None]]:
    """The methods that were tried, each with its run and the reason why it will not do."""
    return [(each.method, each.point, each.why_not) for each in advice.attempts]


def winners(advice: Sequence[Advice]) -> str:
    """Where the recommended method changes with the time."""
    names = [piece.point.method.label if piece.point else "no method" for piece in advice]
    changes = [
        f"{after} instead of {before} from {advice[at].time:g} s on (not yet at {advice[at - 1].time:g} s)"
        for at, (before, after) in enumerate(pairwise(names), 1)
        if before != after
    ]
    return "; ".join(changes) + "." if changes else f"{names[0]} for all these times."


def _run_fields(
    method: Method | Reference | None, point: AnyPoint | None, kind: ErrorKind, error: str
) -> dict[str, Any]:
    """A method and its run, whose error is called `error`; None for what there is not."""
    return {
        "method": method and method.key,
        **{name: getattr(point, name, None) for name in ("h", "force_evaluations")},
        error: point and point.error(kind),
        **{name: getattr(point, name, None) for name in ("seconds", "tolerance")},
    }


def _advice_fields(found: Findings, advice: Advice) -> dict[str, Any]:
    point = advice.point
    return {
        "time": advice.time,
        **fields_of(found, "target", "budget"),
        **_run_fields(point.method if point else None, point, found.kind, "reached"),
        "saves_over_rk4": advice.saves,
        "reason": None if point else "no method gets there",
        "attempts": [
            _run_fields(method, tried, found.kind, "error") | {"why_not": why_not}
            for method, tried, why_not in _tries(advice)
        ],
    }
