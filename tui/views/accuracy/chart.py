"""Points of an accuracy study -> a log-log chart of error over cost."""

import math
from collections.abc import Sequence

from engine.accuracy.ahead import Cost, cost_of
from engine.accuracy.front import CLOSED_FORM, TAYLOR_20, TaylorPoint
from engine.accuracy.study import ErrorKind, Flaw, Point
from tui.drawing.canvas import Picture
from tui.drawing.chart import Series, loglog_chart
from tui.drawing.palette import EXACT, FRAME, TEXT
from tui.drawing.palette import series as series_of

MARKS: dict[Flaw, str] = {"lost": "x", "diverged": "x", "rounding": "~"}
"""Of points that do not show how the error depends on h."""

ERROR_LABELS: dict[ErrorKind, str] = {
    "theta": "theta error [rad], the largest distance from the exact swing",
    "energy": "energy error, the largest of all steps, relative",
    "final": "theta error at the end [rad]",
}
COST_LABELS: dict[Cost, str] = {"evaluations": "force evaluations", "seconds": "seconds"}
BESIDE = 0.2  # of a method's errors: where the dotted line of its order runs


def power(order: int) -> str:
    """h to the power of an order."""
    return "h" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in str(order) if order != 1)


def accuracy_chart(
    points: Sequence[Point],
    kind: ErrorKind,
    cost: Cost,
    width: int,
    height: int,
    marks: Sequence[tuple[str, Point]] = (),
    beside: Sequence[Series] = (),
) -> Picture:
    """Letters for points, x for useless and ~ for rounding-limited ones, dotted lines for orders, `beside`, `marks`."""

    def series(some: Sequence[Point], mark: str) -> Series:
        costs, errors = [cost_of(point, cost) for point in some], [point.error(kind) for point in some]
        return Series(series_of(some[0].method), mark, costs, errors)

    methods = dict.fromkeys(point.method for point in points)
    by_method = [[point for point in points if point.method == method] for method in methods]
    lines = [series(ours, ours[0].method.letter) for ours in by_method]
    flawed = [series([point], MARKS[flaw]) for point in points if (flaw := point.flaw(kind))]
    marked = [series([point], mark) for mark, point in marks]
    slopes = [_slope(ours, kind, cost, points) for ours in by_method]
    return loglog_chart(
        [*(slope for slope in slopes if slope), *lines, *flawed, *beside, *marked],
        width,
        height,
        x_label=COST_LABELS[cost],
        y_label=ERROR_LABELS[kind],
    )


def references(
    taylor: Sequence[TaylorPoint], floor: float | None, points: Sequence[Point], kind: ErrorKind
) -> list[Series]:
    """What is beside the methods over seconds: the line of Taylor's series, and upright the closed form's floor."""

    def series(some: Sequence[TaylorPoint], mark: str) -> Series:
        return Series(TEXT, mark, [cost_of(p, "seconds") for p in some], [p.error(kind) for p in some])

    flawed = [series([point], MARKS[flaw]) for point in taylor if (flaw := point.flaw(kind))]
    lines = [series(taylor, TAYLOR_20.letter), *flawed] if taylor else []
    known = [*(point.error(kind) for point in points), *(point.error(kind) for point in taylor)]
    errors = [error for error in known if error and math.isfinite(error)]
    if floor and errors:
        lines.append(Series(EXACT, CLOSED_FORM.letter, [floor, floor], [min(errors), max(errors)]))
    return lines


def _slope(ours: Sequence[Point], kind: ErrorKind, cost: Cost, points: Sequence[Point]) -> Series | None:
    """A line with the slope of the method's order, below its errors; one for all methods of that order."""
    order = ours[0].method.order
    valid = [point for point in ours if not point.flaw(kind) and point.error(kind) and cost_of(point, cost)]
    if not valid or ours[0].method != next(p.method for p in points if p.method.order == order):
        return None
    anchor = valid[len(valid) // 2]
    costs = [cost_of(point, cost) for point in points]
    ends = [min(costs), max(costs)]
    errors = [BESIDE * anchor.error(kind) * (end / cost_of(anchor, cost)) ** -order for end in ends]
    return Series(FRAME, power(order), ends, errors, dotted=True)
