"""Bands: how low and how high a wobbling number goes, over stretches of a run.  From a stream, in constant memory.

Within a swing the energy error of every method wobbles by more than it moves from swing to swing.  So the
stream is cut into bins of a swing or more, and of a bin only its band is kept: lowest, highest.  The middle
of a band hardly wobbles, wherever the swing was cut.  When there are 64 bins they merge pairwise.
"""

import math
from itertools import pairwise
from statistics import fmean, median, stdev
from typing import NamedTuple

MOST_BINS = 64
FLOOR = 1e-12  # relative energy error: a narrower band is made of rounding


class Bin(NamedTuple):
    """A stretch of a run."""

    step: float  # its middle
    low: float
    high: float

    @property
    def middle(self) -> float:
        return (self.low + self.high) / 2


class Bands:
    """The bins of one number along a run."""

    def __init__(self, width: int) -> None:
        """`width`: the steps of a bin, at first."""
        self.bins: list[Bin] = []
        self.low, self.high = math.inf, -math.inf  # of the whole run
        self._width, self._cut = float(width), 0
        self._low, self._high = math.inf, -math.inf  # of the open bin

    def add(self, step: int, low: float, high: float, now: float) -> bool:
        """Take in the extremes since the previous call and the number at this step; whether a bin is full."""
        self._low, self._high = min(self._low, low), max(self._high, high)
        self.low, self.high = min(self.low, low), max(self.high, high)
        if step - self._cut < self._width:
            return False
        self.bins.append(Bin((self._cut + step) / 2, self._low, self._high))
        self._cut, self._low, self._high = step, now, now
        if len(self.bins) == MOST_BINS:
            pairs = zip(self.bins[::2], self.bins[1::2], strict=True)
            self.bins = [Bin((a.step + b.step) / 2, min(a.low, b.low), max(a.high, b.high)) for a, b in pairs]
            self._width = 2 * step / MOST_BINS
        return True

    @property
    def width(self) -> float:
        """How wide a band is, as a rule."""
        return max(median(bin_.high - bin_.low for bin_ in self.bins), FLOOR)

    def recent(self, share: float) -> list[Bin]:
        """The last part of the bins."""
        return self.bins[-max(1, int(len(self.bins) * share)) :]

    def line(self, bins: list[Bin] | None = None) -> tuple[float, float]:
        """Slope per step of the least-squares line through the middles of all bins, or these; its standard deviation.

        A residual is taken to be correlated with the next one, which leaves n (1 - r)/(1 + r) of n values that
        count: Santer et al., J. Geophys. Res. 105 (2000) 7337.
        """
        bins = bins or self.bins
        n, steps, values = len(bins), [bin_.step for bin_ in bins], [bin_.middle for bin_ in bins]
        mean_step, mean = sum(steps) / n, sum(values) / n
        spread = sum((step - mean_step) ** 2 for step in steps)
        slope = sum((step - mean_step) * (value - mean) for step, value in zip(steps, values, strict=True)) / spread
        residuals = [value - mean - slope * (step - mean_step) for step, value in zip(steps, values, strict=True)]
        total = sum(residual * residual for residual in residuals)
        if total == 0:
            return slope, 0.0
        correlation = sum(a * b for a, b in pairwise(residuals)) / total
        correlation = min(max(correlation, 0.0), 0.9)  # a poor estimate: neither shrink the result nor blow it up
        return slope, math.sqrt(total / (n - 2) / spread * (1 + correlation) / (1 - correlation))


def hull(bins: list[Bin]) -> tuple[float, float]:
    """The lowest and the highest of some bins."""
    return min(bin_.low for bin_ in bins), max(bin_.high for bin_ in bins)


def rising(bins: list[Bin]) -> float:
    """Of the moves from bin to bin, the share upwards; 0.5 for a random walk, 1 or 0 for steady growth or loss."""
    moves = [b.middle - a.middle for a, b in pairwise(bins)]
    return sum((move > 0) + (move == 0) / 2 for move in moves) / len(moves)


def steady(bins: list[Bin]) -> bool:
    """Whether the moves from bin to bin agree, five times better than those of a random walk."""
    moves = [b.middle - a.middle for a, b in pairwise(bins)]
    if len(moves) < 2 or not all(map(math.isfinite, moves)):
        return False
    return abs(fmean(moves)) * math.sqrt(len(moves)) > 5 * stdev(moves)


def sigmas(ratio: float, freedom: int) -> float:
    """Convert a value of Student's t to standard deviations of the normal distribution, to 2 %.

    Wallace, Ann. Math. Statist. 30 (1959) 1121.
    """
    if not math.isfinite(ratio):
        return math.inf
    tail = math.sqrt(freedom * math.log1p(ratio * ratio / freedom))
    return (8 * freedom + 1) / (8 * freedom + 3) * tail
