"""Points of an accuracy study -> log-log charts: of error over cost, and of error over time."""

import math
from collections.abc import Sequence

from engine.accuracy.front import Cost, cost_of
from engine.accuracy.growth import Growth
from engine.accuracy.references import CLOSED_FORM, TAYLOR_20, AnyPoint, References
from engine.accuracy.study import ErrorKind, Flaw, Point
from engine.methods import Cast
from tui.drawing.chart import MIN_COLUMNS, MIN_ROWS, LogLog, Series, loglog_chart
from tui.drawing.palette import EXACT, FRAME, TEXT, ink_of
from tui.drawing.picture import Picture
from tui.words.accuracy import COSTS

MARKS: dict[Flaw, str] = {"lost": "x", "diverged": "x", "rounding": "~"}
"""Of points that do not show how the error depends on h."""

ERROR_LABELS: dict[ErrorKind, str] = {
    "theta": "theta error [rad], the largest distance from the exact swing",
    "energy": "energy error, the largest of all steps, relative",
    "final": "theta error at the end [rad]",
}
Placed = tuple[tuple[int, int], AnyPoint]
"""Column and row of a point on the chart."""
REACH = 6  # columns, or half as many rows, within which the pointer finds a point
BESIDE = 0.2  # of a method's errors: where the dotted line of its order runs
MARKED = 12  # points of an error over time that get a letter


def raised(base: str, power: int) -> str:
    """A letter to a power."""
    return base + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in str(power) if power != 1)


def accuracy_chart(
    series: Sequence[Series], kind: ErrorKind, cost: Cost, width: int, height: int
) -> Picture:
    """The lines of `accuracy_series` on their axes."""
    return loglog_chart(series, width, height, x_label=COSTS[cost], y_label=ERROR_LABELS[kind])


def charted(
    series: Sequence[Series],
    points: Sequence[AnyPoint],
    kind: ErrorKind,
    cost: Cost,
    width: int,
    height: int,
) -> tuple[Picture, list[Placed]]:
    """The chart of these series, and where points are on it."""
    picture = accuracy_chart(series, kind, cost, width, height)
    if width < MIN_COLUMNS or height < MIN_ROWS:
        return picture, []
    axes = LogLog.fitting(series, width, height)
    drawn = [p for p in points if cost_of(p, cost) and 0 < p.error(kind) < math.inf]
    return picture, [(axes.cell(cost_of(p, cost), p.error(kind)), p) for p in drawn]


def nearest(cells: Sequence[Placed], x: int, y: int) -> AnyPoint | None:
    """The point nearest to a cell, if there is one within REACH."""

    def distance(cell: tuple[int, int]) -> int:
        return (cell[0] - x) ** 2 + (2 * (cell[1] - y)) ** 2

    cell, point = min(cells, key=lambda found: distance(found[0]), default=((0, 0), None))
    return point if distance(cell) <= REACH**2 else None


def accuracy_series(
    points: Sequence[Point],
    kind: ErrorKind,
    cost: Cost,
    marks: Sequence[tuple[str, Point]] = (),
    references: References | None = None,
    whole: int = 0,
    cast: Cast = (),
) -> list[Series]:
    """Letters for points, x for useless and ~ for rounding-limited ones, dotted lines for orders, and `marks`.

    Of methods with fewer points than a `whole` line has, no line joins those that are there.  The reference lines
    are Taylor's series and, upright, what the closed form takes.
    """

    def series(ink: int, some: Sequence[AnyPoint], mark: str) -> Series:
        return Series(ink, mark, [cost_of(p, cost) for p in some], [p.error(kind) for p in some])

    methods = dict.fromkeys(point.method for point in points)
    cast = tuple(dict.fromkeys((*cast, *methods)))
    by_method = [[point for point in points if point.method == method] for method in methods]
    slopes = [_slope(ours, kind, cost, points) for ours in by_method]
    found = [slope for slope in slopes if slope]
    joined = [
        each
        for ours in by_method
        for each in ([[p] for p in ours] if len(ours) < whole else [ours])
    ]
    found += (series(ink_of(ours[0].method, cast), ours, ours[0].method.letter) for ours in joined)
    found += (
        series(ink_of(p.method, cast), [p], MARKS[flaw]) for p in points if (flaw := p.flaw(kind))
    )
    if references:
        taylor = references.taylor
        found += [series(TEXT, taylor, TAYLOR_20.letter)] if taylor else []
        found += (series(TEXT, [p], MARKS[flaw]) for p in taylor if (flaw := p.flaw(kind)))
        every: list[AnyPoint] = [*points, *taylor]
        errors = [error for p in every if (error := p.error(kind)) and math.isfinite(error)]
        ends = [min(errors), max(errors)] if errors else []
        found.append(Series(EXACT, CLOSED_FORM.letter, [references.floor] * len(ends), ends))
    return [*found, *(series(ink_of(point.method, cast), [point], mark) for mark, point in marks)]


def growth_chart(found: Sequence[Growth], cast: Cast, width: int, height: int) -> Picture:
    """Letters for errors in theta along a run, and dotted lines of the powers of t that they follow."""
    lines: list[Series] = []
    slopes: dict[int, Series] = {}
    for growth in found:
        ink, times, errors = ink_of(growth.method, cast), growth.times, growth.errors
        some = (
            sorted({round(len(times) ** (n / MARKED)) - 1 for n in range(MARKED + 1)})
            if times
            else []
        )
        lines.append(
            Series(ink, growth.method.letter, [times[n] for n in some], [errors[n] for n in some])
        )
        if growth.power is not None:
            power, ends = round(growth.power), [times[0], times[-1]]
            slope = [BESIDE * errors[-1] * (t / times[-1]) ** power for t in ends]
            slopes.setdefault(power, Series(FRAME, raised("t", power), ends, slope, dotted=True))
    label = "theta error [rad], the largest of each period"
    return loglog_chart(
        [*slopes.values(), *lines], width, height, x_label="time [s]", y_label=label
    )


def _slope(
    ours: Sequence[Point], kind: ErrorKind, cost: Cost, points: Sequence[Point]
) -> Series | None:
    """A line with the slope of the method's order, below its errors; one for all methods of that order."""
    order = ours[0].method.order
    valid = [
        point
        for point in ours
        if not point.flaw(kind) and point.error(kind) and cost_of(point, cost)
    ]
    if not valid or ours[0].method != next(p.method for p in points if p.method.order == order):
        return None
    anchor = valid[len(valid) // 2]
    costs = [cost_of(point, cost) for point in points]
    ends = [min(costs), max(costs)]
    errors = [BESIDE * anchor.error(kind) * (end / cost_of(anchor, cost)) ** -order for end in ends]
    return Series(FRAME, raised("h", order), ends, errors, dotted=True)
