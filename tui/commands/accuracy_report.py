"""What the accuracy command says: tables, chart and recommendation, JSON, CSV."""

import csv
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import IO, Any

from rich.console import Console
from rich.text import Text

from engine.accuracy.recommend import Attempt
from engine.accuracy.study import REASONS, ErrorKind, Order, Point
from engine.methods import METHODS, Method
from engine.scenes import Scene
from tui.cli.output import print_table, scene_fields, write_json
from tui.drawing.palette import PALETTES
from tui.views.accuracy.chart import ERROR_LABELS, MARKS, Cost, accuracy_chart

CHART_SIZE = (100, 24)  # columns at most, rows


@dataclass(frozen=True, slots=True)
class Advice:
    """What was recommended for one time."""

    time: float  # s
    attempts: Sequence[Attempt]
    point: Point | None  # None: no method gets there


@dataclass(frozen=True, slots=True)
class Findings:
    """All that was found, or found before somebody stopped it."""

    scene: Scene
    time: float  # s
    kind: ErrorKind
    cost: Cost
    target: float | None
    budget: int | None
    points: Sequence[Point]
    orders: Sequence[Order]
    advice: Sequence[Advice]  # one for each time asked for
    interrupted: bool

    @property
    def wish(self) -> str:
        """What was asked for, in words."""
        within = f" within {self.budget} force evaluations" if self.budget else ""
        return (f"{self.kind} error up to {self.target:g}" if self.target else f"smallest {self.kind} error") + within


def print_text(found: Findings) -> None:
    """Print the table, the chart, and what is recommended."""
    scene = found.scene
    numbers = ", ".join(f"{name} {getattr(scene, name):g}" for name in ("theta", "omega", "length", "gravity"))
    print(f"{scene.name}: {numbers} (SI units), over {found.time:g} s\n{ERROR_LABELS[found.kind]}\n")
    _print_points(found)
    print()
    _print_chart(found)
    for advice in found.advice:
        print()
        _print_advice(found, advice)
    if len(found.advice) > 1:
        print(f"\n{winners(found.advice)}")


def _print_points(found: Findings) -> None:
    rungs = [(steps, list(ours)) for steps, ours in groupby(found.points, key=lambda point: point.steps)]
    rows = [
        (f"{ours[0].h:.4g}", f"{ours[0].h * found.scene.w0:.3g}", str(steps), *(_cell(found, ours, m) for m in METHODS))
        for steps, ours in rungs
    ]
    if found.orders:
        measured = ("-" if order.measured is None else f"{order.measured:.2f}" for order in found.orders)
        rows.append(("order", "", "measured", *measured))
        rows.append(("", "", "claimed", *(str(order.method.order) for order in found.orders)))
    names = (f"{method.label} ({method.force_evaluations}/step)" for method in METHODS)
    print_table("rrr" + "r" * len(METHODS), ("h [s]", "z = h·w0", "steps", *names), rows)
    flaws = {flaw for point in found.points if (flaw := point.flaw(found.kind))}
    for mark in sorted({MARKS[flaw] for flaw in flaws}):
        print(f"{mark} {'; '.join(REASONS[flaw] for flaw in flaws if MARKS[flaw] == mark)}")
    print("order: of the theta error over one period or less; n/step: force evaluations")


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
    """In colour where the terminal has colours; 100 columns wide at most."""
    console = Console(highlight=False, width=None if sys.stdout.isatty() else CHART_SIZE[0])
    columns, rows = min(console.width, CHART_SIZE[0]), CHART_SIZE[1]
    picture, palette = accuracy_chart(found.points, found.kind, found.cost, columns, rows), PALETTES["dark"]
    with console.capture() as drawn:
        for y in range(rows):
            line = Text.assemble(*((text, palette.colour(owner)) for text, owner in picture.row(y)))
            line.rstrip()
            console.print(line, no_wrap=True, overflow="crop")
    print(drawn.get(), end="")


def _print_advice(found: Findings, advice: Advice) -> None:
    point = advice.point
    if point is None:
        print(f"No method gets there over {advice.time:g} s: {found.wish}")
    else:
        print(f"Over {advice.time:g} s, {found.wish}: {point.method.label} at h = {point.h:.5g} s")
        print(
            f"{point.force_evaluations} force evaluations, {found.kind} error {point.error(found.kind):.2e}, confirmed"
        )
    print_table(
        "lrrrl",
        ("method", "h [s]", "force evaluations", f"{found.kind} error", ""),
        (_attempt_cells(attempt, found.kind, point) for attempt in advice.attempts),
    )


def _attempt_cells(attempt: Attempt, kind: ErrorKind, best: Point | None) -> tuple[str, ...]:
    point, note = attempt.point, attempt.why_not or ("recommended" if attempt.point is best else "")
    if point is None:
        return (attempt.method.label, "-", "-", "-", note)
    return (attempt.method.label, f"{point.h:.5g}", str(point.force_evaluations), f"{point.error(kind):.2e}", note)


def winners(advice: Sequence[Advice]) -> str:
    """Where the recommended method changes with the time."""
    names = [piece.point.method.label if piece.point else "no method" for piece in advice]
    changes = [
        f"{after} instead of {before} from {advice[at].time:g} s on (not yet at {advice[at - 1].time:g} s)"
        for at, (before, after) in enumerate(pairwise(names), 1)
        if before != after
    ]
    return "; ".join(changes) + "." if changes else f"{names[0]} for all these times."


def print_json(found: Findings) -> None:
    """Print one object: points, orders, recommendation, and the recommendation for each time asked for."""
    durations = [_advice_fields(found, advice) for advice in found.advice]
    write_json(
        "accuracy",
        {
            "scene": scene_fields(found.scene),
            "time": found.time,
            "error": found.kind,
            "points": [_point_fields(point, found.kind) for point in found.points],
            "orders": [
                {"method": o.method.key, "claimed": o.method.order, "measured": o.measured} for o in found.orders
            ],
            "recommendation": durations[-1] if durations else None,
            "durations": durations,
            "interrupted": found.interrupted,
        },
    )


def write_csv(found: Findings, stream: IO[str]) -> None:
    """Write a line for each point."""
    rows = [_point_fields(point, found.kind) for point in found.points]
    if rows:
        writer = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _point_fields(point: Point, kind: ErrorKind) -> dict[str, Any]:
    flaw = point.flaw(kind)
    return {
        "method": point.method.key,
        "h": point.h,
        "steps": point.steps,
        "force_evaluations": point.force_evaluations,
        "seconds": point.seconds,
        "spread": point.spread,
        "theta_error": point.theta_error,
        "energy_error": point.energy_error,
        "final_error": point.final_error,
        "valid": flaw is None,
        "reason": REASONS[flaw] if flaw else None,
    }


def _advice_fields(found: Findings, advice: Advice) -> dict[str, Any]:
    point = advice.point
    return {
        "time": advice.time,
        "target": found.target,
        "budget": found.budget,
        "method": point and point.method.key,
        "h": point and point.h,
        "force_evaluations": point and point.force_evaluations,
        "reached": point and point.error(found.kind),
        "reason": None if point else "no method gets there",
        "attempts": [
            {
                "method": attempt.method.key,
                "h": attempt.point and attempt.point.h,
                "force_evaluations": attempt.point and attempt.point.force_evaluations,
                "error": attempt.point and attempt.point.error(found.kind),
                "why_not": attempt.why_not,
            }
            for attempt in advice.attempts
        ],
    }
