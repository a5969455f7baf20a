"""Arrays -> charts made of characters.  The only module that knows plotext.

plotext 6 aborts the process if a number is not finite or far outside the limits, so it only gets
numbers inside them.  It has one figure per process, hence the lock.
"""

import re
import threading
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from tui.drawing.axes import Axis
from tui.drawing.canvas import Canvas, Picture
from tui.drawing.loglog import ROOM, LogLog, Series, logs, row_at
from tui.drawing.palette import FRAME, NOBODY, TEXT

SMALLEST = (20, 5)  # columns, rows
_BLANKS = (ord(" "), 0x2800)
_FIRST_COLOUR = 32  # owners are passed through plotext as colours of the 256-colour palette, from this one

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
    blank = Canvas(width, 1).picture()
    picture = Picture.stacked(blank, plot(curves, x_axis, y_axis, width, height - 2), blank)
    picture.write(0, 0, y_label, TEXT)
    picture.write(height - 1, 0, x_label.rjust(width), TEXT)
    for curve in sorted(curves, key=lambda curve: curve.dotted):  # the references' marks where there is room
        for column, height in list(zip(curve.x, curve.y, strict=True))[-1 if curve.dotted else 0 :]:
            at, row = min(axes.left + int(column), width - len(curve.mark)), 1 + row_at(height, rows)
            around = [(row + down, at + right) for down in (0, -1, 1) for right in range(1, -8, -1)]
            near = around if curve.dotted else []
            picture.write(*first_free(picture, near, len(curve.mark), 1, rows + 1, (row, at)), curve.mark, curve.owner)
    return picture


def plot(curves: Sequence[Series], x_axis: Axis, y_axis: Axis, width: int, height: int) -> Picture:
    """Let plotext draw curves; the x axis ends before the columns for the letters."""
    import plotext  # 0.1 s, so only after the first paint

    rows, columns = height - 2, width - 1 - y_axis.label_width
    with _lock:
        plotext.terminal.limit(False, False)
        figure = plotext.figure
        figure.clear.data()
        figure.clear.settings()
        figure.plot_size(width, height)
        figure.axes(False)
        figure.axes(True, pixel=_FIRST_COLOUR + FRAME, axis=["x", "y"], side=0)
        for name, axis, size, used in (("x", x_axis, columns, columns - ROOM), ("y", y_axis, rows, rows)):
            ruler = figure.ruler(name, 0)
            ruler.alignment(lim="edge")
            ruler.lim(0, size)
            labels = [label.rjust(axis.label_width) if name == "y" else label for label in axis.labels.values()]
            ruler.ticks((used * axis.share(list(axis.labels))).tolist(), labels)
            ruler.pixel(_FIRST_COLOUR + TEXT)
        for curve in curves:
            marker = plotext.marker("braille", pixel=_FIRST_COLOUR + curve.owner)
            signal = figure.signal(np.asarray(curve.x).tolist(), np.asarray(curve.y).tolist(), marker=marker)
            figure.draw(signal.lines(not curve.dotted))
        drawn = figure.build().string()
    return _parsed(drawn, width, height)


_CODES_OR_TEXT = re.compile(r"\x1b\[([\d;]*)m|([^\x1b]+)")


def _parsed(drawn: str, width: int, height: int) -> Picture:
    """Text with colour codes -> characters and owners, ten times as fast as rich's own parser."""
    characters = np.full((height, width), ord(" "), np.uint32)
    owners = np.full((height, width), NOBODY, np.int8)
    for row, line in enumerate(drawn.split("\n")[:height]):
        column, owner = 0, NOBODY
        for codes, text in _CODES_OR_TEXT.findall(line):
            if codes.startswith("38;5;"):
                owner = int(codes[5:]) - _FIRST_COLOUR
            elif codes == "0":
                owner = NOBODY
            text = text[: width - column]
            if text:
                characters[row, column : column + len(text)] = np.frombuffer(text.encode("utf-32-le"), np.uint32)
                owners[row, column : column + len(text)] = owner
                column += len(text)
    return Picture(characters, owners)


def first_free(
    picture: Picture, places: Iterable[tuple[int, int]], length: int, top: int, end: int, otherwise: tuple[int, int]
) -> tuple[int, int]:
    """The first of these places (row, column) where `length` blank cells are, from row `top` to before row `end`."""
    width = picture.characters.shape[1]
    for row, column in places:
        inside = top <= row < end and 0 <= column <= width - length
        if inside and np.isin(picture.characters[row, column : column + length], _BLANKS).all():
            return row, column
    return otherwise


def too_small(width: int, height: int, columns: int, rows: int) -> Picture:
    """A sentence in place of a chart."""
    return Picture.of_text(f"A chart needs {columns}×{rows} characters.", width, height, TEXT)
