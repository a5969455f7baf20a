"""The record of any program: a verdict from times and energies alone.

The means of up to 64 blocks are held against a few descriptions in correlated noise
(engine.run.noise): a level, a line, a curve that still moves, a curve or a step that has settled.

In this order: a start outside the band of the rest is left out, and so is an approach that is over
early; what moves by no more than its last digit is `bounded`; what settles after a change of level
is `caught`; a trend `grows` or `loses`; no trend in enough independent samples is `bounded`; what
looks like a random walk, or fluctuates more and more, `wanders`.
"""

import math
from typing import Any

import numpy as np

from engine.run import judgement as limits
from engine.run.bands import MAX_BINS
from engine.run.judgement import Judgement, Progress
from engine.run.noise import Noises

_RATES = np.array([-4, -3, -2, -1.4, -1, *np.geomspace(1, 25, 15)])  # exponentials that still move
_LOGARITHMS = np.geomspace(1, 3000, 15)  # of log(1 + k t), which never settles
_SETTLING = np.geomspace(6, 600, 30)  # exponential approaches that are over within the record


def judged(times: Any, energies: Any, absolute: bool = True) -> Judgement:
    """Judge finite `energies` at increasing `times`; the slope has their units.

    The zero of energy means something if it is `absolute`.
    """
    if len(times) < limits.MIN_SAMPLES:
        return _too_early(len(times), limits.MIN_SAMPLES, "samples")
    unit = float(np.abs(energies).max()) or 1.0
    energies = energies / unit  # squares must not overflow
    floor = max(_last_digit(energies), limits.ROUNDING)
    first = _outliers(energies, floor)
    if absolute and np.abs(energies[-(len(energies) // 4) :]).max() < limits.LOST * abs(
        energies[0]
    ):
        return Judgement("loses" if energies[0] > 0 else "grows")
    first += _transient(times[first:], energies[first:], floor)
    at = times[first:]
    rest = energies[first:]
    judgement = _judge(at, rest, floor)
    sizes = np.abs(rest)
    multiplied = float(sizes.max()) > limits.MULTIPLIED * float(sizes.min()) > 0
    multiplied = multiplied and absolute and float(rest.min() * rest.max()) > 0
    if multiplied and judgement.verdict not in ("grows", "loses"):
        logarithms = np.sign(rest) * np.log(sizes)
        judgement = judgement._replace(verdict=_judge(at, logarithms, limits.ROUNDING).verdict)
    scale = unit / float(at[-1] - at[0])
    return judgement._replace(
        slope=judgement.slope and judgement.slope * scale,
        uncertainty=judgement.uncertainty and judgement.uncertainty * scale,
        fluctuation=judgement.fluctuation and judgement.fluctuation * unit,
        transient=float(at[0] - times[0]),
        first=first,
    )


def _too_early(have: float, need: float, unit: str) -> Judgement:
    return Judgement("too early", progress=Progress(int(have), int(need), unit))


def _last_digit(energies: Any) -> float:
    """Return the step between energies that were rounded: the least difference, if they repeat."""
    different = np.diff(np.unique(energies))
    rounding = 8 * float(np.finfo(float).eps)
    different = different[different > rounding]
    return float(different.min()) if 0 < len(different) < len(energies) / 2 else rounding


def _outliers(energies: Any, floor: float) -> int:
    """Return how many samples at the start lie outside the band of the rest, by half its width."""
    early = int(len(energies) * limits.TRANSIENT)
    at = np.arange(len(energies))
    rest = energies - np.polyval(np.polyfit(at[early:], energies[early:], 1), at)
    low = float(rest[early:].min())
    high = float(rest[early:].max())
    margin = max((high - low) / 2, floor)
    outside = np.flatnonzero((rest[:early] > high + margin) | (rest[:early] < low - margin))
    return int(outside[-1]) + 1 if len(outside) else 0


def _transient(times: Any, energies: Any, floor: float) -> int:
    """Return how many samples belong to an approach to a level that is over early."""
    stories = _Stories(times, energies, floor)
    if not stories.has_settled or stories.settling > limits.TRANSIENT:
        return 0
    size = abs(stories.settled.amplitude) / max(math.sqrt(stories.within), floor)
    end = stories.settling / 3 * min(max(math.log(size) + 1, 3.0), 6.0)
    return int(np.searchsorted(stories.at, end))


def _judge(times: Any, energies: Any, floor: float) -> Judgement:
    """Judge a record without a transient; the slope is that over the whole record."""
    if float(np.ptp(energies)) <= 2 * floor:
        return Judgement("bounded", slope=0.0, uncertainty=floor)
    stories = _Stories(times, energies, floor)
    judgement = stories.conclude()
    if judgement.verdict == "bounded":
        wobble = np.abs(stories.rest)
        wider = _Stories(times, wobble, floor)
        if wider.conclude().verdict == "grows" and wider.line.amplitude > float(
            wobble.mean()
        ) * 2 * (limits.WIDER - 1) / (limits.WIDER + 1):
            judgement = Judgement("wanders")
    return judgement._replace(
        slope=stories.line.amplitude,
        uncertainty=math.hypot(stories.line.deviation, stories.incomplete),
        independent=stories.independent,
        fluctuation=float(np.std(stories.rest)),
    )


class _Stories:
    """The best description of each kind."""

    def __init__(self, times: Any, energies: Any, floor: float) -> None:
        """Fit them all; times count from 0 to 1 then."""
        count = min(MAX_BINS, len(times) // 2)
        self.at = (times - times[0]) / (times[-1] - times[0])
        energies = energies - float(energies.mean())
        times = _means(self.at, count)
        means = _means(energies, count)
        noises = Noises(count, floor)
        base = noises.waves(times, means)
        self.cycles = noises.cycles
        self.level = noises.fit(base, means)
        self.line = noises.fit([*base, times], means)
        families = (
            np.expm1(_RATES[:, None] * times) / np.expm1(_RATES)[:, None],
            np.log1p(_LOGARITHMS[:, None] * times),
            -np.expm1(-_SETTLING[:, None] * times),
            _steps(count),
        )
        best = [_best(family, base, means) for family in families]
        curve, logarithm, approach, step = (
            noises.fit([*base, family[index]], means)
            for family, index in zip(families, best, strict=True)
        )
        self.moving = max(self.line, curve, logarithm, key=lambda fit: fit.likelihood)
        is_step = step.likelihood > approach.likelihood
        self.settled = step if is_step else approach
        self.settling = 1.0 if is_step else 3 / float(_SETTLING[best[2]])  # to a 20th of the way
        self.rest = energies - np.polyval(np.polyfit(self.at, energies, 1), self.at)
        self.floor = floor
        error = max(self.line.deviation, floor / len(self.at))
        self.independent = min(len(self.at), 24 * float(np.mean(self.rest**2)) / error**2)
        # an incomplete wobble at the end tilts a line by so much
        self.incomplete = 12 * float(np.std(self.rest)) / len(self.at)
        self.within = max(float(np.mean(energies**2) - np.mean(means**2)), 0.0)

    @property
    def has_settled(self) -> bool:
        """Whether the best that has settled is better than the best that moves."""
        return (
            self.settled.likelihood - self.moving.likelihood > limits.SETTLED
            and self.settled.amplitude**2 > self.within
        )

    def conclude(self) -> Judgement:
        """Return the verdict that the descriptions allow."""
        line = self.line.sigmas
        few = self.independent < limits.MIN_INDEPENDENT or self.cycles < limits.MIN_CYCLES
        walk_like = few or self.independent < 2 * limits.MIN_INDEPENDENT
        if self.has_settled and self.settled.sigmas > (
            limits.CURVE_OF_FEW if few else limits.CHANGE
        ):
            return Judgement("caught")
        curved = self.moving.likelihood - self.line.likelihood > limits.CLEAR
        clear = not curved or self.settled.likelihood - self.moving.likelihood < -limits.CLEAR
        sure = line > limits.LINE_OF_FEW or self.moving.sigmas > limits.CURVE_OF_FEW
        trend = sure or (not walk_like and self.moving.sigmas > limits.TREND)
        if trend and clear:
            if abs(self.line.amplitude) < max(2 * self.floor, self.incomplete):
                return Judgement("bounded")
            return Judgement("grows" if self.line.amplitude > 0 else "loses")
        level = not self.has_settled and self.settled.sigmas < limits.CHANGE
        if level and line < limits.STILL and not walk_like:
            return Judgement("bounded")
        walks = self.level.walks > limits.CLEAR and math.isinf(self.cycles)
        if level and line < limits.TREND and walks:
            return Judgement("wanders")
        if self.cycles < limits.MIN_CYCLES:
            return _too_early(self.cycles, limits.MIN_CYCLES, "cycles of its slowest wave")
        need = 2 * max(limits.MIN_INDEPENDENT, self.independent)
        return _too_early(self.independent, need, "independent samples")


def _means(values: Any, count: int) -> Any:
    """Return the means of so many blocks of as many values."""
    ends = np.arange(count) * len(values) // count
    return np.add.reduceat(values, ends) / np.diff(ends, append=len(values))


def _steps(count: int) -> Any:
    """Return steps of 1 in the middle three quarters of so many blocks, and within a block."""
    edge = max(2, count // 8)
    places = np.arange(edge, count - edge, 0.25)
    return np.clip(np.arange(count) - places[:, None] + 1, 0, 1)


def _best(family: Any, base: list[Any], means: Any) -> int:
    """Return the index of the member that explains most of the means, beside the base."""
    basis = np.linalg.qr(np.column_stack([np.ones(len(means)), *base]))[0]
    members = family - (family @ basis) @ basis.T
    lengths = np.maximum((members**2).sum(axis=1), 1e-12)
    return int(np.argmax((members @ means) ** 2 / lengths))
