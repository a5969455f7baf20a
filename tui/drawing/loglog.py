"""Series of points, and two logarithmic axes that fit them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from tui.drawing.axes import Axis, Floats, log_axis, log_x_axis

ROOM = 4  # columns for the letters at the right end


@dataclass(frozen=True, slots=True)
class Series:
    """Points with marks, joined by lines; or a dotted reference line with its mark at the end."""

    ink: int
    mark: str  # a letter; a few for a reference
    x: Floats | Sequence[float]  # (n,)
    y: Floats | Sequence[float]  # (n,); in what is plotted, x and y are in characters from the lower left corner
    dotted: bool = False


@dataclass(frozen=True, slots=True)
class LogLog:
    """Two logarithmic axes in a picture that has a line of words above and one below."""

    x_axis: Axis
    y_axis: Axis
    columns: int
    rows: int
    left: int  # of the first column

    @classmethod
    def fitting(cls, series: Sequence[Series], width: int, height: int) -> Self:
        """Axes that fit all points with marks, in a picture of this many columns and rows."""
        rows = height - 4
        marked = [some for one in series if not one.dotted and len(some := logs(one))]
        corners = np.concatenate(marked or [np.array([(0.0, -4.0), (1.0, 0.0)])])
        (left, bottom), (right, top) = corners.min(axis=0), corners.max(axis=0)
        y_axis = log_axis(bottom, top, rows)
        columns = width - 1 - ROOM - y_axis.label_width
        return cls(log_x_axis(left, right, columns), y_axis, columns, rows, width - columns - ROOM)

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """Column and row of the picture in which a point on the axes lies."""
        column, row = (float(axis.share(math.log10(value))) for axis, value in ((self.x_axis, x), (self.y_axis, y)))
        return self.left + int(self.columns * column), 1 + row_at(self.rows * row, self.rows)


def logs(series: Series) -> Floats:
    """log10 of the finite positive points, (n, 2), sorted by x."""
    points = np.stack([np.asarray(series.x, np.float64), np.asarray(series.y, np.float64)], axis=1)
    points = points[(np.isfinite(points) & (points > 0)).all(axis=1)]
    return np.log10(points[np.argsort(points[:, 0], kind="stable")])


def row_at(height: float, rows: int) -> int:
    """The row of characters, from the top, at a height above the lower edge."""
    return min(max(rows - 1 - int(height), 0), rows - 1)
