"""Bands: how low and how high a wobbling number goes, over parts of a run, in constant memory.

The energy error of every method wobbles by more within a swing than it moves from swing to swing.
So the stream is cut into bins of a swing or more, and of a bin only its band is kept.  The middle
of a band hardly wobbles, wherever the swing was cut.  When there are 64 bins they merge pairwise.
"""

import copy
import math
from collections.abc import Sequence
from itertools import pairwise
from statistics import median
from typing import NamedTuple, Self

MAX_BINS = 64


class Bin(NamedTuple):
    """A part of a run."""

    step: float  # its middle
    low: float
    high: float

    @property
    def middle(self) -> float:
        return (self.low + self.high) / 2

    @property
    def width(self) -> float:
        return self.high - self.low


class Bands:
    """The bins of one number along a run."""

    def __init__(self, width: int) -> None:
        """`width`: the steps of a bin, at first."""
        self.bins: list[Bin] = []
        self._width = float(width)
        self._cut = 0
        self._low = math.inf  # of the open bin
        self._high = -math.inf

    def copy(self) -> Self:
        """Return other bands that go on from here."""
        other = copy.copy(self)
        other.bins = self.bins.copy()
        return other

    def add(self, step: int, low: float, high: float, now: float) -> bool:
        """Take in the extremes since the last call and the number now; return whether a bin is full."""
        self._low = min(self._low, low)
        self._high = max(self._high, high)
        if step - self._cut < self._width:
            return False
        self.bins.append(Bin((self._cut + step) / 2, self._low, self._high))
        self._cut = step
        self._low = self._high = now
        if len(self.bins) == MAX_BINS:
            pairs = zip(self.bins[::2], self.bins[1::2], strict=True)
            self.bins = [
                Bin((a.step + b.step) / 2, min(a.low, b.low), max(a.high, b.high)) for a, b in pairs
            ]
            self._width = 2 * step / MAX_BINS
        return True

    def recent(self, share: float) -> list[Bin]:
        """Return the last part of the bins."""
        return self.bins[-max(1, int(len(self.bins) * share)) :]


class Line(NamedTuple):
    """A least-squares line."""

    slope: float
    uncertainty: float  # standard deviation of the slope
    sigmas: float  # how significant the slope is


def line(bins: Sequence[Bin]) -> Line:
    """Fit a line through the middles of three bins or more."""
    return fit([each.step for each in bins], [each.middle for each in bins])


def fit(times: Sequence[float], values: Sequence[float]) -> Line:
    """Fit a line through three values or more.

    A residual is taken to be correlated with the next one, which leaves n (1 - r)/(1 + r) of n
    values that count: Santer et al., J. Geophys. Res. 105 (2000) 7337.
    """
    n = len(times)
    mean_time = sum(times) / n
    mean = sum(values) / n
    offsets = [time - mean_time for time in times]
    square = sum(offset * offset for offset in offsets)
    placed = [*zip(offsets, values, strict=True)]
    slope = sum(offset * (value - mean) for offset, value in placed) / square
    residuals = [value - mean - slope * offset for offset, value in placed]
    total = sum(residual * residual for residual in residuals)
    if total == 0:
        return Line(slope, 0.0, math.inf if slope else 0.0)
    correlation = sum(a * b for a, b in pairwise(residuals)) / total
    # a poor estimate: neither shrink the result nor blow it up
    correlation = min(max(correlation, 0.0), 0.9)
    uncertainty = math.sqrt(total / (n - 2) / square * (1 + correlation) / (1 - correlation))
    return Line(slope, uncertainty, sigmas(slope / uncertainty, n - 2))


def sigmas(ratio: float, freedom: int) -> float:
    """Convert a value of Student's t to standard deviations of the normal distribution, to 2 %.

    Wallace, Ann. Math. Statist. 30 (1959) 1121.
    """
    if not math.isfinite(ratio):
        return 0.0
    tail = math.sqrt(freedom * math.log1p(ratio * ratio / freedom))
    return (8 * freedom + 1) / (8 * freedom + 3) * tail


def typical_width(bins: Sequence[Bin]) -> float:
    """Return the width of a typical bin's band."""
    return median(each.width for each in bins)


def hull(bins: Sequence[Bin]) -> tuple[float, float]:
    """Return the lowest and the highest of some bins."""
    return min(each.low for each in bins), max(each.high for each in bins)


def one_way(bins: Sequence[Bin]) -> float:
    """Return the share of moves from bin to bin that go the commoner way: 0.5 to 1."""
    moves = [b.middle - a.middle for a, b in pairwise(bins)]
    rising = sum((move > 0) + (move == 0) / 2 for move in moves) / len(moves)
    return max(rising, 1 - rising)
