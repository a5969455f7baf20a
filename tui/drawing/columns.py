"""Many rows of numbers -> few columns of characters, without losing an extreme."""

import math

import numpy as np

from tui.drawing.axes import Floats


def per_column(x: Floats, low: Floats, high: Floats, start: float, end: float, columns: int) -> tuple[Floats, Floats]:
    """Lowest `low` and highest `high` (n, series) of the rows in each of `columns` parts of [start, end].

    x ascends.  Returns (columns, series); nan where no row falls into a column.
    """
    lows, highs = np.full((columns, low.shape[1]), np.nan), np.full((columns, low.shape[1]), np.nan)
    # A row on an edge belongs to the right, even if the edge comes out a little late when the window has moved on.
    edges = np.searchsorted(x, np.linspace(start, end, columns + 1) - 1e-9 * (end - start) / columns)
    edges[-1] = np.searchsorted(x, end, "right")
    filled = np.flatnonzero(edges[1:] > edges[:-1])
    if len(filled):
        last = edges[-1]
        lows[filled] = np.fmin.reduceat(low[:last], edges[filled], axis=0)
        highs[filled] = np.fmax.reduceat(high[:last], edges[filled], axis=0)
    return lows, highs


def held(x: Floats, values: Floats, start: float, end: float, columns: int, hold: float) -> Floats:
    """Largest value of the last `hold` seconds at each column up to the last x, (columns, series)."""
    column = (end - start) / columns
    back = min(math.ceil(hold / column), columns)
    _, highs = per_column(x, values, values, start - back * column, end, back + columns)
    largest: Floats = np.fmax.reduce([highs[offset : offset + columns] for offset in range(back + 1)])
    begun = math.ceil((x[-1] - start) / column) if len(x) else 0
    largest[max(begun, 1) :] = np.nan
    return largest


def span(x: Floats, seconds: float | None, columns: int) -> tuple[float, float]:
    """First and last x of the chart.  Columns keep their place in time while the window moves on."""
    latest = float(x[-1]) if len(x) else 0.0
    if seconds is None:
        unit = 10 ** math.floor(math.log10(max(latest, 1.0))) / 10
        return 0.0, max(math.ceil(latest / unit) * unit, 1.0)
    column = seconds / columns
    end = max(math.ceil(latest / column) * column, seconds)
    return end - seconds, end
