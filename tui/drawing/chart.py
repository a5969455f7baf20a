"""Arrays -> charts made of characters.  The only module that imports plotext.

plotext 6 aborts the process if a number is not finite or far outside the limits, so it only gets
numbers inside them.  It has one figure per process, hence the lock.
"""

import threading
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from tui.drawing.axes import Axis
from tui.drawing.canvas import Canvas
from tui.drawing.loglog import ROOM, LogLog, Series, logs, row_at
from tui.drawing.palette import FRAME, NOBODY, TEXT
from tui.drawing.picture import Picture

SMALLEST = (20, 5)  # columns, rows
_BLANKS = " \u2800"

_lock = threading.Lock()


def loglog_chart(series: Sequence[Series], width: int, height: int, *, x_label: str, y_label: str) -> Picture:
    """Points with marks on two logarithmic axes that fit them all, and dotted reference lines.

    Points that are not finite and positive are left out; reference lines are clipped.
    """
    if width < SMALLEST[0] or height < SMALLEST[1] + 2:
        return too_small(width, height, SMALLEST[0], SMALLEST[1] + 2)
    axes = LogLog.fitting(series, width, height)
    x_axis, y_axis, columns, rows = axes.x_axis, axes.y_axis, axes.columns, axes.rows
    points = [logs(one) for one in series]
    curves = []
    for one, (x, y) in zip(series, (some.T for some in points), strict=True):
        if one.dotted and len(x):
            across = np.linspace(x_axis.low, x_axis.high, columns)
            x, y = across, np.interp(across, x, y, left=np.nan, right=np.nan)
            inside = (y >= y_axis.low) & (y <= y_axis.high)
            x, y = x[inside], y[inside]
        curves.append(replace(one, x=columns * x_axis.share(x), y=rows * y_axis.share(y)))
    canvas = Canvas(width, height)
    plot(canvas, curves, x_axis, y_axis, 1, height - 2)
    canvas.label(0, 0, y_label, TEXT)
    canvas.label(0, height - 1, x_label.rjust(width), TEXT)
    for curve in sorted(curves, key=lambda curve: curve.dotted):  # the references' marks where there is room
        for column, height in list(zip(curve.x, curve.y, strict=True))[-1 if curve.dotted else 0 :]:
            at, row = min(axes.left + int(column), width - len(curve.mark)), 1 + row_at(height, rows)
            around = [(row + down, at + right) for down in (0, -1, 1) for right in range(1, -8, -1)]
            near = around if curve.dotted else []
            place = first_free(canvas, near, len(curve.mark), 1, rows + 1) or (row, at)
            canvas.label(place[1], place[0], curve.mark, curve.ink)
    return canvas.picture()


def plot(canvas: Canvas, curves: Sequence[Series], x_axis: Axis, y_axis: Axis, top: int, height: int) -> None:
    """Let plotext draw curves on rows of a canvas; the x axis ends before the columns for the letters."""
    import plotext  # 0.1 s, so only after the first paint

    width, rows = canvas.columns, height - 2
    columns = width - 1 - y_axis.label_width
    inks = {FRAME, TEXT, *(curve.ink for curve in curves)}
    pixels = {ink: plotext.pixel(foreground=(ink - NOBODY, 0, 0)) for ink in inks}
    with _lock:
        plotext.terminal.limit(False, False)
        figure = plotext.figure
        figure.clear.data()
        figure.clear.settings()
        figure.plot_size(width, height)
        figure.axes(False)
        figure.axes(True, pixel=pixels[FRAME], axis=["x", "y"], side=0)
        for name, axis, size, used in (("x", x_axis, columns, columns - ROOM), ("y", y_axis, rows, rows)):
            ruler = figure.ruler(name, 0)
            ruler.alignment(lim="edge")
            ruler.lim(0, size)
            labels = [label.rjust(axis.label_width) if name == "y" else label for label in axis.labels.values()]
            ruler.ticks((used * axis.share(list(axis.labels))).tolist(), labels)
            ruler.pixel(pixels[TEXT])
        for curve in curves:
            marker = plotext.marker("braille", pixel=pixels[curve.ink])
            signal = figure.signal(np.asarray(curve.x).tolist(), np.asarray(curve.y).tolist(), marker=marker)
            figure.draw(signal.lines(not curve.dotted))
        matrix = figure.build()
        for row, line in enumerate(matrix.string(colorless=True).split("\n")[:height]):
            for column, character in enumerate(line[:width]):
                if character not in _BLANKS:
                    red, _, _ = matrix.get(row, column).foreground()
                    canvas.label(column, top + row, character, red + NOBODY)


def first_free(
    canvas: Canvas, places: Iterable[tuple[int, int]], length: int, top: int, end: int
) -> tuple[int, int] | None:
    """Return the first of these places (row, column) where `length` cells are free, from row `top` to before `end`."""
    for row, column in places:
        if top <= row < end and all(canvas.is_free(column + at, row) for at in range(length)):
            return row, column
    return None


def too_small(width: int, height: int, columns: int, rows: int) -> Picture:
    """A sentence in place of a chart."""
    return Picture.of_text(f"A chart needs {columns}×{rows} characters.", width, height, TEXT)
