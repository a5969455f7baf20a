"""A quantity of all methods over time, as a chart that can be read out at each column."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from engine.methods import Cast
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
from tui.drawing.canvas import Canvas
from tui.drawing.chart import SMALLEST, first_free, plot, too_small
from tui.drawing.loglog import ROOM, Series, row_at
from tui.drawing.palette import TEXT, faint, inks
from tui.drawing.picture import Picture
from tui.playback.levels import Window
from tui.playback.shown import LARGEST, Quantity, Stretch

FLOOR = 1e-17  # below the resolution of doubles; zeros are drawn here
FEW = 0.05  # of the columns of an error, which may lie below the axis
LABEL = 5  # columns of a label of decades
LASTS = 0.1  # of the columns, before and after two errors cross for good
CROSSING = "×"


class Reading(NamedTuple):
    """What a chart shows at a moment."""

    t: float  # s
    values: list[float]  # in the order of `places`; nan where not known


@dataclass(frozen=True, slots=True)
class TimePlot:
    """A chart, and what it shows."""

    picture: Picture
    places: Sequence[int] = ()  # in the cast
    left: int = 0  # column of the picture with the first moment
    times: Sequence[float] = ()  # s, at the middle of each column
    values: Floats | None = None  # (columns, methods)
    ends: tuple[float, float] = (0.0, 1.0)  # of its axis of time: s, or log10 of that
    log_time: bool = False

    @property
    def column(self) -> float:
        """The time in the last column [s]."""
        return self.times[-1] - self.times[-2] if len(self.times) > 1 else 0.0

    def at(self, column: int) -> Reading | None:
        """What is shown in a column of the picture, or in the last one before it that shows anything."""
        at = column - self.left
        if self.values is None or not 0 <= at < len(self.times):
            return None
        known = np.flatnonzero(~np.isnan(self.values[: at + 1]).all(axis=1))
        return Reading(self.times[known[-1]], self.values[known[-1]].tolist()) if len(known) else None

    def zoomed(
        self, whole: Window, factor: float, column: int | None = None, shift: float = 0.0
    ) -> tuple[float, float] | None:
        """Begin and end [s] of a stretch of `factor` times the length, or later by a `shift` of its length.

        What is in the column, or in the middle, stays there.  None where it would be the whole run.
        """
        low, high = self.ends
        at = 0.5 if column is None else min(max((column - self.left + 0.5) / max(len(self.times), 1), 0.0), 1.0)
        still, length = low + at * (high - low), factor * (high - low)
        low, high = (float(np.log10(end)) for end in _log_span(whole)) if self.log_time else time_span(whole.x, None, 1)
        begin = min(max(still - at * length + shift * length, low), max(high - length, low))
        end = min(begin + length, high)
        if begin == low and end == high:
            return None
        return (10.0**begin, 10.0**end) if self.log_time else (begin, end)


@dataclass(frozen=True, slots=True)
class _Part:
    """The curves of a run, or of a ghost behind it."""

    window: Window
    inks: list[int]
    letters: list[str]
    low: Floats  # (rows, methods), and later (columns, methods)
    high: Floats


def time_chart(
    window: Window,
    cast: Cast,
    quantity: Quantity,
    width: int,
    height: int,
    *,
    log: bool = True,
    seconds: float | None = None,
    stretch: Stretch | None = None,
    shown: Sequence[int] | None = None,
    ghost: tuple[Window, Cast] | None = None,
) -> TimePlot:
    """A quantity of a cast over a `stretch`, the last `seconds`, or the whole run; `shown`: only those at these places.

    On a linear axis, each column of characters spans the lowest to the highest value in it.  On a
    logarithmic axis, it shows the largest magnitude of the half swing that ends in it, or of the
    column if that is longer; otherwise zero crossings would tear the lines.  There a long run as a whole has
    a logarithmic axis of time, too: steady growth is a slope, and a bounded error is flat; and where one error
    passes another for the rest of the chart, there is a CROSSING.  Behind all that are the same methods of a
    `ghost`, fainter.
    """
    if width < SMALLEST[0] or height < SMALLEST[1]:
        return TimePlot(too_small(width, height, *SMALLEST))
    places, rows = list(range(len(cast)) if shown is None else shown), height - 2
    parts = [_part(window, cast, quantity, places)]
    if ghost is not None:
        keys = {cast[place].key for place in places}
        behind = [place for place, method in enumerate(ghost[1]) if method.key in keys]
        parts.append(_part(*ghost, quantity, behind, is_ghost=True))
    note = " run" if window.turned else ""
    log_time = log and seconds is None and time_span(window.x, seconds, 1)[1] > LONG
    log_time = log and stretch.log_time if stretch is not None else log_time
    if log:
        columns = width - 1 - ROOM - LABEL
        x_axis = _time_axis(window, stretch, seconds, columns, note, log_time)
        sides = [(largest, largest) for largest in (_largest(part, x_axis, columns, log_time) for part in parts)]
        y_axis = _log_y_axis(np.hstack([low for low, _ in sides]), rows)
    else:
        y_axis = _linear_y_axis([part.low for part in parts], [part.high for part in parts], rows)
        columns = width - 1 - ROOM - y_axis.label_width
        x_axis = _time_axis(window, stretch, seconds, columns, note, log_time)
        sides = [per_column(part.window.x, part.low, part.high, x_axis.low, x_axis.high, columns) for part in parts]
    curves = [
        _outline(ink, letter, *heights)
        for part, ends in reversed([*zip(parts, sides, strict=True)])
        for ink, letter, *heights in zip(
            part.inks, part.letters, *((rows * y_axis.share(end)).T for end in ends), strict=True
        )
    ]
    canvas, left = Canvas(width, height), width - columns - ROOM
    plot(canvas, curves, x_axis, y_axis, 0, height)
    if log:
        for column, value in _crossings(sides[0][0]):
            row = row_at(float(rows * y_axis.share(value)), rows)
            canvas.label(left + column, row, CROSSING, TEXT)
    for curve in curves:
        if curve.mark and len(curve.x):
            row, column = row_at(curve.y[-1], rows), left + int(curve.x[-1]) + 1
            near = [(row + down, column + right) for down in (0, 1, -1, 2, -2) for right in range(ROOM)]
            if free := first_free(canvas, near, 1, 0, rows):
                canvas.label(free[1], free[0], curve.mark, curve.ink)
    middles = x_axis.low + (np.arange(columns) + 0.5) / columns * (x_axis.high - x_axis.low)
    low, high = sides[0]
    values = 10.0**high if log else np.where(abs(low) > abs(high), low, high)
    times = (10.0**middles if log_time else middles).tolist()
    return TimePlot(canvas.picture(), places, left, times, values, (x_axis.low, x_axis.high), log_time)


def _part(window: Window, cast: Cast, quantity: Quantity, places: Sequence[int], is_ghost: bool = False) -> _Part:
    low, high = (np.clip(side[quantity][:, places], -LARGEST, LARGEST) for side in (window.low, window.high))
    ink = inks(cast)
    colours = [ink[place] for place in places]
    if is_ghost:
        return _Part(window, [faint(each) for each in colours], [""] * len(colours), low, high)
    return _Part(window, colours, [cast[place].letter for place in places], low, high)


def _log_span(window: Window) -> tuple[float, float]:
    """Begin and end [s] of the logarithmic axis of a whole run."""
    _, end = time_span(window.x, None, 1)
    return max(log_start(end), min(window.repeats, end / 10)), end


def _time_axis(
    window: Window, stretch: Stretch | None, seconds: float | None, columns: int, note: str, log_time: bool
) -> Axis:
    """The axis of time; `log_time`: a logarithmic one, for a long run."""
    if stretch is not None:
        return (log_time_axis if log_time else time_axis)(stretch.begin, stretch.end, columns, note)
    if log_time:
        return log_time_axis(*_log_span(window), columns, note)
    return time_axis(*time_span(window.x, seconds, columns), columns, note)


def _largest(part: _Part, axis: Axis, columns: int, log_time: bool) -> Floats:
    """log10 of the largest magnitude at each column, (columns, methods)."""
    window, high = part.window, np.log10(np.maximum(np.fmax(abs(part.low), abs(part.high)), FLOOR))
    if not log_time:
        return held(window.x, high, axis.low, axis.high, columns, window.repeats)
    largest = envelope(window.x, high, window.repeats)
    return per_column(np.log10(np.maximum(window.x, 1e-9)), largest, largest, axis.low, axis.high, columns)[1]


def _crossings(largest: Floats) -> list[tuple[int, float]]:
    """(column, height) where one of two curves passes the other for good."""
    found, count = [], largest.shape[1]
    for one, other in combinations(range(count), 2):
        apart = largest[:, one] - largest[:, other]
        known = np.flatnonzero(~np.isnan(apart))
        turns = np.flatnonzero(np.diff(np.sign(apart[known]))) + 1
        if len(turns) and min(turns[0], len(known) - turns[-1]) >= max(LASTS * len(largest), 2) and len(turns) <= 2:
            at = known[turns[-1]]
            found.append((int(at), float(largest[at, [one, other]].mean())))
    return found


def _log_y_axis(largest: Floats, rows: int) -> Axis:
    """From the smallest error but for the first few columns, as errors begin at zero, to the largest."""
    seen = np.where(largest > np.log10(FLOOR), largest, np.nan)
    known = ~np.isnan(seen).all(axis=0)
    if not known.any():
        return log_axis(-4, 0, rows)
    return log_axis(float(np.nanquantile(seen[:, known], FEW, axis=0).min()), float(np.nanmax(seen)), rows)


def _linear_y_axis(low: Sequence[Floats], high: Sequence[Floats], rows: int) -> Axis:
    lowest, highest = np.hstack([each.ravel() for each in low]), np.hstack([each.ravel() for each in high])
    if np.isnan(highest).all():
        return linear_axis(-1, 1, rows)
    return linear_axis(float(np.nanmin(lowest)), float(np.nanmax(highest)), rows)


def _outline(ink: int, letter: str, low: Floats, high: Floats) -> Series:
    """A line through the lows and highs of all columns, in the order that keeps it short, but for what is flat."""
    known = np.flatnonzero(~np.isnan(low))
    low, high = low[known], high[known]
    falling = np.diff(low + high, prepend=0.0) < 0
    heights = np.stack([np.where(falling, high, low), np.where(falling, low, high)], axis=1).ravel()
    distinct = np.stack([np.full(len(low), True), low != high], axis=1).ravel()
    x, y = np.repeat(known + 0.5, 2)[distinct], heights[distinct]
    bends = np.concatenate([[True], (y[1:-1] != y[:-2]) | (y[1:-1] != y[2:]), [True]])[: len(y)]
    return Series(ink, letter, x[bends], y[bends])
