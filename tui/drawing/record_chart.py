"""A chart of the energies of a record over time, with their trend and their band."""

import numpy as np

from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.frame import (
    ROOM,
    Axis,
    Floats,
    Frame,
    columns_beside,
    linear_axis,
    number_ticks,
    too_small,
)
from pendu_tui.tui.drawing.loglog import MIN_COLUMNS, MIN_ROWS, plotted
from pendu_tui.tui.drawing.picture import QUIET, TEXT, Picture

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
    width, height = size
    if width < MIN_COLUMNS or height < MIN_ROWS:
        return too_small(width, height, MIN_COLUMNS, MIN_ROWS)
    trend = errors.mean() + (slope or 0.0) * (times[[0, -1]] - times.mean())
    edges = [trend + sigmas * (deviation or 0.0) for sigmas in (-2, 2)]
    span = np.concatenate([errors, *edges])
    y_axis = linear_axis(float(span.min()), float(span.max()), height - 4)
    first = float(times[0])
    last = float(times[-1])
    columns = columns_beside(y_axis.label_width, width)
    labels = dict(number_ticks(first, last, max(columns // 12, 1)))
    labels[max(labels)] += f" {unit}".rstrip()
    frame = Frame(Canvas(width, height), Axis(first, last, labels), y_axis, margin=1)
    frame.draw_axes()
    frame.canvas.label(0, 0, title[:width], TEXT)
    across = np.linspace(first, last, columns)
    dotted = [(QUIET, np.linspace(edge[0], edge[1], columns)) for edge in edges]
    if slope is not None:
        dotted.append((TREND, np.linspace(trend[0], trend[1], columns)))
    for ink, x, y, is_dotted in (
        (ENERGY, *_spans(times, errors, DOTS * columns), False),
        *((ink, across, values, True) for ink, values in dotted),
    ):
        curve = (frame.right(x).tolist(), frame.up(y).tolist(), is_dotted)
        rows = plotted([curve], frame.columns + ROOM, frame.rows)
        frame.canvas.braille(frame.left, frame.margin, rows, ink)
    return frame.canvas.picture()


def _spans(times: Floats, errors: Floats, count: int) -> tuple[Floats, Floats]:
    """Return the points, or the lowest and the highest of each of `count` parts, in turn."""
    if len(times) <= DOTS * count:
        return times, errors
    first = np.arange(count) * len(times) // count
    low = np.minimum.reduceat(errors, first)
    high = np.maximum.reduceat(errors, first)
    return np.repeat(times[first], 2), np.stack([low, high], axis=1).ravel()
