"""Bands: how low and how high a wobbling number goes, over parts of a run, in constant memory.

The energy error of every method wobbles by more within a swing than it moves from swing to swing.
So the stream is cut into bins of a swing or more, and of a bin only its band is kept.  The middle
of a band hardly wobbles, wherever the swing was cut.  When there are 64 bins they merge pairwise.
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from statistics import median
from typing import NamedTuple

MAX_BINS = 64


class Bin(NamedTuple):
    """A part of a run."""

    step: float  # its middle
    low: float
    high: float

    @property
    def middle(self) -> float:
        return (self.low + self.high) / 2


class Bands:
    """The bins of one number along a run, at first of `width` steps; `copy.copy` copies it."""

    def __init__(self, width: float) -> None:
        self.bins: list[Bin] = []
        self._width = width
        self._cut = 0
        self._low = math.inf  # of the open bin
        self._high = -math.inf

    def add(self, step: int, low: float, high: float, now: float) -> bool:
        """Add the extremes since the last call and the number now; return whether a bin is full."""
        self._low = min(self._low, low)
        self._high = max(self._high, high)
        if step - self._cut < self._width:
            return False
        self.bins = [*self.bins, Bin((self._cut + step) / 2, self._low, self._high)]
        self._cut = step
        self._low = self._high = now
        if len(self.bins) == MAX_BINS:
            pairs = zip(self.bins[::2], self.bins[1::2], strict=True)
            self.bins = [Bin((a.step + b.step) / 2, *hull((a, b))) for a, b in pairs]
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
    """Fit a line through the middles of three bins or more.

    A residual is taken to be correlated with the next one, which leaves n (1 - r)/(1 + r) of n
    values that count: Santer et al., J. Geophys. Res. 105 (2000) 7337.  Student's t becomes
    standard deviations by Wallace, Ann. Math. Statist. 30 (1959) 1121, to 2 %.
    """
    n = len(bins)
    mean_step = sum(each.step for each in bins) / n
    mean = sum(each.middle for each in bins) / n
    placed = [(each.step - mean_step, each.middle) for each in bins]
    square = sum(offset * offset for offset, _ in placed)
    slope = sum(offset * (middle - mean) for offset, middle in placed) / square
    residuals = [middle - mean - slope * offset for offset, middle in placed]
    total = sum(residual * residual for residual in residuals)
    if total == 0:
        return Line(slope, 0.0, math.inf if slope else 0.0)
    correlation = sum(a * b for a, b in pairwise(residuals)) / total
    # a poor estimate: neither shrink the result nor blow it up
    correlation = min(max(correlation, 0.0), 0.9)
    freedom = n - 2
    uncertainty = math.sqrt(total / freedom / square * (1 + correlation) / (1 - correlation))
    ratio = slope / uncertainty
    if not math.isfinite(ratio):
        return Line(slope, uncertainty, 0.0)
    tail = math.sqrt(freedom * math.log1p(ratio * ratio / freedom))
    return Line(slope, uncertainty, (8 * freedom + 1) / (8 * freedom + 3) * tail)


def typical_width(bins: Sequence[Bin]) -> float:
    """Return the width of a typical bin's band."""
    return median(each.high - each.low for each in bins)


def hull(bins: Sequence[Bin]) -> tuple[float, float]:
    """Return the lowest and the highest of some bins."""
    return min(each.low for each in bins), max(each.high for each in bins)


def one_way(bins: Sequence[Bin]) -> float:
    """Return the share of moves from bin to bin that go the commoner way: 0.5 to 1."""
    rising = sum(a.middle < b.middle for a, b in pairwise(bins))
    falling = sum(a.middle > b.middle for a, b in pairwise(bins))
    return 0.5 + abs(rising - falling) / (len(bins) - 1) / 2
