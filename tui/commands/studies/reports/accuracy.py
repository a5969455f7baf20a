"""What the accuracy command prints: table, chart, recommendation; JSON; CSV."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import groupby, pairwise
from typing import Any, TextIO

from rich.text import Text

from engine.accuracy.recommend import Attempt
from engine.accuracy.study import REASONS, ErrorKind, Order, Point
from engine.methods import Method
from engine.methods.own import OwnMethod
from engine.scenes import Scene
from tui.cli.output import console, fields_of, print_picture, print_table, scene_line, write_csv, write_json
from tui.drawing.palette import PALETTES
from tui.views.accuracy.chart import ERROR_LABELS, MARKS, Cost, accuracy_chart

CHART_SIZE = (100, 24)  # columns at most, rows


@dataclass(frozen=True, slots=True)
class Advice:
    """What was recommended for one time."""

    time: float  # s
    attempts: Sequence[Attempt]
    point: Point | None  # None: no method reaches the target


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
    advice: list[Advice] = field(default_factory=list)  # one for each time asked for
    interrupted: bool = False

    @property
    def wish(self) -> str:
        """What was asked for, in words."""
        within = f" within {self.budget} force evaluations" if self.budget else ""
        return (f"{self.kind} error up to {self.target:g}" if self.target else f"smallest {self.kind} error") + within


def print_text(found: Findings) -> None:
    """Print the table, the chart, and what is recommended."""
    print(f"{scene_line(found.scene)}, over {found.time:g} s\n{ERROR_LABELS[found.kind]}\n")
    _print_points(found)
    print()
    _print_chart(found)
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
            "points": [_point_fields(point, found.kind) for point in found.points],
            "orders": [
                {"method": o.method.key, "claimed": _claimed(o.method), "measured": o.measured} for o in found.orders
            ],
            "recommendation": durations[-1] if durations else None,
            "durations": durations,
            "interrupted": found.interrupted,
        },
    )


def print_csv(found: Findings, out: TextIO) -> None:
    """Write a line for each point."""
    rows = [_point_fields(point, found.kind) for point in found.points]
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
        rows.append(("", "", "claimed", *(str(_claimed(order.method) or "-") for order in found.orders)))
    names = (f"{method.label} ({method.force_evaluations}/step)" for method in cast)
    print_table("rrr" + "r" * len(cast), ("h [s]", "z = h·w0", "steps", *names), rows)
    flaws = {flaw for point in found.points if (flaw := point.flaw(found.kind))}
    for mark in sorted({MARKS[flaw] for flaw in flaws}):
        print(f"{mark} {'; '.join(REASONS[flaw] for flaw in flaws if MARKS[flaw] == mark)}")
    print("order measured on the theta error over at most one period; n/step: force evaluations")


def _claimed(method: Method) -> int | None:
    """The claimed order; nothing is claimed of a user's own method."""
    return None if isinstance(method, OwnMethod) else method.order


def _cell(found: Findings, rung: Sequence[Point], method: Method) -> str:
    for point in rung:
        if point.method == method:
            flaw = point.flaw(found.kind)
            seconds = "" if point.seconds is None else f" in {_length(point.seconds)}"
            return f"{MARKS[flaw] if flaw else ''} {point.error(found.kind):.1e}{seconds}"
    return ""


def _length(seconds: float) -> str:
    for unit, size in (("µs", 1e-6), ("ms", 1e-3)):
        if seconds < 999.5 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"


def _print_chart(found: Findings) -> None:
    on, rows, palette = console(CHART_SIZE[0]), CHART_SIZE[1], PALETTES["dark"]
    chart = accuracy_chart(found.points, found.kind, found.cost, min(on.width, CHART_SIZE[0]), rows)
    lines = [Text.assemble(*((text, palette.colour(owner)) for text, owner in chart.row(y))) for y in range(rows)]
    for line in lines:
        line.rstrip()
    print_picture(on, lines)


def _print_advice(found: Findings, advice: Advice) -> None:
    kind, point = found.kind, advice.point
    if point is None:
        print(f"No method reaches the target over {advice.time:g} s: {found.wish}")
    else:
        print(f"Over {advice.time:g} s, {found.wish}: {point.method.label} at h = {point.h:.5g} s")
        print(f"{point.force_evaluations} force evaluations, {kind} error {point.error(kind):.2e}, confirmed")
    rows = []
    for attempt in advice.attempts:
        tried, note = attempt.point, attempt.why_not or ("recommended" if attempt.point is point else "")
        cells = (
            (f"{tried.h:.5g}", str(tried.force_evaluations), f"{tried.error(kind):.2e}") if tried else ("-", "-", "-")
        )
        rows.append((attempt.method.label, *cells, note))
    print_table("lrrrl", ("method", "h [s]", "force evaluations", f"{kind} error", ""), rows)


def winners(advice: Sequence[Advice]) -> str:
    """Where the recommended method changes with the time."""
    names = [piece.point.method.label if piece.point else "no method" for piece in advice]
    changes = [
        f"{after} instead of {before} from {advice[at].time:g} s on (not yet at {advice[at - 1].time:g} s)"
        for at, (before, after) in enumerate(pairwise(names), 1)
        if before != after
    ]
    return "; ".join(changes) + "." if changes else f"{names[0]} for all these times."


def _point_fields(point: Point, kind: ErrorKind) -> dict[str, Any]:
    numbers = ("h", "steps", "force_evaluations", "seconds", "spread", "theta_error", "energy_error", "final_error")
    flaw = point.flaw(kind)
    reason = REASONS[flaw] if flaw else None
    return {"method": point.method.key, **fields_of(point, *numbers), "valid": flaw is None, "reason": reason}


def _run_fields(method: Method | None, point: Point | None, kind: ErrorKind, error: str) -> dict[str, Any]:
    """A method and its run, whose error is called `error`; None for what there is not."""
    return {
        "method": method and method.key,
        "h": point and point.h,
        "force_evaluations": point and point.force_evaluations,
        error: point and point.error(kind),
    }


def _advice_fields(found: Findings, advice: Advice) -> dict[str, Any]:
    point = advice.point
    attempts = [
        _run_fields(attempt.method, attempt.point, found.kind, "error") | {"why_not": attempt.why_not}
        for attempt in advice.attempts
    ]
    return {
        "time": advice.time,
        **fields_of(found, "target", "budget"),
        **_run_fields(point.method if point else None, point, found.kind, "reached"),
        "reason": None if point else "no method gets there",
        "attempts": attempts,
    }
