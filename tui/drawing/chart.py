"""Arrays -> charts made of characters.  The only module that knows plotext.

plotext 6 aborts the process if a number is not finite or far outside the limits, so it only gets
numbers inside them.  It has one figure per process, hence the lock.
"""

import re
import threading
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from engine.methods import Cast, Method
from tui.drawing.axes import (
    LONG,
    Axis,
    Floats,
    envelope,
    held,
    linear_axis,
    log_axis,
    log_start,
    log_time_axis,
    per_column,
    time_axis,
    time_span,
)
from tui.drawing.canvas import Canvas, Picture
from tui.drawing.loglog import ROOM, LogLog, Series, logs, row_at
from tui.drawing.palette import FRAME, NOBODY, TEXT
from tui.drawing.palette import series as series_of
from tui.playback.levels import Window
from tui.playback.shown import Quantity

FLOOR = 1e-17  # below the resolution of doubles; zeros are drawn here
TOP = 1e6  # larger magnitudes are drawn here, so that a failing method leaves room for the others
FEW = 0.05  # of the columns of an error, which may lie below the axis
LABEL = 5  # columns of a label of decades
SMALLEST = (20, 5)  # columns, rows
_FIRST_COLOUR = 32  # owners are passed through plotext as colours of the 256-colour palette, from this one

_lock = threading.Lock()


def time_chart(
    window: Window,
    cast: Cast,
    quantity: Quantity,
    width: int,
    height: int,
    *,
    log: bool = True,
    seconds: float | None = None,
    shown: Sequence[int] | None = None,
) -> Picture:
    """A quantity of a cast over the last `seconds`, or over the whole run; `shown`: only those at these places.

    On a linear axis, each column of characters spans the lowest to the highest value in it.  On a
    logarithmic axis, it shows the largest magnitude of the half swing that ends in it, or of the
    column if that is longer; otherwise zero crossings would tear the lines.  There a long run as a whole has
    a logarithmic axis of time, too: steady growth is a slope, and a bounded error is flat.
    """
    if width < SMALLEST[0] or height < SMALLEST[1]:
        return _too_small(width, height, *SMALLEST)
    places, rows = list(range(len(cast)) if shown is None else shown), height - 2
    low, high = (np.clip(side[quantity][:, places], -TOP, TOP) for side in (window.low, window.high))
    note = " run" if window.turned else ""
    if log:
        columns = width - 1 - ROOM - LABEL
        high = np.log10(np.maximum(np.fmax(abs(low), abs(high)), FLOOR))
        low, x_axis = _magnitudes(window, high, seconds, columns, note)
        high, y_axis = low, _log_y_axis(low, rows)
    else:
        y_axis = _linear_y_axis(low, high, rows)
        columns = width - 1 - ROOM - y_axis.label_width
        start, end = time_span(window.x, seconds, columns)
        low, high = per_column(window.x, low, high, start, end, columns)
        x_axis = time_axis(start, end, columns, note)
    heights = [(rows * y_axis.share(side)).T for side in (low, high)]
    curves = [_outline(cast[place], *each) for place, *each in zip(places, *heights, strict=True)]
    picture = _plot(curves, x_axis, y_axis, width, height)
    _write_letters(picture, curves, rows, width - columns - ROOM)
    return picture


def _magnitudes(window: Window, high: Floats, seconds: float | None, columns: int, note: str) -> tuple[Floats, Axis]:
    """The largest magnitude at each column, (columns, series), and the axis of time: logarithmic for a long run."""
    start, end = time_span(window.x, seconds, columns)
    if seconds is not None or end <= LONG:
        largest = held(window.x, high, start, end, columns, window.repeats)
        return largest, time_axis(start, end, columns, note)
    axis = log_time_axis(max(log_start(end), min(window.repeats, end / 10)), end, columns, note)
    largest = envelope(window.x, high, window.repeats)
    late = np.log10(np.maximum(window.x, 1e-9))
    return per_column(late, largest, largest, axis.low, axis.high, columns)[1], axis


def _log_y_axis(largest: Floats, rows: int) -> Axis:
    """From the smallest error but for the first few columns, as errors begin at zero, to the largest."""
    seen = np.where(largest > np.log10(FLOOR), largest, np.nan)
    known = ~np.isnan(seen).all(axis=0)
    if not known.any():
        return log_axis(-4, 0, rows)
    return log_axis(float(np.nanquantile(seen[:, known], FEW, axis=0).min()), float(np.nanmax(seen)), rows)


def _linear_y_axis(low: Floats, high: Floats, rows: int) -> Axis:
    if np.isnan(high).all():
        return linear_axis(-1, 1, rows)
    return linear_axis(float(np.nanmin(low)), float(np.nanmax(high)), rows)


def loglog_chart(series: Sequence[Series], width: int, height: int, *, x_label: str, y_label: str) -> Picture:
    """Points with marks on two logarithmic axes that fit them all, and dotted reference lines.

    Points that are not finite and positive are left out; reference lines are clipped.
    """
    if width < SMALLEST[0] or height < SMALLEST[1] + 2:
        return _too_small(width, height, SMALLEST[0], SMALLEST[1] + 2)
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
    picture = Picture.stacked(blank, _plot(curves, x_axis, y_axis, width, height - 2), blank)
    picture.write(0, 0, y_label, TEXT)
    picture.write(height - 1, 0, x_label.rjust(width), TEXT)
    for curve in curves:
        for column, row in list(zip(curve.x, curve.y, strict=True))[-1 if curve.dotted else 0 :]:
            at = min(axes.left + int(column), width - len(curve.mark))
            picture.write(1 + row_at(row, rows), at, curve.mark, curve.owner)
    return picture


def _outline(method: Method, low: Floats, high: Floats) -> Series:
    """A line through the lows and highs of all columns, in the order that keeps it short."""
    known = np.flatnonzero(~np.isnan(low))
    low, high = low[known], high[known]
    falling = np.diff(low + high, prepend=0.0) < 0
    heights = np.stack([np.where(falling, high, low), np.where(falling, low, high)], axis=1).ravel()
    distinct = np.stack([np.full(len(low), True), low != high], axis=1).ravel()
    return Series(series_of(method), method.letter, np.repeat(known + 0.5, 2)[distinct], heights[distinct])


def _plot(curves: Sequence[Series], x_axis: Axis, y_axis: Axis, width: int, height: int) -> Picture:
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


def _write_letters(picture: Picture, curves: Sequence[Series], rows: int, left: int) -> None:
    """Write each method's letter in the nearest free cell to the right of its line."""
    taken = set()
    for curve in curves:
        if not len(curve.x):
            continue
        column, row = left + int(curve.x[-1]) + 1, row_at(curve.y[-1], rows)
        places = [(row + down, column + right) for down in (0, 1, -1) for right in range(ROOM)]
        place = next((place for place in places if 0 <= place[0] < rows and place not in taken), None)
        if place:
            taken.add(place)
            picture.write(*place, curve.mark, curve.owner)


def _too_small(width: int, height: int, columns: int, rows: int) -> Picture:
    return Picture.of_text(f"A chart needs {columns}×{rows} characters.", width, height, TEXT)
