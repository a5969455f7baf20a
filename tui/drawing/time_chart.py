"""A quantity of all methods over time, as a chart that can be read out at each column."""

import math
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
from tui.drawing.palette import EXACT, FRAME, QUIET, TEXT, faint, inks
from tui.drawing.picture import Picture
from tui.playback.rows import Window
from tui.playback.shown import LARGEST, Shown

MIN_COLUMNS = 20
MIN_ROWS = 5
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
        """Return the values in a column, or in the last column before it that has any."""
        at = column - self.left
        if self.values is None or not 0 <= at < len(self.times):
            return None
        known = np.flatnonzero(~np.isnan(self.values[: at + 1]).all(axis=1))
        return (
            Reading(self.times[known[-1]], self.values[known[-1]].tolist()) if len(known) else None
        )

    def zoomed(
        self, whole: Window, factor: float, column: int | None = None
    ) -> tuple[float, float] | None:
        """Return the ends [s] of a stretch `factor` times as long.

        What is in the column, or in the middle, stays there.  None where it would be the whole run.
        """
        low, high = self.ends
        at = 0.5
        if column is not None:
            at = min(max((column - self.left + 0.5) / max(len(self.times), 1), 0.0), 1.0)
        fixed = low + at * (high - low)
        length = factor * (high - low)
        low, high = (
            (float(np.log10(end)) for end in _log_span(whole))
            if self.log_time
            else time_span(whole.x, None, 1)
        )
        begin = min(max(fixed - at * length, low), max(high - length, low))
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
        low = window.low[quantity][:, places]
        high = window.high[quantity][:, places]
        every = inks(cast)
        if is_ghost:
            ghosts = [faint(every[place]) for place in places]
            return cls(window, ghosts, [""] * len(places), low, high)
        letters = [cast[place].letter for place in places]
        return cls(window, [every[place] for place in places], letters, low, high)

    def per_column(self, axis: Axis, columns: int) -> tuple[Floats, Floats]:
        """Return the lowest and the highest value in each column, (columns, methods)."""
        return per_column(self.window.x, self.low, self.high, axis.low, axis.high, columns)

    def largest(self, axis: Axis, columns: int, log_time: bool) -> tuple[Floats, Floats]:
        """Return log10 of the largest magnitude at each column twice, (columns, methods).

        At the start errors are zero, which has no logarithm.
        """
        window = self.window
        magnitude = np.where(
            (window.x > 0)[:, None], np.fmax(abs(self.low), abs(self.high)), np.nan
        )
        high = np.log10(np.maximum(magnitude, FLOOR))
        if not log_time:
            largest = held(window.x, high, axis.low, axis.high, columns, window.repeats)
            return largest, largest
        largest = envelope(window.x, high, window.repeats)
        x = np.log10(np.maximum(window.x, 1e-9))
        highest = per_column(x, largest, largest, axis.low, axis.high, columns)[1]
        return highest, highest


@dataclass(frozen=True, slots=True)
class Marks:
    """What is drawn beside the curves of a chart."""

    ghost: tuple[Window, Cast] | None = None
    changes: Sequence[tuple[float, str]] = ()  # of the step: x [s] and a word
    line: tuple[float, str] | None = None  # a reference value and its name


def time_chart(
    window: Window, cast: Cast, shown: Shown, width: int, height: int, marks: Marks = Marks()
) -> TimePlot:
    """Chart the quantity that is shown over a stretch, the last seconds, or the whole run.

    On a linear axis, each column of characters spans the lowest to the highest value in it.  On a
    logarithmic axis, it shows the largest magnitude of the half swing that ends in it, or of the
    column if that is longer; otherwise zero crossings would tear the lines.  There a long run as a
    whole has a logarithmic axis of time, too: steady growth is a slope, and a bounded error is
    flat; and where one error passes another for the rest of the chart, there is a CROSSING.  Behind
    all that are the same methods of a ghost, fainter.  A line ends where it leaves the chart.
    """
    if width < MIN_COLUMNS or height < MIN_ROWS:
        return TimePlot(too_small(width, height, MIN_COLUMNS, MIN_ROWS))
    rows = height - 2
    places = shown.places(cast)
    runs = _curves(window, cast, shown, marks)
    log_time = _has_log_time(window, shown)
    if shown.log:
        columns = width - 1 - ROOM - LABEL
        x_axis = _time_axis(window, shown, columns, log_time)
        sides = [run.largest(x_axis, columns, log_time) for run in runs]
        y_axis = _log_y_axis([high for _, high in sides], _level(marks, shown), rows)
    else:
        y_axis = _linear_y_axis(runs, _level(marks, shown), rows)
        columns = width - 1 - ROOM - y_axis.label_width
        x_axis = _time_axis(window, shown, columns, log_time)
        sides = [run.per_column(x_axis, columns) for run in runs]
    low, high = sides[0]
    middles = x_axis.low + (np.arange(columns) + 0.5) / columns * (x_axis.high - x_axis.low)
    times = 10.0**middles if log_time else middles
    plot = _Plot(Canvas(width, height), width - columns - ROOM, x_axis, y_axis, columns, rows)
    plot.draw_axes()
    plot.draw_marks(marks, shown.log, log_time)
    for run, (lowest, highest) in reversed([*zip(runs, sides, strict=True)]):
        plot.draw_curves(run, lowest, highest, shown.log)
    if shown.log:
        for column, value in _crossings(high, times, window.repeats):
            row = plot.row(value)
            plot.canvas.label(plot.left + column, row, CROSSING, TEXT)
    values = 10.0**high if shown.log else np.where(abs(low) > abs(high), low, high)
    ends = (x_axis.low, x_axis.high)
    picture = plot.canvas.picture()
    return TimePlot(picture, places, plot.left, times.tolist(), values, ends, log_time)


def _curves(window: Window, cast: Cast, shown: Shown, marks: Marks) -> list[_Curves]:
    """Return the curves of the run, and those of the ghost's same methods."""
    places = shown.places(cast)
    curves = [_Curves.of(window, cast, places, shown.quantity)]
    if marks.ghost is not None:
        keys = {cast[place].key for place in places}
        behind = [place for place, method in enumerate(marks.ghost[1]) if method.key in keys]
        curves.append(_Curves.of(*marks.ghost, behind, shown.quantity, is_ghost=True))
    return curves


def _level(marks: Marks, shown: Shown) -> float | None:
    """Return where on the vertical axis the reference line is."""
    if marks.line is None:
        return None
    return float(np.log10(abs(marks.line[0]))) if shown.log else marks.line[0]


@dataclass(frozen=True, slots=True)
class _Plot:
    """A canvas with axes along its left edge and the lower one."""

    canvas: Canvas
    left: int  # column of the first moment
    x_axis: Axis
    y_axis: Axis
    columns: int
    rows: int

    def row(self, value: float) -> int:
        return row_at(float(self.rows * self.y_axis.share(value)), self.rows)

    def draw_axes(self) -> None:
        canvas = self.canvas
        left = self.left
        for row in range(self.rows):
            canvas.label(left - 1, row, "│", FRAME)
        canvas.label(left - 1, self.rows, "└".ljust(self.columns + ROOM + 1, "─"), FRAME)
        for value, text in self.y_axis.labels.items():
            row = self.row(value)
            canvas.label(0, row, text.rjust(left - 1), TEXT)
            canvas.label(left - 1, row, "┤", FRAME)
        end = 0  # of the label before
        for value, text in self.x_axis.labels.items():
            column = left + min(int(self.columns * self.x_axis.share(value)), self.columns - 1)
            begin = min(column - (len(text) - 1) // 2, canvas.columns - len(text))
            if begin >= end:
                canvas.label(column, self.rows, "┬", FRAME)
                canvas.label(begin, self.rows + 1, text, TEXT)
                end = begin + len(text) + 1

    def draw_marks(self, marks: Marks, log: bool, log_time: bool) -> None:
        """Draw a vertical line at each change of the step, and the reference line, dotted."""
        canvas = self.canvas
        for x, text in marks.changes:
            value = math.log10(max(x, 1e-9)) if log_time else x
            if self.x_axis.low < value < self.x_axis.high:
                at = 2 * (self.left + self.columns * float(self.x_axis.share(value)))
                canvas.line(at, 0, at, 4 * self.rows, FRAME, dotted=True)
                begin = min(int(at) // 2 + 1, canvas.columns - len(text))
                canvas.label(begin, self.rows - 1, text, QUIET)
        if marks.line is not None:
            value, text = marks.line
            level = math.log10(abs(value)) if log else value
            down = 4 * self.rows * (1 - float(self.y_axis.share(level)))
            end = 2 * (self.left + self.columns)
            canvas.line(2 * self.left, down, end, down, EXACT, dotted=True)
            row = min(max(int(down) // 4 - 1, 0), self.rows - 1)
            canvas.label(self.left + 1, row, text, EXACT)

    def draw_curves(self, run: _Curves, low: Floats, high: Floats, log: bool) -> None:
        """Draw the curves, and the letter of each at its end, or where it goes if it leaves."""
        limit = math.log10(LARGEST) if log else LARGEST
        for place, ink in enumerate(run.inks):
            lowest = low[:, place]
            highest = high[:, place]
            beyond = (highest > limit) | (lowest < -LARGEST)
            leaves = beyond & ~np.roll(beyond, 1)
            leaves[0] = beyond[0]
            gone = beyond & ~leaves
            lowest = np.where(gone, np.nan, lowest)
            highest = np.where(gone, np.nan, highest)
            bottom = self.rows * self.y_axis.share(lowest)
            top = self.rows * self.y_axis.share(highest)
            x, y = _outline(bottom, top)
            down = np.minimum(4 * (self.rows - y), 4 * self.rows - 1)
            self.canvas.path(np.stack([2 * (self.left + x) + 1.5, down], axis=1).tolist(), ink)
            letter = run.letters[place]
            known = np.flatnonzero(~np.isnan(high[:, place]))
            if not letter or not len(known):
                continue
            at = int(known[-1])
            if not beyond[at]:
                row = row_at(float(top[at]), self.rows)
                self._write(self.left + at + 1, row, letter, ink)
                continue
            at = int(np.flatnonzero(leaves)[-1])
            value = _last_value(run, place)
            arrow = "↓" if value < 0 and not log else "↑"
            row = self.rows - 1 if arrow == "↓" else 0
            text = f" {value:.0e}".replace("e+", "e") if math.isfinite(value) else ""
            self._write(self.left + at + 1, row, f"{arrow}{letter}{text}", ink)

    def _write(self, column: int, row: int, text: str, ink: int) -> None:
        """Write beside the end of a curve, in the nearest free cells."""
        across = range(ROOM if len(text) == 1 else 1)
        column = min(column, self.canvas.columns - len(text))
        near = [(column + right, row + down) for down in (0, 1, -1, 2, -2) for right in across]
        for begin, at in near:
            cells = [(begin + right, at) for right in range(len(text))]
            if at in range(self.rows) and all(self.canvas.is_blank(*cell) for cell in cells):
                self.canvas.label(begin, at, text, ink)
                return


def _last_value(run: _Curves, place: int) -> float:
    """Return the last value of a method, of the larger magnitude where there are two."""
    low = float(run.low[-1, place])
    high = float(run.high[-1, place])
    return low if abs(low) > abs(high) else high


def too_small(width: int, height: int, columns: int, rows: int) -> Picture:
    """Return a sentence in place of a chart."""
    return Picture.of_text(f"A chart needs {columns}×{rows} characters.", width, height, TEXT)


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


def _crossings(largest: Floats, times: Floats, repeats: float) -> list[tuple[int, float]]:
    """Return (column, height) where one of two curves passes the other for good.

    Before and after they are apart for half a swing, and for a part of the chart.
    """
    crossings = []
    for one, other in combinations(range(largest.shape[1]), 2):
        apart = largest[:, one] - largest[:, other]
        known = np.flatnonzero(~np.isnan(apart))
        turns = np.flatnonzero(np.diff(np.sign(apart[known]))) + 1
        if not 1 <= len(turns) <= 2:
            continue
        at = int(known[turns[-1]])
        before = times[known[turns[0]]] - times[known[0]]
        after = times[known[-1]] - times[at]
        columns = min(turns[0], len(known) - turns[-1])
        if min(before, after) >= repeats and columns >= max(FOR_GOOD * len(largest), 2):
            crossings.append((at, float(largest[at, [one, other]].mean())))
    return crossings


def _log_y_axis(sides: Sequence[Floats], level: float | None, rows: int) -> Axis:
    """Return an axis from the smallest error but for the first few columns to the largest.

    Errors begin at zero.
    """
    largest = np.hstack(sides)
    inside = (largest > np.log10(FLOOR)) & (largest <= np.log10(LARGEST))
    above = np.where(inside, largest, np.nan)
    known = ~np.isnan(above).all(axis=0)
    if not known.any():
        return log_axis(-4, 0, rows)
    top = float(np.nanmax(above))
    if (largest > np.log10(LARGEST)).any():
        top = float(np.log10(LARGEST))
    if level is not None:
        top = max(top, level)
    return log_axis(float(np.nanquantile(above[:, known], BELOW_AXIS, axis=0).min()), top, rows)


def _linear_y_axis(runs: Sequence[_Curves], level: float | None, rows: int) -> Axis:
    lowest = np.hstack([run.low.ravel() for run in runs])
    highest = np.hstack([run.high.ravel() for run in runs])
    if np.isnan(highest).all():
        return linear_axis(-1, 1, rows)
    ends = [float(np.nanmin(lowest)), float(np.nanmax(highest))]
    if level is not None:
        ends.append(level)
    low, high = np.clip([min(ends), max(ends)], -LARGEST, LARGEST).tolist()
    return linear_axis(low, high, rows)


def _outline(low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return columns and heights of a short line through all columns' lows and highs.

    What lies on the way between two points at the same height is left out.
    """
    known = np.flatnonzero(~np.isnan(low))
    low = low[known]
    high = high[known]
    falling = np.diff(low + high, prepend=0.0) < 0
    heights = np.stack([np.where(falling, high, low), np.where(falling, low, high)], axis=1).ravel()
    distinct = np.stack([np.full(len(low), True), low != high], axis=1).ravel()
    x = np.repeat(known, 2)[distinct]
    y = heights[distinct]
    bends = np.concatenate([[True], (y[1:-1] != y[:-2]) | (y[1:-1] != y[2:]), [True]])[: len(y)]
    return x[bends], y[bends]
