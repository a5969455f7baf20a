"""Verdict: does a method's energy error stay in a band, or does it leave?  From a stream, in constant memory.

Within a swing the energy error of every method wobbles by more than it moves from swing to swing.  So
the stream is cut into bins of a swing or more, and of a bin only its band is kept: lowest, highest.  The
middle of a band hardly wobbles, whatever the phase at which the bin was cut.  When there are 64 bins
they merge pairwise.

- `grows` and `drifts`: the energy error no longer comes back to its value at the start.  The band of the
  last quarter of the bins misses it by half its own width; or by a sixteenth, if that is more than the
  whole energy of the start.  A bounded motion comes back to where it began, so this is final for as long
  as the Trend lives.  Where rounding alone could have carried the error there, it must also have gone
  steadily.
- `bounded`: it does come back, and a line through the middles of the bands, with three times its
  uncertainty, would take more than 500 periods to move by half the band's width.  RK4, the one method
  that drifts slowly, takes 1 to 50 in libration and moderate rotation, and 360 at 100 rad/s and h·w0 = 0.003.
- `too early`: neither, yet.

A rotation of fewer than three steps a turn beats with its steps, and a bounded energy error may stay away from
its start for hundreds of turns.  There only an error beyond the whole energy of the start is final.

Diffusion in a chaotic sea, far above the limits of the symplectic methods, reads `grows`.
tests/bench/verdict.py compares with long runs.
"""

import math
from dataclasses import dataclass
from itertools import pairwise
from statistics import fmean, median, stdev
from typing import Literal, NamedTuple

from engine.run.lockstep import Reading

Verdict = Literal["too early", "bounded", "drifts", "grows"]

_BINS = 64
_LEAST_BINS = 4
_LEAST_SAMPLES = 16  # in a bin: beyond h·w0 = 0.4 a swing has fewer steps, and they show its band badly
_LEAST_PERIODS = 8  # for `bounded`
_LEAST_STEPS = 3  # in a turn, for a final verdict on less than the whole energy
_HORIZON = 500  # periods
_ROUNDING = 1e-12  # relative energy error: a narrower band is made of rounding
_WANDER = 1e-9  # as far as rounding was seen to carry an energy error, in rotation where theta grows


@dataclass(frozen=True, slots=True)
class Judgement:
    """What is known of an energy error so far; no slope before there are four bins."""

    verdict: Verdict = "too early"
    slope: float | None = None  # mean change of the relative energy error [1/s]
    uncertainty: float | None = None  # standard deviation of the slope [1/s]
    periods: float = 0.0  # how many periods this rests on


class _Bin(NamedTuple):
    time: float  # s since the start, its middle
    low: float
    high: float


class Trend:
    """One method's energy error over time.  Another h or another start needs another Trend."""

    def __init__(self, period: float) -> None:
        """`period` [s] is that of the exact motion, or 2 pi/w0 where that has none."""
        self._period = self._width = period
        self._bins: list[_Bin] = []
        self.judgement = Judgement()  # what is known by now
        self._start = self._first = math.nan  # s, and the energy error there
        self._cut = 0.0  # s since the start; where the open bin begins
        self._low, self._high = math.inf, -math.inf
        self._samples = -1  # in the open bin; the first one of all only begins it
        self._beats = False

    def add(self, t: float, energy_error: float, low: float | None = None, high: float | None = None) -> None:
        """Take in the relative energy error at time t [s], and its extremes since the previous call.

        Without the extremes the calls must be closer than a quarter of a period, or the wobble seen
        through the gaps can look like a trend.
        """
        if self._samples < 0:  # the extremes before the start are not of this trend
            self._start, self._first = t, energy_error
            low = high = energy_error
        lowest, highest = energy_error if low is None else low, energy_error if high is None else high
        if lowest < self._low:
            self._low = lowest
        if highest > self._high:
            self._high = highest
        self._samples += 1
        if self._samples >= _LEAST_SAMPLES and abs(t - self._start) - self._cut >= self._width:
            self._close(abs(t - self._start))
            self._low = self._high = energy_error

    def read(self, t: float, reading: Reading, steps_per_turn: float = math.inf) -> None:
        """Take in a method's reading at time t [s]; a method that has diverged grows.

        `steps_per_turn` is for rotation.
        """
        self._beats = steps_per_turn < _LEAST_STEPS
        self.add(t, reading.energy_error, reading.energy_error_low, reading.energy_error_high)
        if reading.diverged_at is not None:
            self.judgement = Judgement("grows", None, None, abs(t - self._start) / self._period)

    def _close(self, now: float) -> None:
        self._bins.append(_Bin((self._cut + now) / 2, self._low, self._high))
        self._cut, self._samples = now, 0
        if len(self._bins) == _BINS:
            pairs = zip(self._bins[::2], self._bins[1::2], strict=True)
            self._bins = [_Bin((a.time + b.time) / 2, min(a.low, b.low), max(a.high, b.high)) for a, b in pairs]
            self._width = 2 * now / _BINS
        if len(self._bins) >= _LEAST_BINS:
            self._judge()

    def _judge(self) -> None:
        slope, uncertainty = _line(
            [bin_.time for bin_ in self._bins], [(low + high) / 2 for _, low, high in self._bins]
        )
        periods = self._cut / self._period
        verdict = self.judgement.verdict
        if verdict in ("too early", "bounded"):
            width = max(median(high - low for _, low, high in self._bins), _ROUNDING)
            reach = (abs(slope) + 3 * uncertainty) * self._cut
            if left := self._left():
                verdict = left
            elif periods >= _LEAST_PERIODS and reach < width / 2 * min(1, periods / _HORIZON):
                verdict = "bounded"
        finite = math.isfinite(slope) and math.isfinite(uncertainty)
        self.judgement = Judgement(verdict, slope if finite else None, uncertainty if finite else None, periods)

    def _left(self) -> Verdict | None:
        """Where to the last quarter has left the start for good, if it has."""
        recent = self._bins[-(len(self._bins) // 4) :]
        low, high = min(bin_.low for bin_ in recent), max(bin_.high for bin_ in recent)
        gap, width = max(low - self._first, self._first - high), max(high - low, _ROUNDING)
        if gap < (width / 16 if gap > 1 else width / 2) or (gap < _WANDER and not self._steady()):
            return None
        if self._beats and gap <= 1:
            return None
        return "grows" if low > self._first else "drifts"

    def _steady(self) -> bool:
        """Whether the steps from bin to bin agree, five times better than those of a random walk."""
        steps = [(b.low + b.high - a.low - a.high) / 2 for a, b in pairwise(self._bins)]
        return abs(fmean(steps)) * math.sqrt(len(steps)) > 5 * stdev(steps)


def _line(times: list[float], values: list[float]) -> tuple[float, float]:
    """Slope of the least-squares line and its standard deviation.

    A residual is taken to be correlated with the next one, which leaves n (1 - r)/(1 + r) of n values that
    count: Santer et al., J. Geophys. Res. 105 (2000) 7337.
    """
    n = len(times)
    mean_time, mean_value = sum(times) / n, sum(values) / n
    spread = sum((time - mean_time) ** 2 for time in times)
    slope = sum((time - mean_time) * (value - mean_value) for time, value in zip(times, values, strict=True)) / spread
    residuals = [value - mean_value - slope * (time - mean_time) for time, value in zip(times, values, strict=True)]
    total = sum(residual * residual for residual in residuals)
    if total == 0:
        return slope, 0.0
    correlation = sum(a * b for a, b in pairwise(residuals)) / total
    correlation = min(max(correlation, 0.0), 0.9)  # the estimate is poor: neither shrink the result nor blow it up
    return slope, math.sqrt(total / (n - 2) / spread * (1 + correlation) / (1 - correlation))
