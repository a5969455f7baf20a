"""The log-log chart of an accuracy study: error over cost."""

import math
from collections.abc import Sequence

import numpy as np

from pendu_tui.engine.accuracy.front import Cost, cost_of
from pendu_tui.engine.accuracy.study import ErrorKind, Flaw, Point
from pendu_tui.engine.methods import Cast
from pendu_tui.tui.drawing.loglog import MIN_COLUMNS, MIN_ROWS, LogLog, Series, loglog_chart
from pendu_tui.tui.drawing.palette import FRAME, ink_of
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.words.studies import COSTS

Placed = list[tuple[int, int, Point]]
"""Column and row in the chart, and the point drawn there."""

MARKS: dict[Flaw, str] = {"lost": "x", "diverged": "x", "rounding": "~"}
"""The marks of points whose error says nothing about the order."""

ERROR_LABELS: dict[ErrorKind, str] = {
    "theta": "theta error [rad], the largest distance from the exact swing",
    "energy": "energy error, the largest of all steps, relative",
    "final": "theta error at the end [rad]",
}
BESIDE = 0.2  # the dotted line of an order runs at this share of the errors


def accuracy_chart(
    series: Sequence[Series], kind: ErrorKind, cost: Cost, width: int, height: int
) -> Picture:
    return loglog_chart(series, width, height, x_label=COSTS[cost], y_label=ERROR_LABELS[kind])


def placed(
    series: Sequence[Series], points: Sequence[Point], kind: ErrorKind, width: int, height: int
) -> Placed:
    """Return the cells of points on the chart of error over force evaluations."""
    if width < MIN_COLUMNS or height < MIN_ROWS:
        return []
    axes = LogLog.fitting(series, width, height)
    drawn = [point for point in points if 0 < point.error(kind) < math.inf]
    return [(*axes.cell(point.force_evaluations, point.error(kind)), point) for point in drawn]


def nearest(places: Placed, x: int, y: int) -> Point | None:
    """Return the point nearest to a cell, if there is one within 6 columns or 3 rows."""

    def distance(place: tuple[int, int, Point]) -> float:
        return math.hypot(place[0] - x, 2 * (place[1] - y))

    near = min(places, key=distance, default=None)
    if near is not None and distance(near) <= 6:
        return near[2]
    return None


def accuracy_series(
    points: Sequence[Point],
    kind: ErrorKind,
    cost: Cost,
    cast: Cast,
    *,
    marks: Sequence[tuple[str, Point]] = (),
) -> list[Series]:
    """Return points as letters, x if useless, ~ if limited by rounding; orders as dots."""

    def series(ink: int, mark: str, *some: Point) -> Series:
        return Series(ink, mark, [cost_of(p, cost) for p in some], [p.error(kind) for p in some])

    def flawed(ink: int, some: Sequence[Point]) -> list[Series]:
        return [series(ink, MARKS[flaw], p) for p in some if (flaw := p.flaw(kind))]

    lines: list[Series] = []
    flaws: list[Series] = []
    slopes: dict[int, Series] = {}  # by order
    for method in dict.fromkeys(point.method for point in points):
        ours = [point for point in points if point.method == method]
        ink = ink_of(method, cast)
        slopes = _slope(ours, kind, cost) | slopes
        lines.append(series(ink, method.letter, *ours))
        flaws += flawed(ink, ours)
    marked = [series(ink_of(point.method, cast), mark, point) for mark, point in marks]
    return [*slopes.values(), *lines, *flaws, *marked]


def _slope(ours: Sequence[Point], kind: ErrorKind, cost: Cost) -> dict[int, Series]:
    """Return a line below a method's valid points with the slope of their error, if any.

    It is measured: the energy of a method of order p may be right to a higher one (RK4: 5).
    """
    valid = [p for p in ours if not p.flaw(kind) and p.error(kind) and cost_of(p, cost)]
    if len(valid) < 2:
        return {}
    costs = np.array([cost_of(point, cost) for point in valid])
    errors = np.array([point.error(kind) for point in valid])
    order = -round(float(np.polyfit(np.log(costs), np.log(errors), 1)[0]))
    middle = len(valid) // 2
    ends = np.array([costs.min(), costs.max()])
    beside = BESIDE * errors[middle] * (ends / costs[middle]) ** -order
    return {order: Series(FRAME, f"slope {order}", ends, beside, dotted=True)}
