"""Charts with two logarithmic axes, drawn by plotext.  The only module that imports plotext.

plotext 6 aborts the process if a number is not finite or far outside the limits, so it only gets
numbers inside them.  Its logarithmic scale has wrong labels, so it gets logarithms.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from pendu_tui.tui.drawing.axes import Floats, Frame, log_axis, log_x_axis
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import FRAME, NOBODY, TEXT
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.drawing.time_chart import ROOM, too_small

MIN_COLUMNS = 20
MIN_ROWS = 7


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


class LogLog(Frame):
    """Two logarithmic axes, with a line of words above and one below."""

    @classmethod
    def fitting(cls, series: Sequence[Series], width: int, height: int) -> Self:
        rows = height - 4
        points = np.concatenate(
            [np.empty((0, 2)), *(one.logs() for one in series if not one.dotted)]
        )
        if not len(points):
            points = np.array([(0.0, -4.0), (1.0, 0.0)])
        (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
        y_axis = log_axis(bottom, top, rows)
        columns = width - 1 - ROOM - y_axis.label_width
        return cls(log_x_axis(left, right, columns), y_axis, columns, rows, width - columns - ROOM)

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
        """Return the column and row of a point."""
        return self.left + int(self.right(math.log10(x))), 1 + self.row(math.log10(y))


def loglog_chart(
    series: Sequence[Series], width: int, height: int, *, x_label: str, y_label: str
) -> Picture:
    """Draw marked points and dotted reference lines on two logarithmic axes that fit the points.

    Points that are not finite and positive are left out; reference lines are clipped.
    """
    if width < MIN_COLUMNS or height < MIN_ROWS:
        return too_small(width, height, MIN_COLUMNS, MIN_ROWS)
    axes = LogLog.fitting(series, width, height)
    curves = [(one, *axes.curve(one)) for one in series]
    canvas = Canvas(width, height)
    canvas.label(0, 0, y_label, TEXT)
    canvas.label(0, height - 1, x_label.rjust(width), TEXT)
    _plot(canvas, axes, curves)
    for one, x, y in sorted(curves, key=lambda curve: curve[0].dotted):
        last = width - len(one.mark)
        cells = [
            (min(axes.left + int(right), last), max(axes.rows - int(up), 1))
            for right, up in zip(x, y, strict=True)
        ]
        if not one.dotted:
            for column, row in cells:
                canvas.label(column, row, one.mark, one.ink)
        elif cells:
            column, row = cells[-1]
            rows = [at for at in (row, row - 1, row + 1) if 1 <= at <= axes.rows]
            near = [(column + right, at) for at in rows for right in range(1, -8, -1)]
            if not canvas.label_where_blank(near, one.mark, one.ink):
                canvas.label(column, row, one.mark, one.ink)
    return canvas.picture()


def _plot(
    canvas: Canvas, axes: LogLog, curves: Iterable[tuple[Series, list[float], list[float]]]
) -> None:
    """Have plotext draw the curves and the axes between the first and the last row."""
    import plotext  # takes 0.1 s

    def pixel(ink: int) -> "plotext.pixel":
        return plotext.pixel(foreground=(ink - NOBODY, 0, 0))

    width = canvas.columns
    height = canvas.rows - 2
    plotext.terminal.limit(False, False)
    figure = plotext.figure
    figure.clear.data()
    figure.clear.settings()
    figure.plot_size(width, height)
    figure.axes(False)
    figure.axes(True, pixel=pixel(FRAME), axis=["x", "y"], side=0)
    for name, axis, size, used, label_width in (
        ("x", axes.x_axis, axes.columns + ROOM, axes.columns, 0),
        ("y", axes.y_axis, axes.rows, axes.rows, axes.y_axis.label_width),
    ):
        ruler = figure.ruler(name, 0)
        ruler.alignment(lim="edge")
        ruler.lim(0, size)
        labels = [label.rjust(label_width) for label in axis.labels.values()]
        ruler.ticks((used * axis.share(list(axis.labels))).tolist(), labels)
        ruler.pixel(pixel(TEXT))
    for one, x, y in curves:
        signal = figure.signal(x, y, marker=plotext.marker("braille", pixel=pixel(one.ink)))
        figure.draw(signal.lines(not one.dotted))
    matrix = figure.build()
    for row, line in enumerate(matrix.string(colorless=True).split("\n")[:height]):
        for column, character in enumerate(line[:width]):
            if character not in " \u2800":
                red, _, _ = matrix.get(row, column).foreground()
                canvas.label(column, 1 + row, character, red + NOBODY)
