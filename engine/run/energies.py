"""Energies alone: a verdict on any program, from times and energies, with no model and no known period.

The record is cut into up to 64 blocks of equal time.  A block's mean hardly shows the wobble within it, and blocks
without samples are left out, so sampling may be uneven.  A straight line through the means gives the trend, with
an uncertainty that takes correlation into account: by the residuals' own (Bands.line), and by longer blocks, of
which the largest uncertainty counts: Flyvbjerg & Petersen, J. Chem. Phys. 91 (1989) 461.

- `grows`, `loses`: the means move steadily one way; or the line's slope is significant and what is left is noise; or
  the last quarter runs away from all before it; or the energies end in nan or inf, which is `grows`.
- `bounded`: noise or a wobble, whose slope and three times its uncertainty move it by less than half its band; or a
  slow wobble seen at least four times, in early and late thirds alike.
- `caught`: the energy has left its start, and the second half is noise about one level.
- `wanders`: the means do what a random walk does; or the wobble gets wider.
- `too early`: none of these, yet.
"""

import math
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.run.bands import FLOOR, MOST_BINS, Bands, Bin, steady
from engine.run.verdict import Verdict

LEAST_SAMPLES = 64
LEAST_BLOCKS = 10
SAMPLES_PER_BLOCK = 4
CUTS = (1.0, 0.85, 0.7)  # of the most blocks: a wobble that beats with one of them does not beat with all
ALIKE = 0.5  # correlation of a residual with the next one: below, what is left is noise
ROUGH = 1.65  # exponent of how far means part at lag 1 and 2: 1.3 for a random walk, 2 for a smooth curve
WALK = 0.4  # the same exponent at long lags: 0 for noise, 1 for a random walk
FAR = 3.0  # times the width of a block's band: how far a random walk goes, at least
CYCLES = 4  # of a slow wobble, to call it bounded
AHEAD = 10.0  # the forecast is for so many times the record


@dataclass(frozen=True, slots=True)
class Forecast:
    """Where the energy error will be if the trend stays: three uncertainties to either side."""

    time: float  # of the record's own unit
    low: float  # relative energy error
    high: float


@dataclass(frozen=True, slots=True)
class Finding:
    """The verdict on a record of energies."""

    verdict: Verdict
    slope: float | None  # mean change of the relative energy error per unit of time; None if too early for one
    uncertainty: float | None  # standard deviation of the slope
    max_error: float  # largest relative energy error
    last_error: float  # signed
    forecast: Forecast | None  # only for a trend that is a line


@dataclass(frozen=True, slots=True)
class _Blocks:
    """Blocks of equal time that have samples: mean times, and means, lowest and highest of the errors."""

    times: Any  # arrays of float, one value a block
    means: Any
    lows: Any
    highs: Any

    def __len__(self) -> int:
        return len(self.means)

    def part(self, which: slice) -> "_Blocks":
        return _Blocks(self.times[which], self.means[which], self.lows[which], self.highs[which])


def judge(times: Any, energies: Any, scale: float | None = None, diverged: bool = False) -> Finding:
    """Judge energies at times: arrays of one length, finite, not empty; times increase and are below 1e300.

    Errors are relative to `scale`, or to the first energy, which is the start's.  `diverged`: nan or inf came after
    the last of them.  Raises ValueError if the first energy is zero and there is no scale.
    """
    scale = abs(float(energies[0])) if scale is None else scale
    if not 0 < scale < math.inf:
        raise ValueError("the first energy is zero, and errors are relative to it")
    with np.errstate(over="ignore"):
        errors = np.clip((energies - energies[0]) / scale, -1e300, 1e300)
    largest, last = float(np.abs(errors).max()), float(errors[-1])
    unit = max(largest, 1e-300)  # squares of errors must not overflow
    start, span = float(times[0]), float(times[-1] - times[0])
    most = min(MOST_BINS, len(times) // SAMPLES_PER_BLOCK)
    cuts = []
    if len(times) >= LEAST_SAMPLES:
        cuts = [_blocks((times - start) / span, errors / unit, round(share * most)) for share in CUTS]
    if not cuts or min(map(len, cuts)) < LEAST_BLOCKS:
        return Finding("grows" if diverged else "too early", None, None, largest, last, None)
    votes = Counter(_verdict(cut, FLOOR / unit) for cut in cuts)
    (verdict, straight), count = votes.most_common(1)[0]
    if diverged or count == 1:
        verdict, straight = "grows" if diverged else "too early", False
    slope, uncertainty = _line(cuts[0])
    forecast = None
    if straight:
        level = float(np.mean(cuts[0].means)) + slope * (AHEAD - float(np.mean(cuts[0].times)))
        reach = 3 * uncertainty * AHEAD + float(np.max(cuts[0].highs - cuts[0].lows)) / 2
        forecast = Forecast(start + AHEAD * span, (level - reach) * unit, (level + reach) * unit)
    slope, uncertainty = slope / span * unit, uncertainty / span * unit
    finite = math.isfinite(slope + uncertainty)
    return Finding(verdict, slope if finite else None, uncertainty if finite else None, largest, last, forecast)


def _blocks(times: Any, errors: Any, count: int) -> _Blocks:
    """The blocks of samples at times from 0 to 1."""
    places = np.minimum((times * count).astype(np.int64), count - 1)
    firsts = np.flatnonzero(np.diff(places, prepend=-1))
    sizes = np.diff(firsts, append=len(places))
    means = np.add.reduceat(errors, firsts) / sizes
    middles = np.add.reduceat(times, firsts) / sizes
    return _Blocks(middles, means, np.minimum.reduceat(errors, firsts), np.maximum.reduceat(errors, firsts))


def _line(blocks: _Blocks) -> tuple[float, float]:
    """Slope of the line through the means, and the largest uncertainty that blocks of any length give it."""
    slope, uncertainty = 0.0, 0.0
    times, means = blocks.times, blocks.means
    while len(means) >= LEAST_BLOCKS:
        bands = Bands(1)
        bands.bins = [Bin(time, mean, mean) for time, mean in zip(times.tolist(), means.tolist(), strict=True)]
        found, deviation = bands.line()
        slope = slope if uncertainty else found
        uncertainty = max(uncertainty, deviation)
        even = len(means) // 2 * 2
        times, means = times[:even].reshape(-1, 2).mean(axis=1), means[:even].reshape(-1, 2).mean(axis=1)
    return slope, uncertainty


def _verdict(blocks: _Blocks, floor: float) -> tuple[Verdict, bool]:
    """The verdict that one way to cut the record gives, and whether a line describes the trend."""
    slope, uncertainty = _line(blocks)
    if (width := _width(blocks)) <= floor:
        return "bounded", True
    towards: Verdict = "grows" if slope > 0 else "loses"
    if _runs_away(blocks):
        return ("grows" if blocks.means[-1] > blocks.means[0] else "loses"), False
    if _is_steady(blocks):
        return towards, _correlation(blocks) < ALIKE
    if _correlation(blocks) < ALIKE:
        if _gets_wider(blocks):
            return "wanders", False
        if _gap(blocks.part(slice(len(blocks) // 4, None))) > 1:  # before the first block was over
            return "caught", False
        if abs(slope) > (3 + MOST_BINS / len(blocks)) * uncertainty and abs(slope) > 10 * floor:
            return towards, True
        if abs(slope) + 3 * uncertainty < width / 2:
            return "bounded", True
    if _cycles(blocks.means) >= CYCLES and _thirds_agree(blocks):
        return "bounded", True
    if _is_caught(blocks):
        return "caught", False
    return ("wanders" if _walks(blocks) else "too early"), False


def _is_steady(blocks: _Blocks) -> bool:
    """Whether the means move one way, far better than those of a random walk."""
    return _one_way(blocks.means) or steady([Bin(0.0, mean, mean) for mean in blocks.means.tolist()])


def _one_way(values: Any) -> bool:
    """Whether each value is above the one before, or each below."""
    moves = np.diff(values)
    return bool(np.all(moves > 0) or np.all(moves < 0))


def _runs_away(blocks: _Blocks) -> bool:
    """Whether the last quarter moves one way only, and far beyond all before it."""
    quarter, end = len(blocks) // 4, float(blocks.means[-1])
    before = blocks.part(slice(-quarter))
    far = max(end - before.highs.max(), before.lows.min() - end) > _width(before) / 2
    return bool(far) and _one_way(blocks.means[-max(quarter, 6) :]) and _exponent(blocks.means, 1, 2) > ROUGH


def _correlation(blocks: _Blocks) -> float:
    """Of a residual, about the line, with the next one; 0 where the line is all there is, to a thousandth."""
    rest = blocks.means - np.polyval(np.polyfit(blocks.times, blocks.means, 1), blocks.times)
    total = float(rest @ rest)
    return float(rest[1:] @ rest[:-1]) / total if total > 1e-6 * len(rest) * float(np.var(blocks.means)) else 0.0


def _gets_wider(blocks: _Blocks) -> bool:
    """Whether the wobble within four blocks is at the end more than twice as wide as at the start."""
    firsts = np.arange(0, len(blocks), 4)
    widths = np.maximum.reduceat(blocks.highs, firsts) - np.minimum.reduceat(blocks.lows, firsts)
    third = max(1, len(widths) // 3)
    early, late = blocks.part(slice(len(blocks) // 3)), blocks.part(slice(-(len(blocks) // 3), None))
    further = _width(late) > 1.5 * _width(early)  # a few narrow peaks would widen a median
    return further and float(np.median(widths[-third:])) > 2 * float(np.median(widths[:third])) > 0


def _cycles(values: Any) -> float:
    """How often values go from the lower to the upper quarter of their range and back."""
    low, high = float(values.min()), float(values.max())
    sides = np.where(values > high - (high - low) / 4, 1, np.where(values < low + (high - low) / 4, -1, 0))
    sides = sides[sides != 0]
    return int(np.count_nonzero(np.diff(sides))) / 2


def _thirds_agree(blocks: _Blocks) -> bool:
    """Whether the first and the last third reach as low and as high as the whole, but for a quarter."""
    third = len(blocks) // 3
    low, high = float(blocks.lows.min()), float(blocks.highs.max())
    edge = (high - low) / 4
    return all(
        float(part.lows.min()) < low + edge and float(part.highs.max()) > high - edge
        for part in (blocks.part(slice(third)), blocks.part(slice(-third, None)))
    )


def _width(blocks: _Blocks) -> float:
    """How wide the band of some blocks is."""
    return float(blocks.highs.max() - blocks.lows.min())


def _gap(blocks: _Blocks) -> float:
    """How far the band of some blocks is from the start, where the error is 0, in its own widths."""
    away = max(float(blocks.lows.min()), -float(blocks.highs.max()))
    return away / max(_width(blocks), 1e-300)


def _is_caught(blocks: _Blocks) -> bool:
    """Whether the second half is noise in a band that does not hold the start."""
    half = blocks.part(slice(len(blocks) // 2, None))
    if len(half) < 16 or (gap := _gap(half)) < 0.25:
        return False
    slope, uncertainty = _line(half)
    quiet = _correlation(half) < ALIKE and abs(slope) < 4 * max(uncertainty, 1e-300)
    return gap > 50 or quiet or (_cycles(half.means) >= CYCLES and _thirds_agree(half))


def _walks(blocks: _Blocks) -> bool:
    """Whether the means part with the lag as those of a random walk do: neither smoothly nor about one level."""
    n, width = len(blocks), float(np.median(blocks.highs - blocks.lows))
    if n < 32 or len(np.unique(blocks.means)) < n // 2 or _width(blocks) < FAR * width:
        return False
    short, long = (_exponent(blocks.means, lag, factor) for lag, factor in ((1, 2), (n // 16, 4)))
    return short < ROUGH and long > WALK


def _exponent(values: Any, lag: int, factor: int) -> float:
    """The exponent to which values part with the lag, from one lag to `factor` times it, by mean squares."""
    near, far = (float(np.mean((values[by:] - values[:-by]) ** 2)) for by in (lag, factor * lag))
    return math.log(far / near) / math.log(factor) if near > 0 and far > 0 else 0.0
