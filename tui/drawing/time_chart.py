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
    row_at,
    time_axis,
    time_span,
)
from tui.drawing.canvas import Canvas
from tui.drawing.palette import FRAME, TEXT, faint, inks
from tui.drawing.picture import Picture
from tui.playback.levels import Window
from tui.playback.shown import LARGEST, Shown

MIN_COLUMNS, MIN_ROWS = 20, 5
ROOM = 4  # columns for the letters at the right end
LABEL = 5  # columns of a label of decades
FLOOR = 1e-17  # below the resolution of doubles; zeros are drawn here
BELOW_AXIS = 0.05  # of the columns of an error may lie below the axis
FOR_GOOD = 0.1  # of the columns, before and after the crossing of two errors
CROSSING = "×"


class Reading(NamedTuple):
    """What a chart shows at a moment."""

    t: float  # s
    values: list[float]  # in the order of `places`; nan where not known


@dataclass(frozen=True, slots=True)
class TimePlot:
    """A chart, and the numbers in it."""

    picture: Picture
    places: Sequence[int] = ()  # in the cast
    left: int = 0  # column of the picture with the first moment
    times: Sequence[float] = ()  # s, at the middle of each column
    values: Floats | None = None  # (columns, methods)
    ends: tuple[float, float] = (0.0, 1.0)  # of its axis of time: s, or log10 of that
    log_time: bool = False

    def at(self, column: int) -> Reading | None:
        """Return the values in a column of the picture, or in the last one before it that has any."""
        at = column - self.left
        if self.values is None or not 0 <= at < len(self.times):
            return None
        known = np.flatnonzero(~np.isnan(self.values[: at + 1]).all(axis=1))
        return (
            Reading(self.times[known[-1]], self.values[known[-1]].tolist()) if len(known) else None
        )

    def zoomed(
        self, whole: Window, factor: float, column: int | None = None, shift: float = 0.0
    ) -> tuple[float, float] | None:
        """Return begin and end [s] of a stretch of `factor` times the length, or a `shift` of its length later.

        What is in the column, or in the middle, stays there.  None where it would be the whole run.
        """
        low, high = self.ends
        at = (
            0.5
            if column is None
            else min(max((column - self.left + 0.5) / max(len(self.times), 1), 0.0), 1.0)
        )
        fixed = low + at * (high - low)
        length = factor * (high - low)
        low, high = (
            (float(np.log10(end)) for end in _log_span(whole))
            if self.log_time
            else time_span(whole.x, None, 1)
        )
        begin = min(max(fixed - at * length + shift * length, low), max(high - length, low))
        end = min(begin + length, high)
        if begin == low and end == high:
            return None
        return (10.0**begin, 10.0**end) if self.log_time else (begin, end)


@dataclass(frozen=True, slots=True)
class _Curves:
    """The quantity of some methods of a run, or of a ghost behind it."""

    window: Window
    inks: list[int]
    letters: list[str]
    low: Floats  # (rows, methods)
    high: Floats

    @classmethod
    def of(
        cls,
        window: Window,
        cast: Cast,
        places: Sequence[int],
        quantity: str,
        is_ghost: bool = False,
    ) -> "_Curves":
        low = np.clip(window.low[quantity][:, places], -LARGEST, LARGEST)
        high = np.clip(window.high[quantity][:, places], -LARGEST, LARGEST)
        every = inks(cast)
        if is_ghost:
            return cls(
                window, [faint(every[place]) for place in places], [""] * len(places), low, high
            )
        letters = [cast[place].letter for place in places]
        return cls(window, [every[place] for place in places], letters, low, high)

    def largest(self, axis: Axis, columns: int, log_time: bool) -> Floats:
        """Return log10 of the largest magnitude at each column, (columns, methods)."""
        window = self.window
        high = np.log10(np.maximum(np.fmax(abs(self.low), abs(self.high)), FLOOR))
        if not log_time:
            return held(window.x, high, axis.low, axis.high, columns, window.repeats)
        largest = envelope(window.x, high, window.repeats)
        return per_column(
            np.log10(np.maximum(window.x, 1e-9)), largest, largest, axis.low, axis.high, columns
        )[1]


def time_chart(
    window: Window,
    cast: Cast,
    shown: Shown,
    width: int,
    height: int,
    ghost: tuple[Window, Cast] | None = None,
) -> TimePlot:
    """Chart the quantity that is shown over a stretch, the last seconds, or the whole run.

    On a linear axis, each column of characters spans the lowest to the highest value in it.  On a
    logarithmic axis, it shows the largest magnitude of the half swing that ends in it, or of the
    column if that is longer; otherwise zero crossings would tear the lines.  There a long run as a whole has
    a logarithmic axis of time, too: steady growth is a slope, and a bounded error is flat; and where one error
    passes another for the rest of the chart, there is a CROSSING.  Behind all that are the same methods of a
    `ghost`, fainter.
    """
    if width < MIN_COLUMNS or height < MIN_ROWS:
        return TimePlot(too_small(width, height, MIN_COLUMNS, MIN_ROWS))
    rows = height - 2
    places = shown.places(cast)
    runs = [_Curves.of(window, cast, places, shown.quantity)]
    if ghost is not None:
        keys = {cast[place].key for place in places}
        behind = [place for place, method in enumerate(ghost[1]) if method.key in keys]
        runs.append(_Curves.of(*ghost, behind, shown.quantity, is_ghost=True))
    log_time = _has_log_time(window, shown)
    if shown.log:
        columns = width - 1 - ROOM - LABEL
        x_axis = _time_axis(window, shown, columns, log_time)
        sides = [
            (largest, largest)
            for largest in (run.largest(x_axis, columns, log_time) for run in runs)
        ]
        y_axis = _log_y_axis(np.hstack([low for low, _ in sides]), rows)
    else:
        y_axis = _linear_y_axis(runs, rows)
        columns = width - 1 - ROOM - y_axis.label_width
        x_axis = _time_axis(window, shown, columns, log_time)
        sides = [
            per_column(run.window.x, run.low, run.high, x_axis.low, x_axis.high, columns)
            for run in runs
        ]
    canvas = Canvas(width, height)
    left = width - columns - ROOM
    _draw_axes(canvas, x_axis, y_axis, left, columns)
    for run, (low, high) in reversed([*zip(runs, sides, strict=True)]):
        heights = zip(
            run.inks, rows * y_axis.share(low).T, rows * y_axis.share(high).T, strict=True
        )
        for ink, lowest, highest in heights:
            x, y = _outline(lowest, highest)
            down = np.minimum(4 * (rows - y), 4 * rows - 1)
            canvas.path(np.stack([2 * (left + x) + 1.5, down], axis=1).tolist(), ink)
    if shown.log:
        for column, value in _crossings(sides[0][0]):
            canvas.label(
                left + column, row_at(float(rows * y_axis.share(value)), rows), CROSSING, TEXT
            )
    low, high = sides[0]
    _write_letters(canvas, runs[0], rows * y_axis.share(high), left)
    middles = x_axis.low + (np.arange(columns) + 0.5) / columns * (x_axis.high - x_axis.low)
    times = 10.0**middles if log_time else middles
    values = 10.0**high if shown.log else np.where(abs(low) > abs(high), low, high)
    return TimePlot(
        canvas.picture(), places, left, times.tolist(), values, (x_axis.low, x_axis.high), log_time
    )


def too_small(width: int, height: int, columns: int, rows: int) -> Picture:
    """Return a sentence in place of a chart."""
    return Picture.of_text(f"A chart needs {columns}×{rows} characters.", width, height, TEXT)


def _draw_axes(canvas: Canvas, x_axis: Axis, y_axis: Axis, left: int, columns: int) -> None:
    """Draw the axes along the left edge and the lower one of a chart, with their labels."""
    bottom = canvas.rows - 2
    for row in range(bottom):
        canvas.label(left - 1, row, "│", FRAME)
    canvas.label(left - 1, bottom, "└".ljust(columns + ROOM + 1, "─"), FRAME)
    for value, text in y_axis.labels.items():
        row = row_at(float(bottom * y_axis.share(value)), bottom)
        canvas.label(0, row, text.rjust(left - 1), TEXT)
        canvas.label(left - 1, row, "┤", FRAME)
    end = 0  # of the label before
    for value, text in x_axis.labels.items():
        column = left + min(int(columns * x_axis.share(value)), columns - 1)
        begin = min(column - (len(text) - 1) // 2, canvas.columns - len(text))
        if begin >= end:
            canvas.label(column, bottom, "┬", FRAME)
            canvas.label(begin, bottom + 1, text, TEXT)
            end = begin + len(text) + 1


def _write_letters(canvas: Canvas, run: _Curves, heights: Floats, left: int) -> None:
    """Write the letter of each curve beside its end, in the nearest free cell."""
    rows = canvas.rows - 2
    for letter, ink, curve in zip(run.letters, run.inks, heights.T, strict=True):
        known = np.flatnonzero(~np.isnan(curve))
        if not len(known):
            continue
        row = row_at(float(curve[known[-1]]), rows)
        column = left + int(known[-1]) + 1
        near = [(column + right, row + down) for down in (0, 1, -1, 2, -2) for right in range(ROOM)]
        free = (place for place in near if place[1] in range(rows) and canvas.is_blank(*place))
        if place := next(free, None):
            canvas.label(*place, letter, ink)


def _has_log_time(window: Window, shown: Shown) -> bool:
    if not shown.log:
        return False
    if shown.stretch is not None:
        return shown.stretch.log_time
    return shown.seconds is None and time_span(window.x, None, 1)[1] > LONG


def _log_span(window: Window) -> tuple[float, float]:
    """Return begin and end [s] of the logarithmic axis of a whole run."""
    _, end = time_span(window.x, None, 1)
    return max(log_start(end), min(window.repeats, end / 10)), end


def _time_axis(window: Window, shown: Shown, columns: int, log_time: bool) -> Axis:
    note = " run" if window.turned else ""
    make = log_time_axis if log_time else time_axis
    if shown.stretch is not None:
        return make(shown.stretch.begin, shown.stretch.end, columns, note)
    span = _log_span(window) if log_time else time_span(window.x, shown.seconds, columns)
    return make(*span, columns, note)


def _crossings(largest: Floats) -> list[tuple[int, float]]:
    """Return (column, height) where one of two curves passes the other for good."""
    crossings = []
    for one, other in combinations(range(largest.shape[1]), 2):
        apart = largest[:, one] - largest[:, other]
        known = np.flatnonzero(~np.isnan(apart))
        turns = np.flatnonzero(np.diff(np.sign(apart[known]))) + 1
        if not 1 <= len(turns) <= 2:
            continue
        if min(turns[0], len(known) - turns[-1]) >= max(FOR_GOOD * len(largest), 2):
            at = known[turns[-1]]
            crossings.append((int(at), float(largest[at, [one, other]].mean())))
    return crossings


def _log_y_axis(largest: Floats, rows: int) -> Axis:
    """Return an axis from the smallest error but for the first few columns, as errors begin at zero, to the largest."""
    above = np.where(largest > np.log10(FLOOR), largest, np.nan)
    known = ~np.isnan(above).all(axis=0)
    if not known.any():
        return log_axis(-4, 0, rows)
    return log_axis(
        float(np.nanquantile(above[:, known], BELOW_AXIS, axis=0).min()),
        float(np.nanmax(above)),
        rows,
    )


def _linear_y_axis(runs: Sequence[_Curves], rows: int) -> Axis:
    lowest = np.hstack([run.low.ravel() for run in runs])
    highest = np.hstack([run.high.ravel() for run in runs])
    if np.isnan(highest).all():
        return linear_axis(-1, 1, rows)
    return linear_axis(float(np.nanmin(lowest)), float(np.nanmax(highest)), rows)


def _outline(low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return columns and heights of a line through the lows and highs of all columns, in the order that keeps it short.

    What lies on the way between two points at the same height is left out.
    """
    known = np.flatnonzero(~np.isnan(low))
    low, high = low[known], high[known]
    falling = np.diff(low + high, prepend=0.0) < 0
    heights = np.stack([np.where(falling, high, low), np.where(falling, low, high)], axis=1).ravel()
    distinct = np.stack([np.full(len(low), True), low != high], axis=1).ravel()
    x, y = np.repeat(known, 2)[distinct], heights[distinct]
    bends = np.concatenate([[True], (y[1:-1] != y[:-2]) | (y[1:-1] != y[2:]), [True]])[: len(y)]
    return x[bends], y[bends]
