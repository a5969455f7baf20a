"""The bands of an oscillating number: its extremes over the bins of a run, in constant memory.

The energy error of every method oscillates by more within a swing than it moves from swing to
swing.  So a run is cut into bins of a swing or more, and only the lowest and highest value of each
bin is kept.  The middle of such a band hardly oscillates, wherever in a swing the bin began.  When
there are 64 bins, they merge pairwise.
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from statistics import median
from typing import NamedTuple

MAX_BINS = 64


class Bin(NamedTuple):
    """The band of one part of a run."""

    step: float  # the middle of the part
    low: float
    high: float

    @property
    def middle(self) -> float:
        return (self.low + self.high) / 2


class Bands:
    """The bins of one number along a run, at first of `width` steps each.

    `bins` is replaced and never changed in place, so `copy.copy` makes an independent copy.
    """

    def __init__(self, width: float) -> None:
        self.bins: list[Bin] = []
        self._width = width
        self._begin = 0  # the first step of the open bin
        self._low = math.inf  # of the open bin
        self._high = -math.inf

    def add(self, step: int, low: float, high: float, now: float) -> bool:
        """Add the extremes since the last call and the number now; return whether a bin is full."""
        self._low = min(self._low, low)
        self._high = max(self._high, high)
        if step - self._begin < self._width:
            return False
        self.bins = [*self.bins, Bin((self._begin + step) / 2, self._low, self._high)]
        self._begin = step
        self._low = self._high = now
        if len(self.bins) == MAX_BINS:
            pairs = zip(self.bins[::2], self.bins[1::2], strict=True)
            self.bins = [Bin((a.step + b.step) / 2, *hull((a, b))) for a, b in pairs]
            self._width = 2 * step / MAX_BINS
        return True

    def recent(self, share: float) -> list[Bin]:
        """Return the last part of the bins, at least one."""
        return self.bins[-max(1, int(len(self.bins) * share)) :]


class Line(NamedTuple):
    """A least-squares line."""

    slope: float
    uncertainty: float  # standard deviation of the slope
    sigmas: float  # |slope| in standard deviations of a normal distribution


def fit_line(bins: Sequence[Bin]) -> Line:
    """Fit a line through the middles of three bins or more.

    Each residual is taken to be correlated with the next one by r, so that only n (1 - r)/(1 + r)
    of n residuals are independent: Santer et al., J. Geophys. Res. 105 (2000) 7337.  The ratio of
    slope and uncertainty follows Student's t; Wallace, Ann. Math. Statist. 30 (1959) 1121, converts
    it to standard deviations, to 2 %.
    """
    n = len(bins)
    mean_step = sum(each.step for each in bins) / n
    mean = sum(each.middle for each in bins) / n
    points = [(each.step - mean_step, each.middle) for each in bins]
    offsets_squared = sum(offset * offset for offset, _ in points)
    slope = sum(offset * (middle - mean) for offset, middle in points) / offsets_squared
    residuals = [middle - mean - slope * offset for offset, middle in points]
    residuals_squared = sum(residual * residual for residual in residuals)
    if residuals_squared == 0:
        return Line(slope, 0.0, math.inf if slope else 0.0)
    correlation = sum(a * b for a, b in pairwise(residuals)) / residuals_squared
    # few residuals estimate it poorly: never shrink the uncertainty, nor enlarge it without limit
    correlation = min(max(correlation, 0.0), 0.9)
    freedom = n - 2
    variance = residuals_squared / freedom / offsets_squared
    uncertainty = math.sqrt(variance * (1 + correlation) / (1 - correlation))
    t = slope / uncertainty
    if not math.isfinite(t):
        return Line(slope, uncertainty, 0.0)
    sigmas = math.sqrt(freedom * math.log1p(t * t / freedom))
    return Line(slope, uncertainty, (8 * freedom + 1) / (8 * freedom + 3) * sigmas)


def typical_width(bins: Sequence[Bin]) -> float:
    """Return the median width of the bands."""
    return median(each.high - each.low for each in bins)


def hull(bins: Sequence[Bin]) -> tuple[float, float]:
    """Return the lowest and the highest value of some bins."""
    return min(each.low for each in bins), max(each.high for each in bins)


def one_way_share(bins: Sequence[Bin]) -> float:
    """Return the share of moves from bin to bin that go the more common way: 0.5 to 1."""
    rising = sum(a.middle < b.middle for a, b in pairwise(bins))
    falling = sum(a.middle > b.middle for a, b in pairwise(bins))
    return 0.5 + abs(rising - falling) / (len(bins) - 1) / 2
