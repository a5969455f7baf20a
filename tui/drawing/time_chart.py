"""A chart of one quantity of all methods over time, which can be read out by column."""

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.methods import Cast
from pendu_tui.tui.drawing.frame import (
    Axis,
    End,
    Floats,
    LineChart,
    columns_beside,
    linear_axis,
    log_axis,
    log_time_axis,
    time_axis,
)
from pendu_tui.tui.drawing.picture import EXACT, FRAME, QUIET, TEXT, Picture, faint, inks
from pendu_tui.tui.playback.rows import Window
from pendu_tui.tui.playback.shown import Shown

MIN_COLUMNS = 20  # smaller charts have so many, too
MIN_ROWS = 4
FLOOR = 1e-17  # below the resolution of doubles; zeros are drawn here
LARGEST = 1e6  # larger values are off the chart, which leaves room for the other methods
CROSSING = "×"

Mask = NDArray[np.bool_]  # (columns, methods)


class Reading(NamedTuple):
    t: float  # s
    values: list[float]  # in the order of `letters`; nan where not known


class TimePlot(LineChart):
    """A chart that can be read out by column; its heights are log10 of values if `shown.log`."""

    picture: Picture
    letters: Sequence[str]  # of the methods
    values: Floats  # (columns, methods)

    def __init__(
        self, x_axis: Axis, y_axis: Axis, columns: int, rows: int, *, shown: Shown, times: Floats
    ) -> None:
        super().__init__(x_axis, y_axis, columns, rows)
        self.shown = shown
        self.times = times  # s, at the middle of each column
        self._limit = LARGEST
        if shown.log:
            self._limit = min(math.log10(LARGEST), y_axis.high)

    def at(self, column: int) -> Reading | None:
        """Return the values in a column, or in the last column before it that has any."""
        at = column - self.left
        if not 0 <= at < self.columns:
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
        low = self.x_axis.low
        high = self.x_axis.high
        log_time = self.shown.has_log_time
        share = 0.5
        if column is not None:
            share = min(max((column - self.left + 0.5) / self.columns, 0.0), 1.0)
        length = factor * (high - low)
        begin = low + share * (high - low - length)
        limits = _time_axis(whole, Shown(log_time=log_time), self.columns)
        begin = min(max(begin, limits.low), max(limits.high - length, limits.low))
        end = min(begin + length, limits.high)
        if begin == limits.low and end == limits.high:
            return None
        return (10.0**begin, 10.0**end) if log_time else (begin, end)

    def draw_marks(self, changes: Sequence[tuple[float, str]]) -> None:
        """Draw the changes of the step, labels of the latest first, and the reference line."""
        canvas = self.canvas
        for x, text in reversed(changes):
            value = math.log10(max(x, FLOOR)) if self.shown.has_log_time else x
            if self.x_axis.low < value < self.x_axis.high:
                at = 2 * self.columns * self.x_axis.share(value)
                canvas.line(at, 0, at, canvas.height, FRAME, dotted=True)
                begin = min(int(at) // 2 + 1, canvas.columns - len(text))
                if canvas.is_free(begin, self.rows - 1, len(text)):
                    canvas.label(begin, self.rows - 1, text, QUIET)
        for text, level in _levels(self.shown).items():
            down = canvas.height * min(1 - self.y_axis.share(level), 1.0)
            canvas.line(0, down, 2 * self.columns, down, EXACT, dotted=True)
            row = max(int(down) // 4 - 1, 0)
            canvas.label(1, row, text, EXACT)

    def on_chart(self, low: Floats, high: Floats) -> tuple[Floats, Floats]:
        """Return the values with nan for those after a curve has left the chart."""
        gone = self._beyond(low, high)
        gone[1:] &= gone[:-1].copy()
        gone[:1] = False
        return np.where(gone, np.nan, low), np.where(gone, np.nan, high)

    def _beyond(self, low: Floats, high: Floats) -> Mask:
        return (high > self._limit) | (low < -LARGEST)

    def draw_curves(self, inks: Iterable[int], low: Floats, high: Floats) -> None:
        for ink, lows, highs in zip(inks, low.T, high.T, strict=True):
            x, y = _outline(self.up(lows), self.up(highs))
            down = np.minimum(4 * (self.rows - y), 4 * self.rows - 1)
            self.canvas.path(2 * x + 1.5, down, ink)

    def draw_crossings(self, high: Floats, repeats: float) -> None:
        """Mark where one error passes another for good."""
        row = (self.y_axis.high - self.y_axis.low) / self.rows
        for column, value in _crossings(high / row, self.times, repeats):
            self.canvas.label(column, self.row(value * row), CROSSING, TEXT)

    def ends(
        self, labels: Iterable[tuple[str, str, int]], run: "_Run", low: Floats, high: Floats
    ) -> Iterator[End]:
        """Yield the ends of curves; write the latest value of those that left the chart."""
        beyond = self._beyond(low, high)
        rows = self.rows - np.stack([self.up(high), self.up(low)])
        for place, (letter, name, ink) in enumerate(labels):
            known = np.flatnonzero(~np.isnan(high[:, place]))
            if not len(known):
                continue
            column = int(known[-1]) + 1
            if beyond[known[-1], place]:
                value = max(run.high[-1, place], run.low[-1, place], key=abs)
                self._write_value(column, letter, value, ink)
            else:
                yield End(column, rows[:, :, place], letter, name, ink)

    def _write_value(self, column: int, letter: str, value: float, ink: int) -> None:
        """Write what a curve has come to where it left the chart."""
        rows = range(self.rows)
        arrow = "↑"
        if value < 0 and not self.shown.log:
            rows = rows[::-1]
            arrow = "↓"
        number = f" {value:.0e}".replace("e+", "e") if math.isfinite(value) else ""
        text = f"{arrow}{letter}{number}"
        column = min(column, self.canvas.columns - len(text))
        self.canvas.label_where_blank([(column, row) for row in rows], text, ink)


class _Run(NamedTuple):
    """The quantity of the methods shown, in a run or in its ghost."""

    window: Window
    low: Floats  # (rows, methods)
    high: Floats

    @classmethod
    def of(cls, window: Window, quantity: str, places: Sequence[int]) -> "_Run":
        return cls(window, window.low[quantity][:, places], window.high[quantity][:, places])

    def columns(self, edges: Floats, shown: Shown) -> tuple[Floats, Floats]:
        """Return the lowest and the highest value in each column, (columns, methods).

        On a logarithmic axis both are log10 of the largest magnitude at the column.
        """
        x = self.window.x
        if not shown.log:
            return per_column(x, self.low, self.high, edges)
        hold = self.window.repeats
        if not shown.has_log_time:  # in whole columns, or moving charts would flicker
            column = (edges[-1] - edges[0]) / (len(edges) - 1)
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
    *,
    names: Sequence[str] = (),
    ghost: Window | None = None,
    changes: Sequence[tuple[float, str]] = (),
) -> TimePlot:
    """Chart the quantity that is shown over a stretch, the last seconds, or the whole run.

    A column spans the lowest to the highest value in it.  On a logarithmic axis it shows the
    largest magnitude of the half swing that ends there, so that zeros do not tear the lines.  With
    logarithmic time a power law is straight.  A CROSSING is where one error passes another for
    good.  `names` of the cast stand beside their lines.  A ghost of the same cast lies behind,
    fainter.  `changes` of the step are pairs of x [s] and a label.
    """
    places = shown.places(cast)
    runs = [_Run.of(window, shown.quantity, places)]
    if ghost is not None:
        runs.append(_Run.of(ghost, shown.quantity, places))
    plot, sides = _plot(runs, shown, max(width, MIN_COLUMNS), max(height, MIN_ROWS) - 1)
    low, high = sides[0]
    plot.letters = [cast[place].letter for place in places]
    plot.values = np.where(abs(low) > abs(high), low, high)
    if shown.log:
        plot.values = 10.0**high
    plot.draw_marks(changes)
    colours = [inks(cast)[place] for place in places]
    (low, high), *behind = [plot.on_chart(*side) for side in sides]
    plot.draw_curves(colours, low, high)
    for side in behind:
        plot.draw_curves(map(faint, colours), *side)
    if shown.log:
        plot.draw_crossings(high, window.repeats)
    shown_names = [names[place] if names else "" for place in places]
    labels = zip(plot.letters, shown_names, colours, strict=True)
    plot.name_lines(plot.ends(labels, runs[0], low, high))
    plot.picture = Picture(plot.framed())
    return plot


def _plot(
    runs: Sequence[_Run], shown: Shown, width: int, rows: int
) -> tuple[TimePlot, list[tuple[Floats, Floats]]]:
    """Return the axes, and each run's values in the columns."""
    levels = _levels(shown)
    label_width = 5  # enough for decades
    if not shown.log:
        y_axis = _linear_y_axis(runs, levels, rows)
        label_width = y_axis.label_width
    columns = columns_beside(label_width, width)
    x_axis = _time_axis(runs[0].window, shown, columns)
    moments = np.linspace(x_axis.low, x_axis.high, 2 * columns + 1)
    if shown.has_log_time:
        moments = 10.0**moments
    sides = [run.columns(moments[::2], shown) for run in runs]
    if shown.log:
        y_axis = _log_y_axis(np.hstack([high for _, high in sides]), levels, rows)
    return TimePlot(x_axis, y_axis, columns, rows, shown=shown, times=moments[1::2]), sides


def _levels(shown: Shown) -> dict[str, float]:
    """Return the height of the reference line by its name, if there is one."""
    line = shown.line
    if line is None or line.quantity != shown.quantity:
        return {}
    return {line.name: math.log10(abs(line.value)) if shown.log else line.value}


def _time_axis(window: Window, shown: Shown, columns: int) -> Axis:
    """Return the axis of a stretch, of the last seconds, or of the whole run.

    A logarithmic axis begins at a power of ten, two or three decades before its end.
    """
    begin, end = time_span(window.x, shown.seconds, columns)
    if shown.stretch is not None:
        _, begin, end, _ = shown.stretch
    elif shown.has_log_time:
        begin = max(10.0 ** math.floor(math.log10(end) - 2.3), min(window.repeats, end / 10))
    note = " run" if window.turned else ""
    if shown.has_log_time:
        return log_time_axis(begin, end, columns, note)
    return time_axis(begin, end, columns, note)


def _crossings(heights: Floats, times: Floats, repeats: float) -> list[tuple[int, float]]:
    """Return (column, height) where one curve passes another for good; heights are in rows.

    They are half a row apart before and after, for half a swing and 4 % of the columns, and half
    as far as the clearest pair: chosen by eye on seven scenes.
    """
    shortest = max(0.04 * len(heights), 2)
    begins = times.copy()
    begins[np.flatnonzero(~np.isnan(heights).all(axis=1))[:1]] = 0.0  # half a swing is seen at once
    found: list[tuple[float, int, float]] = []
    for one, other in combinations(heights.T, 2):
        gap = one - other
        apart = np.flatnonzero(abs(gap) >= 0.5)
        turns = np.flatnonzero(np.diff(np.sign(gap[apart]))) + 1
        sides = np.split(apart, turns)
        lasting = [
            side
            for side in sides
            if len(side) >= shortest and times[side[-1]] - begins[side[0]] >= repeats
        ]
        if len(lasting) < 2 or lasting[-1] is not sides[-1]:
            continue
        before, after = lasting[-2:]
        if gap[before[0]] * gap[after[0]] < 0:
            between = gap[before[-1] : after[0] + 1]
            at = int(before[-1] + np.nanargmin(abs(between)))
            width = min(abs(gap[before]).max(), abs(gap[after]).max())
            found.append((width, at, (one[at] + other[at]) / 2))
    clear = 0.5 * max([width for width, *_ in found], default=0.0)
    return [(at, height) for width, at, height in found if width >= clear]


def _log_y_axis(largest: Floats, levels: dict[str, float], rows: int) -> Axis:
    """Return an axis of all errors but the smallest ones at the start.

    A curve that leaves the chart within a tenth of it takes no room from the others.
    """
    limit = math.log10(LARGEST)
    curves = largest[:, ~np.isnan(largest).all(axis=0)]
    stays = (curves <= limit).mean(axis=0) >= 0.1
    if stays.any():
        curves = curves[:, stays]
    known = [each[(each > math.log10(FLOOR)) & (each <= limit)] for each in curves.T]
    known = [each for each in known if len(each)]
    if not known:
        return log_axis(-4, 0, rows)
    top = min(np.nanmax(curves), limit)
    bottom = min(np.sort(each)[len(each) // 40] for each in known)
    return log_axis(bottom, max([top, *levels.values()]), rows)


def _linear_y_axis(runs: Sequence[_Run], levels: dict[str, float], rows: int) -> Axis:
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


def time_span(x: Floats, seconds: float | None, columns: int) -> tuple[float, float]:
    """Return the first and last x; columns keep their moments while the window moves."""
    latest = float(x.max(initial=0.0))
    if seconds is None:
        unit = 10 ** math.floor(math.log10(max(latest, 1.0))) / 10
        return 0.0, max(math.ceil(latest / unit) * unit, 1.0)
    column = seconds / columns
    end = max(math.ceil(latest / column) * column, seconds)
    return end - seconds, end


def per_column(
    x: Floats, low: Floats, high: Floats, edges: Floats, hold: float = 0.0
) -> tuple[Floats, Floats]:
    """Return the lowest `low` and highest `high` in each column, or up to `hold` before it.

    x ascends; a column lies between two edges.  Returns (columns, series); nan where no row is, and
    in columns after the last row.
    """
    lows = np.full((len(edges) - 1, low.shape[1]), np.nan)
    highs = lows.copy()
    # a row on an edge belongs to the column on the right, however the edge is rounded
    slack = 1e-9 * np.diff(edges)
    begins = np.searchsorted(x, edges[:-1] - slack - hold)
    ends = np.searchsorted(x, edges[1:] - slack)
    ends[-1] = np.searchsorted(x, edges[-1], "right")
    begun = np.append(0, ends[:-1]) < len(x)
    filled = np.flatnonzero((ends > begins) & begun)
    if len(filled):
        pairs = np.stack([begins[filled], ends[filled]], axis=1).ravel()
        beyond = np.full((1, low.shape[1]), np.nan)  # an empty row for the end
        lows[filled] = np.fmin.reduceat(np.vstack([low, beyond]), pairs, axis=0)[::2]
        highs[filled] = np.fmax.reduceat(np.vstack([high, beyond]), pairs, axis=0)[::2]
    return lows, highs
