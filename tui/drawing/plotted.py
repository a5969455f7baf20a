"""Charts that plotext draws: of two logarithmic axes, and of a record's energies over time.

plotext 6 aborts the process if a number is not finite or far outside the limits, so it only gets
numbers inside them.  Its pixels have one colour, so each ink has a figure of its own.
Only this module imports plotext.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pendu_tui.tui.drawing.frame import (
    Axis,
    Floats,
    LineChart,
    columns_beside,
    linear_axis,
    log_axis,
    log_x_axis,
    number_ticks,
)
from pendu_tui.tui.drawing.picture import QUIET, TEXT, Picture

MIN_COLUMNS = 20  # smaller charts have so many, too
MIN_ROWS = 6


@dataclass(frozen=True, slots=True)
class Series:
    """Marked points joined by lines, or a dotted reference line named at its end."""

    ink: int
    mark: str  # a letter; a name for a reference
    x: Floats | Sequence[float]  # (n,)
    y: Floats | Sequence[float]  # (n,)
    dotted: bool = False

    def logs(self) -> Floats:
        """Return log10 of the finite positive points, (n, 2), sorted by x."""
        points = np.stack([np.asarray(self.x, np.float64), np.asarray(self.y, np.float64)], axis=1)
        points = points[(np.isfinite(points) & (points > 0)).all(axis=1)]
        return np.log10(points[np.argsort(points[:, 0], kind="stable")])


class LogLog(LineChart):
    """Two logarithmic axes that fit some series, below a line of words and above one."""

    picture: Picture

    @classmethod
    def fitting(cls, series: Sequence[Series], width: int, height: int) -> "LogLog":
        width = max(width, MIN_COLUMNS)
        rows = max(height, MIN_ROWS) - 3
        points = np.concatenate(
            [np.empty((0, 2)), *(one.logs() for one in series if not one.dotted)]
        )
        if not len(points):
            points = np.array([(0.0, -4.0), (1.0, 0.0)])
        (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
        y_axis = log_axis(bottom, top, rows)
        columns = columns_beside(y_axis.label_width, width)
        return cls(log_x_axis(left, right, columns), y_axis, columns, rows)

    def curve(self, series: Series) -> tuple[list[float], list[float]]:
        """Return x and y in characters from the lower left corner; references are clipped."""
        x, y = series.logs().T
        if series.dotted and len(x):
            across = np.linspace(self.x_axis.low, self.x_axis.high, self.columns)
            up = np.interp(across, x, y, left=np.nan, right=np.nan)
            inside = (up >= self.y_axis.low) & (up <= self.y_axis.high)
            x = across[inside]
            y = up[inside]
        return self.right(x).tolist(), self.up(y).tolist()

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """Return the column and row of a point in the picture."""
        return self.left + self.column(math.log10(x)), 1 + self.row(math.log10(y))


def loglog_chart(
    series: Sequence[Series], width: int, height: int, *, x_label: str, y_label: str
) -> LogLog:
    """Draw marked points and dotted reference lines on two logarithmic axes that fit the points.

    Points that are not finite and positive are left out; reference lines are clipped.
    """
    axes = LogLog.fitting(series, width, height)
    canvas = axes.canvas
    curves = [(one, *axes.curve(one)) for one in series]
    for ink in dict.fromkeys(one.ink for one, *_ in curves):
        some = [(x, y, one.dotted) for one, x, y in curves if one.ink == ink]
        canvas.braille(plotted(some, axes.width, axes.rows), ink)
    for one, x, y in sorted(curves, key=lambda curve: curve[0].dotted):
        last = axes.width - len(one.mark)
        cells = [
            (min(int(right), last), max(axes.rows - 1 - int(up), 0))
            for right, up in zip(x, y, strict=True)
        ]
        if not one.dotted:
            for column, row in cells:
                canvas.label(column, row, one.mark, one.ink)
        elif cells:
            column, row = cells[-1]
            beside = range(column + 1, column - 8, -1)
            near = [(at, down) for down in (row, row - 1, row + 1) for at in beside]
            if not canvas.label_where_blank(near, f" {one.mark}", QUIET):
                canvas.label(column, row, one.mark, QUIET)
    width = axes.left + axes.width
    above = y_label[:width].ljust(width)
    below = x_label[:width].rjust(width)
    axes.picture = Picture([[(above, TEXT)], *axes.framed(), [(below, TEXT)]])
    return axes


def plotted(
    curves: Sequence[tuple[list[float], list[float], bool]], columns: int, rows: int
) -> list[str]:
    """Have plotext draw curves of one ink, and return rows of braille.

    A curve has x and y in characters from the lower left corner, and may be dotted.
    """
    import plotext  # takes 0.1 s

    plotext.terminal.limit(False, False)
    figure = plotext.figure
    figure.clear.data()
    figure.clear.settings()
    figure.plot_size(columns, rows)
    figure.axes(False)
    for name, size in (("x", columns), ("y", rows)):
        ruler = figure.ruler(name, 0)
        ruler.alignment(lim="edge")
        ruler.lim(0, size)
        ruler.ticks([], [])
    for x, y, is_dotted in curves:
        signal = figure.signal(x, y, marker=plotext.marker("braille"))
        figure.draw(signal.lines(not is_dotted))
    text: str = figure.build().string(colorless=True)
    return text.split("\n")[:rows]


TREND = 0  # an ink, as that of a method, so that neither hides the other
ENERGY = 1
DOTS = 2  # of braille in a column


def record_chart(
    times: Floats,
    errors: Floats,
    size: tuple[int, int],
    *,
    slope: float | None,
    deviation: float | None,
    title: str,
    unit: str,
) -> Picture:
    """Draw errors (n,) over times (n,) of this unit, on `size` columns and rows, below a title.

    Dotted lines through their mean have the `slope`, and lie two `deviation`s beside it.  A column
    of dots spans the lowest to the highest error in it.
    """
    width = max(size[0], MIN_COLUMNS)
    rows = max(size[1], MIN_ROWS) - 2
    trend = errors.mean() + (slope or 0.0) * (times[[0, -1]] - times.mean())
    edges = [trend + sigmas * (deviation or 0.0) for sigmas in (-2, 2)]
    span = np.concatenate([errors, *edges])
    y_axis = linear_axis(span.min(), span.max(), rows)
    first = times[0]
    last = times[-1]
    columns = columns_beside(y_axis.label_width, width)
    labels = number_ticks(first, last, max(columns // 12, 1))
    labels[max(labels)] += f" {unit}".rstrip()
    chart = LineChart(Axis(first, last, labels), y_axis, columns, rows)

    def draw(ink: int, x: Floats, y: Floats, *, dotted: bool) -> None:
        curve = (chart.right(x).tolist(), chart.up(y).tolist(), dotted)
        chart.canvas.braille(plotted([curve], chart.width, rows), ink)

    draw(ENERGY, *_spans(times, errors, DOTS * columns), dotted=False)
    lines = [(QUIET, edge) for edge in edges]
    if slope is not None:
        lines.append((TREND, trend))
    for ink, (begin, end) in lines:
        x = np.linspace(first, last, columns)
        draw(ink, x, np.linspace(begin, end, columns), dotted=True)
    return Picture([[(title[:width].ljust(width), TEXT)], *chart.framed()])


def _spans(times: Floats, errors: Floats, count: int) -> tuple[Floats, Floats]:
    """Return the lowest and the highest of each of `count` parts, in turn."""
    first = np.arange(count) * len(times) // count
    low = np.minimum.reduceat(errors, first)
    high = np.maximum.reduceat(errors, first)
    return np.repeat(times[first], 2), np.stack([low, high], axis=1).ravel()
