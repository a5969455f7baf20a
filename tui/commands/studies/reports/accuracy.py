"""The report of the accuracy command: points, chart, measured orders, and what is recommended."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from operator import methodcaller
from typing import Any

from rich.text import Text

from engine.accuracy.front import Cheapest, Cost, front
from engine.accuracy.growth import Growth
from engine.accuracy.recommend import Advice, Attempt
from engine.accuracy.references import References
from engine.accuracy.study import REASONS, ErrorKind, Order, Point
from engine.methods import Method
from engine.methods.own import OwnMethod
from engine.scenes import Scene
from tui.cli.output import console, fields_of, scene_line
from tui.cli.report import Column, Report, Table
from tui.drawing.palette import PALETTES
from tui.views.accuracy.chart import ERROR_LABELS, MARKS, accuracy_chart, accuracy_series
from tui.words.accuracy import factor_words, few, front_words, growth_words, length

CHART_SIZE = (100, 24)  # columns at most, rows
NUMBERS = (
    "h",
    "steps",
    "force_evaluations",
    "seconds",
    "spread",
    "theta_error",
    "energy_error",
    "final_error",
)
TRUTH = "the exact motion, against which errors are taken"


@dataclass(slots=True)
class Findings:
    """What was asked for, and what has been found so far."""

    scene: Scene
    time: float  # s
    kind: ErrorKind
    cost: Cost
    target: float | None
    budget: int | None
    searched: Scene  # whose methods are tried for the target
    safety: float = 1.0  # by which the target is divided
    points: list[Point] = field(default_factory=list)
    orders: list[Order] = field(default_factory=list)
    growth: list[Growth] = field(default_factory=list)  # of the theta error, at the scene's h
    advice: list[Advice] = field(default_factory=list)  # one for each time asked for
    all: bool = False
    references: References | None = None
    interrupted: bool = False

    @property
    def front(self) -> list[Cheapest]:
        """Return the cheapest method at each accuracy."""
        return front([*self.points, *self.series], self.kind, self.cost)

    @property
    def series(self) -> Sequence[Point]:
        """Return the points of Taylor's series."""
        return self.references.taylor if self.references else ()


def report(found: Findings) -> Report:
    """Return the report of what was found."""
    points = list(_records(found))
    durations = [_advice_fields(found, advice) for advice in found.advice]
    return Report(
        name="accuracy",
        title=f"{scene_line(found.scene)}, over {found.time:g} s\n{ERROR_LABELS[found.kind]}\n",
        columns=_columns(found),
        rows=_rungs(found),
        notes=list(_notes(found)),
        records=points,
        fields={
            "scene": found.scene.fields(),
            "time": found.time,
            "error": found.kind,
            "points": points,
            "front": [
                {
                    "error": each.target,
                    "method": each.method.key,
                    "cost": each.cost,
                    "saves_over_rk4": each.saves,
                }
                for each in found.front
            ],
            "absent": found.references.absent if found.references else None,
            "orders": [
                {
                    "method": each.method.key,
                    "claimed": claimed(each.method),
                    "measured": each.measured,
                }
                for each in found.orders
            ],
            "recommendation": durations[-1] if durations else None,
            "durations": durations,
            "interrupted": found.interrupted,
        },
    )


def _records(found: Findings) -> Iterator[dict[str, Any]]:
    """Yield the points of all lines, in the fields of JSON and CSV."""
    for point in (*found.points, *found.series):
        flaw = point.flaw(found.kind)
        numbers = {name: getattr(point, name) for name in NUMBERS}
        if point.tolerance is not None:
            numbers |= {"h": None, "force_evaluations": None}
        reason = REASONS[flaw] if flaw else None
        yield {
            "method": point.method.key,
            **numbers,
            "valid": flaw is None,
            "reason": reason,
            "tolerance": point.tolerance,
        }
    if found.references:
        numbers = dict.fromkeys(NUMBERS) | {"seconds": found.references.closed_form}
        yield {
            "method": "closed_form",
            **numbers,
            "valid": False,
            "reason": TRUTH,
            "tolerance": None,
        }


def _rungs(found: Findings) -> list[dict[str, str]]:
    """Return the rows of the table: the errors of all methods with one h, and the orders."""
    rows: dict[int, dict[str, str]] = {}
    for point in found.points:
        row = rows.setdefault(
            point.steps, {"h": f"{point.h:.4g}", "z": f"{point.z:.3g}", "steps": str(point.steps)}
        )
        row[point.method.key] = _cell(point, found.kind)
    measured = {"h": "order", "steps": "measured"}
    claims = {"steps": "claimed"}
    for order in found.orders:
        measured[order.method.key] = "-" if order.measured is None else f"{order.measured:.2f}"
        claims[order.method.key] = str(claimed(order.method) or "-")
    return [*rows.values(), measured, claims] if found.orders else [*rows.values()]


def _columns(found: Findings) -> list[Column]:
    heads = {"h": "h [s]", "z": "z = h·w0", "steps": "steps"}
    heads |= {
        method.key: f"{method.label} ({method.force_evaluations}/step)"
        for method in found.scene.cast
    }
    return [Column(head, methodcaller("get", key, ""), right=True) for key, head in heads.items()]


def _cell(point: Point, kind: ErrorKind) -> str:
    flaw = point.flaw(kind)
    mark = f"{MARKS[flaw]} " if flaw else ""
    seconds = "" if point.seconds is None else f" in {length(point.seconds)}"
    return f"{mark}{point.error(kind):.1e}{seconds}"


def _notes(found: Findings) -> Iterator[Any]:
    flaws = {flaw for point in found.points if (flaw := point.flaw(found.kind))}
    yield from sorted(f"{MARKS[flaw]} {REASONS[flaw]}" for flaw in flaws)
    yield "order measured on the theta error over at most one period; n/step: force evaluations"
    if growth := growth_words(found.growth):
        yield f"at h = {found.scene.h:g} s, {growth}"
    if found.references:
        yield from filter(None, [found.references.absent])
        yield f"Closed form, the floor: {length(found.references.closed_form)}"
    yield from ("", *_chart(found))
    if found.all and found.points:
        alone = front(found.points, found.kind, "evaluations")
        yield f"\n{front_words(found.front, found.cost, alone)}"
        if factors := factor_words(alone):
            yield factors
    for advice in found.advice:
        yield from _advice_notes(found, advice)
    if len(found.advice) > 1:
        yield f"\n{winners(found.advice)}"


def claimed(method: Method) -> int | None:
    """Return the claimed order; nothing is claimed of a user's own method."""
    return None if isinstance(method, OwnMethod) else method.order


def _chart(found: Findings) -> list[Text]:
    palette = PALETTES["dark"]
    columns, rows = CHART_SIZE
    series = accuracy_series(
        found.points, found.kind, found.cost, found.scene.cast, references=found.references
    )
    chart = accuracy_chart(
        series, found.kind, found.cost, min(console(columns).width, columns), rows
    )
    lines = []
    for row in chart.rows:
        line = Text.assemble(
            *((text, palette.colour(ink)) for text, ink in row if isinstance(ink, int))
        )
        line.rstrip()
        lines.append(line)
    return lines


def _advice_notes(found: Findings, advice: Advice) -> Iterator[Any]:
    """Yield the recommendation for one time, and what was tried for it."""
    wish = (
        f"smallest {found.kind} error"
        if found.target is None
        else f"{found.kind} error up to {found.target:g}"
    )
    if found.safety > 1:
        wish += f" with a margin of {found.safety:g}"
    if found.budget is not None:
        wish += f" within {found.budget} force evaluations"
    point = advice.point
    if point is None:
        yield f"\nNo method reaches the target over {advice.time:g} s: {wish}"
    else:
        z = f"z = {point.z:.3g}, {few(point.steps_per_swing)} steps a small swing"
        yield f"\nOver {advice.time:g} s, {wish}: {point.method.label} at h = {point.h:.5g} s ({z})"
        seconds = "" if point.seconds is None else f" in {length(point.seconds)}"
        error = f"{found.kind} error {point.error(found.kind):.2e}, confirmed"
        yield f"{point.force_evaluations} force evaluations{seconds}, {error}"
    yield Table(_attempt_columns(found, advice), advice.attempts)


def _attempt_columns(found: Findings, advice: Advice) -> list[Column]:
    def of_point(head: str, write: Any) -> Column:
        return Column(head, lambda attempt: attempt.point and write(attempt.point), right=True)

    columns = [
        Column("method", lambda attempt: attempt.method.label),
        of_point("h [s]", lambda point: f"{point.h:.5g}"),
        of_point("z", lambda point: f"{point.z:.3g}"),
        of_point("steps a swing", lambda point: few(point.steps_per_swing)),
        of_point("evaluations", lambda point: str(point.force_evaluations)),
    ]
    if any(attempt.point and attempt.point.seconds is not None for attempt in advice.attempts):
        columns.append(
            of_point(
                "seconds", lambda point: None if point.seconds is None else length(point.seconds)
            )
        )
    columns.append(of_point(f"{found.kind} error", lambda point: f"{point.error(found.kind):.1e}"))
    columns.append(Column("times the cheapest", _times))
    return columns


def _times(attempt: Attempt) -> str:
    if attempt.times is None:
        return attempt.why_not or ""
    return f"{attempt.times:.3g}"


def winners(advice: Sequence[Advice]) -> str:
    """Return where the recommended method changes with the time."""
    changes = []
    names = [each.point.method.label if each.point else "no method" for each in advice]
    for (before, after), (earlier, later) in zip(pairwise(names), pairwise(advice), strict=True):
        if before != after:
            changes.append(
                f"{after} instead of {before} from {later.time:g} s on (not yet at "
                f"{earlier.time:g} s)"
            )
    return "; ".join(changes) + "." if changes else f"{names[0]} for all these times."


def _attempt_fields(attempt: Attempt, kind: ErrorKind) -> dict[str, Any]:
    """Return a method, its run and its cost; None for what there is not."""
    point = attempt.point
    return {
        "method": attempt.method.key,
        "h": point and point.h,
        "z": point and point.z,
        "steps_per_swing": point and point.steps_per_swing,
        "force_evaluations": point and point.force_evaluations,
        "error": point and point.error(kind),
        "seconds": point and point.seconds,
        "times_the_cheapest": attempt.times,
        "why_not": attempt.why_not,
    }


def _advice_fields(found: Findings, advice: Advice) -> dict[str, Any]:
    attempts = [_attempt_fields(each, found.kind) for each in advice.attempts]
    best = attempts[0] if advice.point else dict.fromkeys(attempts[0])
    return {
        "time": advice.time,
        **fields_of(found, "target", "budget", "safety"),
        **best,
        "why_not": None if advice.point else "no method gets there",
        "attempts": attempts,
    }
