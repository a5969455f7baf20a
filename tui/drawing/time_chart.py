"""A chart of one quantity of all methods over time, which can be read out by column."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from pendu_tui.engine.methods import Cast
from pendu_tui.tui.drawing.axes import (
    Axis,
    Floats,
    Frame,
    linear_axis,
    log_axis,
    log_time_axis,
    per_column,
    time_axis,
    time_span,
)
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import EXACT, FRAME, QUIET, TEXT, faint, inks
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.playback.rows import Window
from pendu_tui.tui.playback.shown import Shown

MIN_COLUMNS = 20
MIN_ROWS = 5
ROOM = 4  # columns for the letters at the right end
FLOOR = 1e-17  # below the resolution of doubles; zeros are drawn here
LARGEST = 1e6  # larger values are off the chart, which leaves room for the other methods
LONG = 60.0  # s; longer runs have a logarithmic time axis
CROSSING = "×"


class Reading(NamedTuple):
    t: float  # s
    values: list[float]  # in the order of `places`; nan where not known


@dataclass(frozen=True, slots=True)
class TimePlot:
    """A chart and its numbers."""

    picture: Picture
    places: Sequence[int] = ()  # in the cast
    left: int = 0  # the column of the first moment
    times: Sequence[float] = ()  # s, at the middle of each column
    values: Floats | None = None  # (columns, methods)
    ends: tuple[float, float] = (0.0, 1.0)  # of the time axis: s, or log10 of it
    log_time: bool = False

    def at(self, column: int) -> Reading | None:
        """Return the values in a column, or in the last column before it that has any."""
        at = column - self.left
        if self.values is None or not 0 <= at < len(self.times):
            return None
        known = np.flatnonzero(~np.isnan(self.values[: at + 1]).all(axis=1))
        if not len(known):
            return None
        return Reading(self.times[known[-1]], self.values[known[-1]].tolist())

    def zoomed(
        self, whole: Window, factor: float, column: int | None = None
    ) -> tuple[float, float] | None:
        """Return the ends [s] of a stretch `factor` times as long.

        The moment at the column, or in the middle, stays there.  Returns None for the whole run.
        """
        low, high = self.ends
        share = 0.5
        if column is not None:
            share = min(max((column - self.left + 0.5) / len(self.times), 0.0), 1.0)
        length = factor * (high - low)
        begin = low + share * (high - low - length)
        limits = _time_axis(whole, Shown(), len(self.times), self.log_time)
        begin = min(max(begin, limits.low), max(limits.high - length, limits.low))
        end = min(begin + length, limits.high)
        if begin == limits.low and end == limits.high:
            return None
        return (10.0**begin, 10.0**end) if self.log_time else (begin, end)


class _Run(NamedTuple):
    """The quantity of some methods of a run, or of a ghost, which has no letters."""

    window: Window
    inks: list[int]
    letters: str
    low: Floats  # (rows, methods)
    high: Floats

    def columns(self, edges: Floats, log: bool, log_time: bool) -> tuple[Floats, Floats]:
        """Return the lowest and the highest value in each column, (columns, methods).

        On a logarithmic axis both are log10 of the largest magnitude at the column.
        """
        x = self.window.x
        if not log:
            return per_column(x, self.low, self.high, edges)
        hold = self.window.repeats
        if not log_time:  # in whole columns, or moving charts would flicker
            column = float(edges[-1] - edges[0]) / (len(edges) - 1)
            hold = column * math.ceil(hold / column)
        magnitude = np.maximum(np.fmax(abs(self.low), abs(self.high)), FLOOR)
        # the errors at the start are zero
        logs = np.where(x[:, None] > 0, np.log10(magnitude), np.nan)
        _, largest = per_column(x, logs, logs, edges, hold)
        return largest, largest


@np.errstate(over="ignore", invalid="ignore")  # an error may be infinite
def time_chart(
    window: Window,
    cast: Cast,
    shown: Shown,
    width: int,
    height: int,
    ghost: tuple[Window, Cast] | None = None,
    changes: Sequence[tuple[float, str]] = (),
) -> TimePlot:
    """Chart the quantity that is shown over a stretch, the last seconds, or the whole run.

    A column spans the lowest to the highest value in it.  On a logarithmic axis it shows the
    largest magnitude of the half swing that ends there, so that zeros do not tear the lines; long
    runs also have logarithmic time, so that a power law is straight.  A CROSSING is where one error
    passes another for good.  The same methods of a ghost lie behind, fainter.  `changes` of the
    step are pairs of x [s] and a label.
    """
    if width < MIN_COLUMNS or height < MIN_ROWS:
        return TimePlot(too_small(width, height, MIN_COLUMNS, MIN_ROWS))
    rows = height - 2
    runs = _runs(window, cast, shown, ghost)
    levels = _levels(shown)
    log_time = _has_log_time(window, shown)
    label_width = 5  # enough for decades
    if not shown.log:
        y_axis = _linear_y_axis(runs, levels, rows)
        label_width = y_axis.label_width
    columns = width - 1 - ROOM - label_width
    x_axis = _time_axis(window, shown, columns, log_time)
    edges, times = _moments(x_axis, columns, log_time)
    sides = [run.columns(edges, shown.log, log_time) for run in runs]
    if shown.log:
        y_axis = _log_y_axis(np.hstack([high for _, high in sides]), levels, rows)
    left = width - columns - ROOM
    plot = _Plot(x_axis, y_axis, columns, rows, left, Canvas(width, height), shown.log)
    plot.draw_axes()
    plot.draw_marks(changes, levels, log_time)
    for run, (low, high) in reversed([*zip(runs, sides, strict=True)]):
        plot.draw_curves(run, low, high)
    low, high = sides[0]
    values = np.where(abs(low) > abs(high), low, high)
    if shown.log:
        values = 10.0**high
        for column, value in _crossings(high, times, window.repeats):
            plot.canvas.label(left + column, plot.row(value), CROSSING, TEXT)
    picture = plot.canvas.picture()
    ends = (x_axis.low, x_axis.high)
    return TimePlot(picture, shown.places(cast), left, times.tolist(), values, ends, log_time)


def _runs(
    window: Window, cast: Cast, shown: Shown, ghost: tuple[Window, Cast] | None
) -> list[_Run]:

    def run(window: Window, cast: Cast, keys: set[str]) -> _Run:
        places = [place for place, method in enumerate(cast) if method.key in keys]
        low = window.low[shown.quantity][:, places]
        high = window.high[shown.quantity][:, places]
        letters = "".join(cast[place].letter for place in places)
        return _Run(window, [inks(cast)[place] for place in places], letters, low, high)

    keys = {cast[place].key for place in shown.places(cast)}
    runs = [run(window, cast, keys)]
    if ghost is not None:
        behind = run(*ghost, keys)
        runs.append(behind._replace(inks=[faint(ink) for ink in behind.inks], letters=""))
    return runs


@dataclass(frozen=True, slots=True)
class _Plot(Frame):
    """A canvas with axes at the left and at the bottom."""

    canvas: Canvas
    log: bool

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
        end = 0  # of the previous label
        for value, text in self.x_axis.labels.items():
            column = left + min(int(self.right(value)), self.columns - 1)
            begin = min(column - (len(text) - 1) // 2, canvas.columns - len(text))
            if begin >= end:
                canvas.label(column, self.rows, "┬", FRAME)
                canvas.label(begin, self.rows + 1, text, TEXT)
                end = begin + len(text) + 1

    def draw_marks(
        self, changes: Sequence[tuple[float, str]], levels: dict[str, float], log_time: bool
    ) -> None:
        canvas = self.canvas
        for x, text in changes:
            value = math.log10(max(x, FLOOR)) if log_time else x
            if self.x_axis.low < value < self.x_axis.high:
                at = 2 * (self.left + float(self.right(value)))
                canvas.line(at, 0, at, 4 * self.rows, FRAME, dotted=True)
                begin = min(int(at) // 2 + 1, canvas.columns - len(text))
                canvas.label(begin, self.rows - 1, text, QUIET)
        for text, level in levels.items():
            down = 4 * self.rows * (1 - float(self.y_axis.share(level)))
            end = 2 * (self.left + self.columns)
            canvas.line(2 * self.left, down, end, down, EXACT, dotted=True)
            row = min(max(int(down) // 4 - 1, 0), self.rows - 1)
            canvas.label(self.left + 1, row, text, EXACT)

    def draw_curves(self, run: _Run, low: Floats, high: Floats) -> None:
        """Draw each curve up to where it leaves the chart, and its letter where it ends."""
        limit = math.log10(LARGEST) if self.log else LARGEST
        beyond = (high > limit) | (low < -LARGEST)
        gone = beyond & np.roll(beyond, 1, axis=0)
        gone[0] = False
        bottom = self.up(np.where(gone, np.nan, low))
        top = self.up(np.where(gone, np.nan, high))
        for place, ink in enumerate(run.inks):
            x, y = _outline(bottom[:, place], top[:, place])
            down = np.minimum(4 * (self.rows - y), 4 * self.rows - 1)
            self.canvas.path(2 * (self.left + x) + 1.5, down, ink)
            known = np.flatnonzero(~np.isnan(high[:, place]))
            if not run.letters or not len(known):
                continue
            at = int(known[-1])
            text = run.letters[place]
            row = self.row(high[at, place])
            if beyond[at, place]:
                at = int(np.flatnonzero(beyond[:, place] & ~gone[:, place])[-1])
                value = max(run.high[-1, place], run.low[-1, place], key=abs)
                row = 0
                arrow = "↑"
                if value < 0 and not self.log:
                    row = self.rows - 1
                    arrow = "↓"
                number = f" {value:.0e}".replace("e+", "e") if math.isfinite(value) else ""
                text = f"{arrow}{text}{number}"
            self._write(self.left + at + 1, row, text, ink)

    def _write(self, column: int, row: int, text: str, ink: int) -> None:
        """Write beside the end of a curve, in the nearest free cells."""
        column = min(column, self.canvas.columns - len(text))
        across = range(ROOM if len(text) == 1 else 1)
        rows = [at for at in (row, row + 1, row - 1, row + 2, row - 2) if 0 <= at < self.rows]
        places = [(column + right, at) for at in rows for right in across]
        self.canvas.label_where_blank(places, text, ink)


def too_small(width: int, height: int, columns: int, rows: int) -> Picture:
    return Picture.of_text(f"A chart needs {columns}×{rows} characters.", width, height, TEXT)


def _levels(shown: Shown) -> dict[str, float]:
    """Return the height of the reference line by its name, if there is one."""
    line = shown.line
    if line is None or line.quantity != shown.quantity:
        return {}
    return {line.name: math.log10(abs(line.value)) if shown.log else line.value}


def _has_log_time(window: Window, shown: Shown) -> bool:
    if shown.stretch is not None:
        return shown.log and shown.stretch.log_time
    return shown.log and shown.seconds is None and bool((window.x > LONG).any())


def _time_axis(window: Window, shown: Shown, columns: int, log_time: bool) -> Axis:
    """Return the axis of a stretch, of the last seconds, or of the whole run.

    A logarithmic axis begins at a power of ten, two or three decades before its end.
    """
    begin, end = time_span(window.x, shown.seconds, columns)
    if shown.stretch is not None:
        _, begin, end, _ = shown.stretch
    elif log_time:
        begin = max(10.0 ** math.floor(math.log10(end) - 2.3), min(window.repeats, end / 10))
    note = " run" if window.turned else ""
    if log_time:
        return log_time_axis(begin, end, columns, note)
    return time_axis(begin, end, columns, note)


def _moments(axis: Axis, columns: int, log_time: bool) -> tuple[Floats, Floats]:
    """Return the moments [s] at the edges and in the middle of the columns."""
    half_columns = np.linspace(axis.low, axis.high, 2 * columns + 1)
    if log_time:
        half_columns = 10.0**half_columns
    return half_columns[::2], half_columns[1::2]


def _crossings(largest: Floats, times: Floats, repeats: float) -> Iterator[tuple[int, float]]:
    """Yield (column, height) where one curve passes another for good.

    They must be apart for half a swing and a tenth of the chart, before and after.
    """
    for one, other in combinations(largest.T, 2):
        known = np.flatnonzero(~np.isnan(one - other))
        turns = np.flatnonzero(np.diff(np.sign((one - other)[known]))) + 1
        if not 1 <= len(turns) <= 2:
            continue
        at = int(known[turns[-1]])
        before = times[known[turns[0]]] - times[known[0]]
        after = times[known[-1]] - times[at]
        columns = min(turns[0], len(known) - turns[-1])
        if min(before, after) >= repeats and columns >= max(0.1 * len(largest), 2):
            yield at, float(one[at] + other[at]) / 2


def _log_y_axis(largest: Floats, levels: dict[str, float], rows: int) -> Axis:
    """Return an axis of all errors but the smallest ones at the start."""
    limit = math.log10(LARGEST)
    known = [each[(each > math.log10(FLOOR)) & (each <= limit)] for each in largest.T]
    known = [each for each in known if len(each)]
    if not known:
        return log_axis(-4, 0, rows)
    top = limit if (largest > limit).any() else max(each.max() for each in known)
    bottom = min(np.sort(each)[len(each) // 20] for each in known)
    return log_axis(float(bottom), float(max([top, *levels.values()])), rows)


def _linear_y_axis(runs: list[_Run], levels: dict[str, float], rows: int) -> Axis:
    lowest = np.hstack([run.low.ravel() for run in runs])
    highest = np.hstack([run.high.ravel() for run in runs])
    if np.isnan(highest).all():
        return linear_axis(-1, 1, rows)
    ends = [np.nanmin(lowest), np.nanmax(highest), *levels.values()]
    low, high = np.clip([min(ends), max(ends)], -LARGEST, LARGEST).tolist()
    return linear_axis(low, high, rows)


def _outline(low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return columns and heights of a line through all columns' lows and highs."""
    known = np.flatnonzero(~np.isnan(low))
    low = low[known]
    high = high[known]
    falling = np.diff(low + high, prepend=0.0) < 0
    first = np.where(falling, high, low)
    last = np.where(falling, low, high)
    return np.repeat(known, 2), np.stack([first, last], axis=1).ravel()
