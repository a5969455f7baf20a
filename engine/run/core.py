"""The judge of energies: bins of a run or a record in, a verdict with its slope and bound out.

The levels and the reasons are in `levels`.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.run import levels
from pendu_tui.engine.run.slope import slope_of, student
from pendu_tui.engine.run.verdicts import BOUNDED, GROWS, LOSES, UNDECIDED, Judgement


class Bins(NamedTuple):
    """Up to 64 parts of a run or a record, in order; energies are relative to the first."""

    times: Any  # of the middle of each
    means: Any
    lows: Any
    highs: Any
    spreads: Any  # standard deviations within each
    rounding: float  # differences up to this mean nothing
    sizes: Any = None  # samples in each, if they may be independent

    def last(self, count: int) -> "Bins":
        """Return so many of the last bins."""
        columns = {name: value[-count:] for name, value in self._asdict().items() if np.ndim(value)}
        return self._replace(**columns)

    @property
    def length(self) -> float:
        """The time of all bins, whose middles cover one less."""
        count = len(self.times)
        return float(self.times[-1] - self.times[0]) * count / (count - 1)

    @property
    def white(self) -> float:
        """The variance of the bins' means if all samples were independent; 0 if unknown."""
        return 0.0 if self.sizes is None else float((self.spreads**2 / (self.sizes - 1)).mean())


class Part:
    """A part of the bins up to the end, with the slope of one value of each."""

    def __init__(self, bins: Bins, values: Any, are_means: bool = False) -> None:
        self.bins = bins
        self.values = values
        self.are_means = are_means
        white = bins.white if are_means else 0.0
        self.slope = slope_of(bins.times, values, bins.rounding, white)
        line = self.slope.mean * (bins.times - bins.times.mean()) + values.mean()
        within = float((bins.spreads**2).mean())
        between = float(((bins.means - line) ** 2).mean())
        self.fluctuation = max(math.sqrt(within + between), bins.rounding)
        self.width = max(float((bins.highs - line).max() - (bins.lows - line).min()), bins.rounding)

    def last(self, share: float) -> "Part":
        """Return the last bins, at least 4."""
        count = max(4, round(len(self.values) * share))
        return Part(self.bins.last(count), self.values[-count:], self.are_means)

    @property
    def move(self) -> float:
        """What the slope adds up to."""
        return self.slope.mean * self.bins.length

    @property
    def is_material(self) -> bool:
        return abs(self.move) >= max(levels.MATERIAL * self.fluctuation, self.bins.rounding)

    @property
    def is_large(self) -> bool:
        return abs(self.move) >= max(levels.LARGE * self.fluctuation, self.bins.rounding)

    @property
    def widens(self) -> bool:
        """Whether the band is wider from quarter to quarter, and far wider at the end."""
        widths = self.bins.highs - self.bins.lows + 2 * self.bins.spreads
        sizes = [float(part.mean()) for part in np.array_split(widths, 4)]
        return sizes == sorted(sizes) and sizes[3] > levels.WIDENING * (
            sizes[0] + self.bins.rounding
        )

    @property
    def ends_alike(self) -> bool:
        """Whether the last parts are like others of their size, or hardly differ."""
        for count in levels.ENDS:
            *others, end = blocks_of(self.values, max(1, len(self.values) // count))
            is_material = abs(end - np.mean(others)) > levels.MATERIAL * self.fluctuation
            if is_material and not is_like(end, np.array(others), levels.UNLIKE):
                return False
        return True


def blocks_of(values: Any, size: int) -> Any:
    """Return the means of blocks of values, the last of which ends where they end."""
    return values[len(values) % size :].reshape(-1, size).mean(axis=1)


def is_like(value: float, others: Any, level: float) -> bool:
    """Return whether a value may come from the distribution of the others: Student's t."""
    count = len(others)
    deviation = float(others.std()) * math.sqrt((count + 1) / (count - 1))
    below = student(value - float(others.mean()), deviation, count - 1)
    return 2 * min(below, 1 - below) > level


def judge_bins(bins: Bins, steady: bool = False) -> Judgement:
    """Judge bins.  `steady`: those of a run, which must not drift at all to be bounded."""
    unit, bins = _normalized(bins)
    return _Core(bins, steady).judgement().scaled(unit)


def measure_bins(bins: Bins) -> Judgement:
    """Return the slope of bins with its bounds, undecided."""
    unit, bins = _normalized(bins)
    return _Core(bins, steady=True).described(UNDECIDED).scaled(unit)


def _normalized(bins: Bins) -> tuple[float, Bins]:
    """Return a unit of energy, and the bins in it, whose squares do not overflow."""
    unit = max(float(np.abs(bins.lows).max()), float(np.abs(bins.highs).max())) or 1.0
    scaled = (each / unit for each in (bins.means, bins.lows, bins.highs, bins.spreads))
    means, lows, highs, spreads = scaled
    rounding = bins.rounding / unit
    return unit, Bins(bins.times, means, lows, highs, spreads, rounding, bins.sizes)


def growth_of(bins: Bins) -> float | None:
    """Return the slope of ln of the energy, from errors beyond E0, if it is the straighter."""
    if bins.lows[-1] <= 1:
        return None
    logarithms = np.log1p(np.maximum(bins.means, 0))
    logarithmic = slope_of(bins.times, logarithms, bins.rounding)
    _, bins = _normalized(bins)
    linear = slope_of(bins.times, bins.means, bins.rounding)
    is_straighter = logarithmic.mean * linear.deviation > linear.mean * logarithmic.deviation
    return logarithmic.mean if is_straighter else None


class _Core:
    def __init__(self, bins: Bins, steady: bool) -> None:
        self._steady = steady
        means = Part(bins, bins.means, are_means=True)
        middles = Part(bins, (bins.lows + bins.highs) / 2)
        # a sampled oscillation moves the means slowly, but not the band; noise moves the band more
        whole = min(means, middles, key=lambda part: part.slope.deviation)
        cycles, waves = wave(bins.times, whole.values)
        if cycles >= levels.MIN_CYCLES:
            whole = Part(bins, whole.values - waves)
        self._whole = whole

    def judgement(self) -> Judgement:
        whole = self._whole
        if moved := self._moves():
            return self.described(moved)
        if rest := self._rests():
            rises = rest.values.mean() > whole.values[0]
            return self.described(GROWS if rises else LOSES, rest)._replace(rests=True)
        if gone := self._gone():
            return gone
        why = self._why_not_bounded(whole, self._steady)
        if not why:
            return self.described(BOUNDED)
        return self.described(UNDECIDED)._replace(reason=why)

    def described(self, verdict: str, part: Part | None = None) -> Judgement:
        part = part or self._whole
        slope = part.slope
        uncertainty = slope.within(levels.ONE_SIGMA, slope.mean)
        independent = 12 * (part.fluctuation / max(uncertainty * part.bins.length, 1e-300)) ** 2
        return Judgement(
            verdict,
            slope=slope.mean,
            uncertainty=uncertainty,
            bound=slope.within(levels.CERTAIN),
            share=part.move / part.width,
            is_evident=slope.chance() < levels.EVIDENT,
            independent=independent,
            fluctuation=part.fluctuation,
        )

    def _moves(self) -> str | None:
        """Return whether the energy grows or loses, in one of the windows up to the end."""
        ranks = _ranks(self._whole.values)
        for share in levels.WINDOWS:
            part = self._whole.last(share)
            if not part.is_material:
                continue
            ranked = slope_of(part.bins.times, ranks[-len(part.values) :], 1.0)
            rises = ranked.mean * part.bins.length
            moves = part.slope.chance() < levels.MOVES * share and _is_new(
                self._whole.values, part, part.move
            )
            steadily = ranked.chance() < levels.MOVES_BY_RANK * share and _is_new(
                ranks, part, rises
            )
            if moves or (steadily and rises * part.move > 0):
                return GROWS if part.move > 0 else LOSES
        return None

    def _why_not_bounded(self, part: Part, steady: bool) -> str:
        """Return the reason; "" if it is bounded."""
        slope = part.slope
        chance = slope.chance()
        if chance > levels.SUSPECT and part.widens:
            return levels.WIDENS
        if chance > levels.SUSPECT and not part.ends_alike:
            return levels.UNLIKE_END
        limit = part.width / part.bins.length
        ahead = levels.AHEAD if steady else 1.0
        if slope.around(0.0, limit / ahead) < levels.CERTAIN:
            return self._open(part, (self._spread(part) * ahead / limit) ** 2)
        if part.is_large or (chance < levels.SUSPECT and part.is_material):
            if not _is_new(self._whole.values, part, part.move):
                return levels.TURNED
            return self._open(part, 2.0)
        if steady and not self._is_steady(part):
            return self._open(part, 2.0)
        if part.widens:
            return levels.WIDENS
        return "" if part.ends_alike else levels.UNLIKE_END

    def _is_steady(self, part: Part) -> bool:
        half = part.last(0.5).slope
        return part.slope.chance(True) > levels.STEADY and half.chance(True) > levels.STEADY_HALF

    def _spread(self, part: Part) -> float:
        return part.slope.within(levels.CERTAIN, part.slope.mean)

    def _open(self, part: Part, factor: float) -> str:
        """Return the reason where a trend is not excluded, with how much longer would decide."""
        if part.slope.walk > 0.5:
            return levels.WALKS
        if not 1 < factor < 100:
            return levels.OPEN.format(longer=levels.UNKNOWN)
        return levels.OPEN.format(longer=levels.LONGER.format(factor=max(factor, 1.5)))

    def _rests(self) -> Part | None:
        """Return the longest part up to the end that is bounded, away from the start."""
        values = self._whole.values
        size = max(1, len(values) // 16)
        start = float(np.median(values[:size]))
        first = values[:size]
        for share in levels.RESTS:
            part = self._whole.last(share)
            level = float(part.values.mean())
            far = abs(start - level) >= levels.MATERIAL * part.fluctuation
            if not far or is_like(start, blocks_of(part.values, size), levels.UNLIKE_START):
                continue
            margin = part.width / 2
            low = min(float(first.min()), level) - margin
            high = max(float(first.max()), level) + margin
            between = values[: len(values) - len(part.values)]
            within = low <= between.min() and between.max() <= high
            if within and not self._why_not_bounded(part, steady=False):
                return part
        return None

    def _gone(self) -> Judgement | None:
        """Return the judgement where the present band is small beside its way from the start."""
        for share in levels.RESTS:
            part = self._whole.last(share)
            low = float(part.bins.lows.min())
            high = float(part.bins.highs.max())
            if max(low, -high) > levels.GONE * max(high - low, part.bins.rounding):
                rests = not self._why_not_bounded(part, steady=False)
                return self.described(GROWS if low > 0 else LOSES, part)._replace(rests=rests)
        return None


def _is_new(values: Any, part: Part, move: float) -> bool:
    """Return whether values end where they have not been before a part that moves them so far."""
    count = len(part.values)
    size = max(1, count // 8)
    way = math.copysign(1.0, move)
    end = way * float(values[-size:].mean())

    def beyond(past: Any) -> float:
        return end - float((way * blocks_of(past, size)).max())

    before = values[: len(values) - count]
    is_new = len(before) < size or beyond(before) >= levels.NEW * abs(move)
    return is_new and beyond(values[: len(values) - count // 2]) >= levels.NEW / 2 * abs(move)


def wave(times: Any, values: Any) -> tuple[float, Any]:
    """Return the cycles of the wave that explains what a line leaves, and it; 0: there is none."""
    x = (times - times[0]) / (times[-1] - times[0])
    level = np.full_like(x, 1 / math.sqrt(len(x)))
    line = _unit(_without(x, (level,)))
    rest = _without(values, (level, line))
    square = float((rest * rest).sum())
    cycles = np.arange(0.5, len(x) / 2, 0.25)
    for enough, step in ((0.5, 0.25 / 25), (levels.WAVE, 0.0)):
        angles = math.tau * cycles[:, None] * x
        cosines = _unit(_without(np.cos(angles), (level, line)))
        sines = _unit(_without(np.sin(angles), (level, line, cosines)))
        by_cosines = (cosines * rest).sum(axis=1)
        by_sines = (sines * rest).sum(axis=1)
        explained = by_cosines**2 + by_sines**2
        best = int(np.argmax(explained))
        if explained[best] < enough * square:
            return 0.0, None
        found = float(cycles[best])
        cycles = found + step * np.arange(-25, 26)
    cosine = np.cos(angles[best])
    sine = np.sin(angles[best])
    # of the wave itself: what it has in common with a line is no part of the line
    by_sine = by_sines[best] / float((sine * sines[best]).sum())
    rest = by_cosines[best] - by_sine * float((sine * cosines[best]).sum())
    by_cosine = rest / float((cosine * cosines[best]).sum())
    return found, by_cosine * cosine + by_sine * sine


def _without(rows: Any, basis: tuple[Any, ...]) -> Any:
    """Return rows without what they have in common with orthonormal ones."""
    for row in basis:
        rows = rows - (rows * row).sum(axis=-1, keepdims=True) * row
    return rows


def _unit(rows: Any) -> Any:
    return rows / np.maximum(np.sqrt((rows * rows).sum(axis=-1, keepdims=True)), 1e-300)


def _ranks(values: Any) -> Any:
    ranks = np.empty(len(values))
    ranks[np.argsort(values, kind="stable")] = np.arange(len(values))
    return ranks
