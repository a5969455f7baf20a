"""The judge of energies: bins of a run or a record in, a verdict with its slope and bound out.

The levels and the reasons are in `levels`.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.run import levels
from pendu_tui.engine.run.slope import Slope, student
from pendu_tui.engine.run.verdicts import BOUNDED, UNDECIDED, Judgement, direction


class Bins(NamedTuple):
    """Up to 64 parts of a run or a record, in order; energies are relative to the first."""

    times: Any  # of the middle of each
    means: Any
    lows: Any
    highs: Any
    spreads: Any  # standard deviations within each
    rounding: float  # differences up to this mean nothing
    white: float = 0.0  # the deviation of the means if all samples were independent; 0 if unknown

    def last(self, count: int) -> "Bins":
        """Return so many of the last bins."""
        return Bins._make([*(column[-count:] for column in self[:5]), *self[5:]])

    def scaled(self, factor: float) -> "Bins":
        """Return the bins of energies multiplied by a factor."""
        return Bins._make([self.times, *(energies * factor for energies in self[1:])])


def bins_of_looks(looks: Any, h: float, rounding: float) -> Bins:
    """Return the bins of a run, in seconds, from rows of sums over look points."""
    counts, steps, errors, lows, highs = np.array(looks).T
    spreads = (highs - lows) / math.sqrt(8)  # those of a sine
    return Bins(steps / counts * h, errors / counts, lows, highs, spreads, rounding)


class Part:
    """Some bins up to the end, and the slope of one value of each."""

    def __init__(self, bins: Bins, values: Any) -> None:
        self.bins = bins
        self.values = values
        self.slope = Slope(bins.times, values, bins.rounding, bins.white)
        count = len(values)
        # the middles of the bins cover one bin less
        self.length = float(bins.times[-1] - bins.times[0]) * count / (count - 1)
        self.move = self.slope.mean * self.length  # what the slope adds up to
        line = self.slope.mean * (bins.times - bins.times.mean()) + values.mean()
        variances = bins.spreads**2 + (bins.means - line) ** 2
        self.fluctuation = max(math.sqrt(variances.mean()), bins.rounding)
        width = (bins.highs - line).max() - (bins.lows - line).min()
        self.width = max(float(width), bins.rounding)

    def last(self, share: float) -> "Part":
        """Return the last bins, at least 4."""
        count = max(4, round(len(self.values) * share))
        return Part(self.bins.last(count), self.values[-count:])

    def exceeds(self, level: float, move: float) -> bool:
        """Return whether a move is so many standard deviations of the fluctuation."""
        return abs(move) >= level * self.fluctuation

    def described(self, verdict: str, **known: Any) -> Judgement:
        """Return a judgement with this verdict, the slope of this part, and what else is known."""
        return Judgement(
            verdict,
            slope=self.slope.mean,
            uncertainty=self.slope.uncertainty,
            bound=self.slope.bound,
            share=self.move / self.width,
            is_evident=self.slope.chance < levels.EVIDENT,
            independent=12 * (self.fluctuation / self.slope.uncertainty / self.length) ** 2,
            fluctuation=self.fluctuation,
            **known,
        )

    def why_not_bounded(self, ahead: float = 1.0) -> str:
        """Return the reason; "" if it is bounded.

        `ahead` is for how many times its length it must stay in its band; beyond 1, no drift is so
        small that it does not count.
        """
        if self._widens:
            return levels.WIDENS
        is_suspect = self.slope.chance < levels.SUSPECT
        if not (is_suspect or self._ends_alike):
            return levels.UNLIKE_END
        limit = self.width / self.length / ahead
        if self.slope.bound > limit:
            ratio = 3 * self.slope.uncertainty / limit
            return self._open(ratio * ratio)  # a power of floats may overflow
        counts = ahead > 1 or self.exceeds(levels.MATERIAL, self.move)
        if self.exceeds(levels.LARGE, self.move) or (counts and is_suspect):
            return self._open(2.0) if is_new(self.values, self.values, self.move) else levels.TURNED
        return "" if self._ends_alike else levels.UNLIKE_END

    @property
    def _widens(self) -> bool:
        """Whether the band is wider from quarter to quarter, and far wider at the end."""
        widths = self.bins.highs - self.bins.lows
        quarters = [part.mean() for part in np.array_split(widths, 4)]
        start = quarters[0] + self.bins.rounding
        return quarters == sorted(quarters) and quarters[3] > levels.WIDENING * start

    @property
    def _ends_alike(self) -> bool:
        """Whether the last parts are like others of their size, or hardly differ."""
        for count in levels.ENDS:
            blocks = blocks_of(self.values, max(1, len(self.values) // count))
            others = blocks[:-1]
            differs = self.exceeds(levels.MATERIAL, blocks[-1] - others.mean())
            if differs and not is_like(blocks[-1], others, levels.UNLIKE):
                return False
        return True

    def _open(self, factor: float) -> str:
        """Return the reason where a trend is not excluded, with how much longer would decide."""
        if self.slope.walk > 0.5:
            return levels.WALKS
        if not 1 < factor < 100:
            return levels.OPEN.format(longer=levels.UNKNOWN)
        return levels.OPEN.format(longer=levels.LONGER.format(factor=max(factor, 1.5)))


def judge_bins(bins: Bins, ahead: float = 1.0) -> Judgement:
    """Judge bins; `ahead` as in Part.why_not_bounded."""
    unit, whole = whole_of(bins)
    found = _moved(whole) or _rested(whole)
    if not found:
        reason = whole.why_not_bounded(ahead)
        found = whole.described(UNDECIDED if reason else BOUNDED, reason=reason)
    return found.scaled(unit)


def measure_bins(bins: Bins) -> Judgement:
    """Return the slope of bins with its bounds, undecided."""
    unit, whole = whole_of(bins)
    return whole.described(UNDECIDED).scaled(unit)


def whole_of(bins: Bins) -> tuple[float, Part]:
    """Return a unit of energy in which squares do not overflow, and all bins in it.

    A sampled oscillation moves the means of bins slowly, but not the middles of their bands; noise
    moves the middles more.  A wave is no trend.
    """
    unit = float(np.abs((bins.lows, bins.highs)).max()) or 1.0
    bins = bins.scaled(1 / unit)
    known = bins._replace(white=0.0)
    parts = (Part(bins, bins.means), Part(known, (bins.lows + bins.highs) / 2))
    whole = min(parts, key=lambda part: part.slope.uncertainty)
    rest = without_wave(bins.times, whole.values)
    return unit, whole if rest is whole.values else Part(known, rest)


def _moved(whole: Part) -> Judgement | None:
    """Return the judgement if the energy moves for good, in one of the windows up to the end."""
    ranks = np.unique(whole.values, return_inverse=True)[1].astype(float)
    ranked = Part(whole.bins._replace(rounding=1.0, white=0.0), ranks)
    for share in levels.WINDOWS:
        last = whole.last(share)
        if not last.exceeds(levels.MATERIAL, last.move):
            continue
        for every, level in ((whole, levels.MOVES), (ranked, levels.MOVES_BY_RANK)):
            part = every.last(share)
            is_certain = part.slope.chance < level * share
            if is_certain and is_new(every.values, part.values, part.move):
                return whole.described(direction(last.move))
    return None


def _rested(whole: Part) -> Judgement | None:
    """Return the judgement if the energy has left its start, and perhaps rests elsewhere now.

    It rests in the longest part up to the end that is bounded and away from the start.  It has left
    for good, too, if its present band is small beside the way there.
    """
    gone = None
    for share in levels.RESTS:
        part = whole.last(share)
        low = part.bins.lows.min()
        high = part.bins.highs.max()
        is_gone = max(low, -high) > levels.GONE * max(high - low, part.bins.rounding)
        way = low + high if is_gone else _way_from_start(whole, part)
        if not way:
            continue
        rests = not part.why_not_bounded()
        found = part.described(direction(way), rests=rests)
        if rests:
            return found
        if is_gone and not gone:
            gone = found
    return gone


def _way_from_start(whole: Part, part: Part) -> float:
    """Return how far a part is from a start that does not belong to it; 0 if it does.

    Nothing before the part may lie beyond either.
    """
    size = max(1, len(whole.values) // 16)
    first = whole.values[:size]
    start = np.median(first)
    level: float = part.values.mean()
    belongs = is_like(start, blocks_of(part.values, size), levels.UNLIKE_START)
    if belongs or not part.exceeds(levels.MATERIAL, level - start):
        return 0.0
    margin = part.width / 2
    between = whole.values[: len(whole.values) - len(part.values)]
    lowest = min(first.min(), level) - margin
    highest = max(first.max(), level) + margin
    if between.min() < lowest or highest < between.max():
        return 0.0
    return level - float(start)


def blocks_of(values: Any, size: int) -> Any:
    """Return the means of blocks of values, the last of which ends where they end."""
    return values[len(values) % size :].reshape(-1, size).mean(axis=1)


def is_like(value: float, others: Any, level: float) -> bool:
    """Return whether a value may come from the distribution of the others: Student's t."""
    count = len(others)
    spread = max(others.std(), 1e-150)  # that of equal ones; t**2 must stay within doubles
    deviation = spread * math.sqrt((count + 1) / (count - 1))
    below = student(value - others.mean(), deviation, count - 1)
    return 2 * min(below, 1 - below) > level


def is_new(values: Any, last: Any, move: float) -> bool:
    """Return whether the last values, which move so far, end beyond all before the half."""
    size = max(1, len(last) // 8)
    way = math.copysign(1.0, move)
    past = way * values[: len(values) - len(last) // 2]
    beyond: float = way * last[-size:].mean() - blocks_of(past, size).max()
    return beyond >= levels.NEW * abs(move)


def without_wave(times: Any, values: Any) -> Any:
    """Return values without the wave that explains what a line leaves, or unchanged without one."""
    x = (times - times[0]) / (times[-1] - times[0])
    level = np.full_like(x, 1 / math.sqrt(len(x)))
    line = _without(x, level)
    line = line / math.sqrt(_dot(line, line))

    def rest_of(rows: Any) -> Any:
        return _without(_without(rows, level), line)

    rest = rest_of(values)
    cycles = np.arange(levels.MIN_CYCLES, len(x) / 2, 0.25)
    for steps in (np.arange(-25, 26) / 100, np.zeros(1)):
        angles = math.tau * cycles[:, None] * x
        cosines = rest_of(np.cos(angles))
        sines = rest_of(np.sin(angles))
        both = _dot(cosines, sines)
        cosine_squares = _dot(cosines, cosines)
        sine_squares = _dot(sines, sines)
        along = _dot(cosines, rest)
        across = _dot(sines, rest)
        area = cosine_squares * sine_squares - both**2
        a = (sine_squares * along - both * across) / area
        b = (cosine_squares * across - both * along) / area
        explained = a * along + b * across
        best = np.argmax(explained)
        cycles = cycles[best] + steps
    if explained[best] < levels.WAVE * _dot(rest, rest):
        return values
    return values - a[best] * np.cos(angles[best]) - b[best] * np.sin(angles[best])


def _dot(rows: Any, others: Any) -> Any:
    """Return the products of rows, added up in an order that is the same everywhere."""
    return (rows * others).sum(axis=-1)


def _without(rows: Any, unit: Any) -> Any:
    """Return rows without what they have in common with one of length 1."""
    return rows - _dot(rows, unit)[..., None] * unit
