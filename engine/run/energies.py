"""Energies without a method: a verdict on any program, from times and energies alone.

The record is cut into up to 64 blocks of equal time.  The means of the blocks are held against a
few descriptions: a level, a line, a curve that still moves, a curve or a step that has settled, each
with or without slow waves, and all with correlated noise (engine.run.noise).

In this order: energies that move by no more than rounding are `bounded`; a start outside the band
of the rest is left out; what settles after a change of level is `caught`; a trend `grows` or
`loses`; no trend, in a record of enough independent samples, is `bounded`; a record that has moved
further than any noise about a level would is one that `wanders`.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from engine.run.judgement import Judgement, Progress
from engine.run.noise import Fit, Noises, regressors, waves

MIN_SAMPLES = 64  # 32 blocks: a line, three waves and a noise leave 20 degrees of freedom
MAX_BLOCKS = 64  # resolve a correlation time of a 20th of the record
SAMPLES_PER_BLOCK = 2
MIN_BLOCKS = 12  # where a gap leaves some of them empty
MIN_INDEPENDENT = 15  # correlation times in a record: uncertainties were tested down to here
STILL = 2.6  # standard deviations: a level exceeds them in 1 of 100 records
TREND = 3.3  # standard deviations: a level exceeds them in 1 of 1000 records
STEEP = 2.0  # standard deviations of a line beside a curve: not an end alone
CHANGE = 5.0  # standard deviations of a change of level: the best of 200 in white noise has 3.3
LINE_OF_FEW = 7.0  # standard deviations, where independent samples are few: 2 in 100 random walks
CURVE_OF_FEW = 12.0  # have a steeper line, or a clearer curve
STILL_MOVING = 0.05  # of a change of level, in the second half: it has not settled
SETTLED = math.log(100)  # of a likelihood ratio: wrong in 1 of 100 where both are as common
CLEAR = math.log(10)  # of a likelihood ratio, between curves of as many parameters
WALKS = 3.5  # of a likelihood ratio: noise with a correlation time of T/5 exceeds it in 1 of 100
MIN_CYCLES = 4.0  # of a slow wave that is called bounded: thirds of the record look alike
WAVES = 12.0  # log likelihood that waves must gain: in random walks they gained up to 10
TRANSIENT = 0.1  # of the record: a start that is over so early belongs to the preparation
ROUNDING = 1e-12  # of the energy: a random walk of 1e7 roundings of 1e-16
AT_REST = 0.01  # of the first energy: losing all of it is no other level
MULTIPLIED = 1e3  # times the smallest energy: what multiplies is judged in its logarithm

_RATES = np.array([-4, -3, -2, -1.4, -1, *np.geomspace(1, 25, 15)])  # exponentials that still move
_LOGARITHMS = np.geomspace(1, 3000, 15)  # of log(1 + k t), which never settles
_SETTLING = np.geomspace(6, 600, 30)  # exponential approaches that are over within the record


class SeriesJudgement(NamedTuple):
    """The judgement on a series, with the evidence that only a whole record can give."""

    judgement: Judgement
    transient: float = 0.0  # time at the start that was left out
    first: int = 0  # the index of the first sample that was judged
    independent: float = 0.0  # correlation times in the record
    fluctuation: float | None = None  # standard deviation about a line, of the energies' unit


class _Blocks(NamedTuple):
    """Arrays with one value a block; times run from 0 to 1."""

    places: Any  # numbers of the blocks
    times: Any
    means: Any
    sizes: Any  # samples


def judge_energies(times: Any, energies: Any, failed: bool = False) -> SeriesJudgement:
    """Judge finite `energies` at increasing `times`; the slope has their units.

    `failed`: nan or inf came after the last of them.
    """
    if failed:
        return SeriesJudgement(Judgement("failed"))
    if len(times) < MIN_SAMPLES:
        return SeriesJudgement(_too_early(len(times), MIN_SAMPLES, "samples"))
    unit = float(np.abs(energies).max()) or 1.0
    energies = energies / unit  # squares must not overflow
    floor = max(_last_digit(energies * unit) / unit, ROUNDING)
    first = _transient(times, energies, floor)
    if np.abs(energies[-(len(energies) // 4) :]).max() < AT_REST * abs(float(energies[first])):
        return SeriesJudgement(Judgement("loses" if energies[first] > 0 else "grows"), first=first)
    found = _judge(times[first:], energies[first:], floor)
    if found.first:
        first += found.first
        found = _judge(times[first:], energies[first:], floor, again=True)
    judgement = found.judgement
    rest = energies[first:]
    if 0 < MULTIPLIED * np.abs(rest).min() < np.abs(rest).max() and rest.min() * rest.max() > 0:
        logarithms = np.sign(rest) * np.log(np.abs(rest))
        verdict = _judge(times[first:], logarithms, ROUNDING, again=True).judgement.verdict
        judgement = judgement._replace(verdict=verdict)
    if judgement.slope is not None and judgement.uncertainty is not None:
        rate = unit / float(times[-1] - times[first])
        slope = judgement.slope * rate
        judgement = judgement._replace(slope=slope, uncertainty=judgement.uncertainty * rate)
    return SeriesJudgement(
        judgement=judgement,
        transient=float(times[first] - times[0]),
        first=first,
        independent=found.independent,
        fluctuation=None if found.fluctuation is None else found.fluctuation * unit,
    )


def _too_early(have: float, need: float, unit: str) -> Judgement:
    return Judgement("too early", progress=Progress(int(have), int(need), unit))


def _last_digit(energies: Any) -> float:
    """Return the last printed digit of the energies, or the rounding of a double."""
    some = energies[:: max(1, len(energies) // 4096)]
    rounding = 8 * np.finfo(float).eps * float(np.abs(some).max())
    for exponent in range(8, -18, -1):
        digit = 10.0**exponent
        if digit > np.abs(some).max():
            continue
        if digit <= rounding:
            break
        if np.all(np.abs(some - np.round(some / digit) * digit) <= rounding):
            return digit
    return rounding


def _transient(times: Any, energies: Any, floor: float) -> int:
    """Return how many samples at the start lie outside the band of the rest, by half its width."""
    at = (times - times[0]) / (times[-1] - times[0])
    early = int(np.searchsorted(at, TRANSIENT))
    if early > len(at) // 2:  # a gap: the rest is the smaller part
        return 0
    line = np.polyfit(at[early:], energies[early:], 1)
    rest = energies - np.polyval(line, at)
    low = float(rest[early:].min())
    high = float(rest[early:].max())
    margin = max((high - low) / 2, floor)
    outside = np.flatnonzero((rest[:early] > high + margin) | (rest[:early] < low - margin))
    return int(outside[-1]) + 1 if len(outside) else 0


def _judge(times: Any, energies: Any, floor: float, again: bool = False) -> SeriesJudgement:
    """Judge a record; `first` of the result is not 0 where so many samples are a transient."""
    at = (times - times[0]) / (times[-1] - times[0])
    energies = energies - float(np.median(energies))
    count = min(MAX_BLOCKS, len(at) // SAMPLES_PER_BLOCK)
    blocks = _cut(at, energies, count)
    if len(blocks.means) < MIN_BLOCKS:
        return SeriesJudgement(_too_early(len(blocks.means), MIN_BLOCKS, "blocks with samples"))
    if float(np.ptp(energies)) <= 2 * floor:
        return SeriesJudgement(Judgement("bounded", 0.0, floor))
    stories = _best_stories(blocks, count, floor)
    rest = energies - np.polyval(np.polyfit(at, energies, 1), at)
    error = max(stories.line.deviation, floor / len(at))
    independent = min(len(at), 24 * float(np.mean(rest**2)) / error**2)
    within = float(np.mean(energies**2) - np.average(blocks.means**2, weights=blocks.sizes))
    within = max(within, 0.0)
    has_settled = stories.settled_gain > SETTLED and stories.settled.amplitude**2 > within
    if has_settled and stories.settling <= TRANSIENT and not again:
        times_over = math.log(abs(stories.settled.amplitude) / max(math.sqrt(within), floor)) + 1
        end = stories.settling / 3 * min(max(times_over, 3.0), 6.0)
        return SeriesJudgement(Judgement(), first=int(np.searchsorted(at, end)))
    judgement = _conclude(stories, independent, has_settled)
    if judgement.verdict == "caught" and len(at) >= 2 * MIN_SAMPLES:
        half = len(at) // 2
        later = _judge(times[half:], energies[half:], floor, again=True).judgement
        moves = abs(later.slope or 0.0) > STILL_MOVING * abs(stories.settled.amplitude)
        judgement = later if moves and later.significant else judgement
    if judgement.verdict == "bounded" and not again:
        wobble = np.abs(rest)
        wider = _judge(times, wobble, floor, again=True).judgement
        if wider.verdict == "grows" and (wider.slope or 0.0) > float(np.mean(wobble)):
            judgement = Judgement("wanders")  # it triples
    slope = stories.line.amplitude
    if abs(slope) < 2 * floor and judgement.verdict in ("grows", "loses"):
        judgement = Judgement("bounded")
    significant = judgement.verdict in ("grows", "loses")
    return SeriesJudgement(
        judgement._replace(
            slope=slope, uncertainty=stories.line.deviation, significant=significant
        ),
        independent=independent,
        fluctuation=float(np.std(rest)),
    )


def _conclude(stories: "_Stories", independent: float, has_settled: bool) -> Judgement:
    """Return the verdict that the descriptions allow."""
    line = stories.line.sigmas
    few = independent < MIN_INDEPENDENT or stories.cycles < MIN_CYCLES
    walk_like = few or independent < 2 * MIN_INDEPENDENT
    if has_settled and stories.settled.sigmas > (CURVE_OF_FEW if few else CHANGE):
        return Judgement("caught")
    curved = stories.moving.likelihood - stories.line.likelihood > CLEAR
    clear = not curved or stories.settled_gain < -CLEAR
    sure = line > LINE_OF_FEW or stories.moving.sigmas > CURVE_OF_FEW
    trend = sure or (not walk_like and stories.moving.sigmas > TREND)
    if trend and line > STEEP and clear:
        return Judgement("grows" if stories.line.amplitude > 0 else "loses")
    still = line < STILL and not has_settled
    if still and not few:
        return Judgement("bounded")
    if still and stories.walks > WALKS and not math.isfinite(stories.cycles):
        return Judgement("wanders")
    if stories.cycles < MIN_CYCLES:
        return _too_early(stories.cycles, MIN_CYCLES, "cycles of its slowest wave")
    return _too_early(independent, max(MIN_INDEPENDENT, 2 * independent), "independent samples")


def _cut(at: Any, energies: Any, count: int) -> _Blocks:
    """Cut samples at times from 0 to 1 into blocks."""
    places = np.minimum((at * count).astype(np.int64), count - 1)
    firsts = np.flatnonzero(np.diff(places, prepend=-1))
    sizes = np.diff(firsts, append=len(places))
    means = np.add.reduceat(energies, firsts) / sizes
    return _Blocks(
        places=places[firsts],
        times=np.add.reduceat(at, firsts) / sizes,
        means=means,
        sizes=sizes,
    )


class _Stories(NamedTuple):
    """The best description of each kind."""

    walks: float  # of noise about a level: log likelihood ratio of a random walk
    line: Fit
    moving: Fit
    settled: Fit
    settling: float  # the share of the record after which an approach is over; 1 for a step
    cycles: float  # of the slowest wave; infinite without waves
    likelihood: float  # of the best, less a penalty for its parameters

    @property
    def settled_gain(self) -> float:
        """The log likelihood of the best that has settled, less that of the best that moves."""
        return self.settled.likelihood - self.moving.likelihood


def _best_stories(blocks: _Blocks, count: int, floor: float) -> _Stories:
    """Fit all descriptions, with waves if they make a better one."""
    means = blocks.means - float(blocks.means.mean())
    noises = Noises(blocks.places, blocks.sizes, count, floor)
    found = waves(blocks.times, means)
    stories = [
        _stories(blocks.times, means, noises, some) for some in ([], found)[: 1 + bool(found)]
    ]
    return max(stories, key=lambda each: each.likelihood)


def _stories(times: Any, means: Any, noises: Noises, frequencies: list[float]) -> _Stories:
    """Fit all descriptions, with waves of these frequencies."""
    base = [np.ones(len(times)), *regressors(frequencies, times)]
    level = noises.fit(base, means)
    line = noises.fit([*base, times], means)
    curves = np.expm1(_RATES[:, None] * times) / np.expm1(_RATES)[:, None]
    logarithms = np.log1p(_LOGARITHMS[:, None] * times)
    approaches = -np.expm1(-_SETTLING[:, None] * times)
    best = [
        _best(family, base, means)
        for family in (curves, logarithms, approaches, _steps(len(times)))
    ]
    curve, logarithm, approach, step = (noises.fit([*base, family], means) for family, _ in best)
    moving = max(line, curve, logarithm, key=lambda fit: fit.likelihood)
    is_step = step.likelihood > approach.likelihood
    penalty = math.log(len(times))
    likelihood = max(
        level.likelihood, *(fit.likelihood - penalty for fit in (moving, approach, step))
    )
    return _Stories(
        walks=level.walks,
        line=line,
        moving=moving,
        settled=step if is_step else approach,
        settling=1.0 if is_step else 3 / float(_SETTLING[best[2][1]]),  # to a 20th of the way
        cycles=min(frequencies, default=math.inf),
        likelihood=likelihood - 1.5 * len(frequencies) * penalty - (WAVES if frequencies else 0),
    )


def _steps(count: int) -> Any:
    """Return steps of 1 in the middle three quarters of so many blocks, and within a block."""
    edge = max(2, count // 8)
    places = np.arange(edge, count - edge, 0.25)
    return np.clip(np.arange(count) - places[:, None] + 1, 0, 1)


def _best(family: Any, base: list[Any], means: Any) -> tuple[Any, int]:
    """Return the member that explains most of the means, beside the base, and its index."""
    basis = np.linalg.qr(np.column_stack(base))[0]
    members = family - (family @ basis) @ basis.T
    lengths = np.maximum((members**2).sum(axis=1), 1e-12)
    index = int(np.argmax((members @ means) ** 2 / lengths))
    return family[index], index
