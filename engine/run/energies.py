"""The record of any program: a verdict from times and energies alone.

A least-squares fit in correlated noise describes the means of up to 64 blocks by a level, a wave
and one more curve, which still moves (a line, an exponential, a logarithm) or has settled (an
approach, a step).

The terms of the cosine transform of stationary noise are independent, with the spectrum as their
variances (Whittle, J. R. Stat. Soc. B 15 (1953) 125).  The noise may have any correlation time,
from none to that of a random walk, and white noise on top.  Likelihoods are averaged over a grid of
such spectra (restricted maximum likelihood: Harville, J. Am. Stat. Assoc. 72 (1977) 320), so the
uncertainty of a slope holds for correlated values, too.
"""

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from engine.run import judgement as limits
from engine.run.bands import MAX_BINS
from engine.run.judgement import Judgement, Progress

# correlation times, of the record: the first looks like a walk, the others like a level
_TIMES = 1 / np.array([0.5, 5, 10, 20, 40, 80])
_WHITE = np.array([0.0, 3, 100])  # variance of white noise, in that of the kicks
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
    end = np.abs(energies[-(len(energies) // 4) :]).max()
    if absolute and end < limits.LOST * abs(energies[0]):
        return Judgement("loses" if energies[0] > 0 else "grows")
    floor = max(_last_digit(energies), limits.ROUNDING)
    first = _outliers(energies, floor)
    record = _Record(times[first:], energies[first:], floor)
    if early := record.transient():
        first += early
        record = _Record(times[first:], energies[first:], floor)
    judgement = record.conclude()
    signed = np.sign(energies[0]) * energies[first:]
    multiplied = absolute and signed.max() > limits.MULTIPLIED * signed.min() > 0
    if multiplied and judgement.verdict not in ("grows", "loses"):
        logarithms = np.sign(energies[0]) * np.log(signed)
        judgement = _Record(times[first:], logarithms, limits.ROUNDING).conclude()
    scale = unit / float(times[-1] - times[first])
    return judgement._replace(
        slope=record.line.amplitude * scale,
        uncertainty=math.hypot(record.line.deviation, record.incomplete) * scale,
        transient=float(times[first] - times[0]),
        first=first,
        independent=record.independent,
        fluctuation=float(np.std(record.rest)) * unit,
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
    low, high = rest[early:].min(), rest[early:].max()
    margin = max((high - low) / 2, floor)
    outside = (rest[:early] < low - margin) | (rest[:early] > high + margin)
    return int(np.flatnonzero(outside).max(initial=-1)) + 1


class _Fit(NamedTuple):
    """A curve fitted together with a level and a wave."""

    likelihood: float  # logarithm, of the best noise
    amplitude: float  # averaged over the noises
    deviation: float
    walks: float  # logarithm of the likelihood ratio of a random walk and of noise about a level

    @property
    def sigmas(self) -> float:
        """The amplitude in its standard deviations."""
        return abs(self.amplitude) / self.deviation


@cache
def _noises(count: int) -> tuple[Any, Any, Any]:
    """Return cosines, correlation times and, for each noise and cosine, the root of its weight."""
    angles = np.pi * np.arange(count) / count
    cosines = np.cos(angles[:, None] * (np.arange(count) + 0.5)) * math.sqrt(2 / count)
    spectra = [np.ones(count - 1)]
    for time in _TIMES:
        kicked = 1 / np.abs(1 - math.exp(-1 / (time * count)) * np.exp(1j * angles[1:])) ** 2
        spectra += [kicked + share for share in _WHITE]
    # the first cosine is the level, which any noise leaves alone
    roots = np.insert(1 / np.sqrt(spectra), 0, 1.0, axis=1)
    return cosines, np.array([0.0, *np.repeat(_TIMES, len(_WHITE))]), roots


class _Record:
    """The best curve of each kind through the means of blocks, over times from 0 to 1."""

    def __init__(self, times: Any, energies: Any, floor: float) -> None:
        self._count = count = min(MAX_BINS, len(times) // 2)
        self._at = (times - times[0]) / (times[-1] - times[0])
        self._floor = floor
        self._constant = np.ptp(energies) <= 2 * floor
        energies = energies - float(energies.mean())
        self._times = times = _means(self._at, count)
        self._means = _means(energies, count)
        self._base = np.ones((count, 1))
        self._cycles = math.inf  # of the wave
        self._add_wave()
        edge = max(2, count // 8)
        steps = np.arange(count) - np.arange(edge, count - edge, 0.25)[:, None] + 1
        moving = [
            times,
            *np.expm1(_RATES[:, None] * times) / np.expm1(_RATES)[:, None],
            *np.log1p(_LOGARITHMS[:, None] * times),
        ]
        settled = [*-np.expm1(-_SETTLING[:, None] * times), *np.clip(steps, 0, 1)]
        fits = self._fits(moving + settled)
        self._level = self._fits([0 * times])[0]
        self.line = fits[0]
        self._moving = max(fits[: len(moving)])
        self._settled = max(fits[len(moving) :])
        ends = [*(3 / _SETTLING), *np.ones(len(steps))]
        # time to a 20th of the way
        self._settling = float(ends[fits.index(self._settled) - len(moving)])
        self.rest = energies - np.polyval(np.polyfit(self._at, energies, 1), self._at)
        error = max(self.line.deviation, floor / len(times))
        effective = 24 * float(np.mean(self.rest**2)) / error**2
        self.independent = min(float(len(self._at)), effective)
        # an incomplete wobble at the end tilts a line by so much
        self.incomplete = 12 * float(np.std(self.rest)) / len(self._at)
        self._within = max(float(np.mean(energies**2) - np.mean(self._means**2)), 0.0)

    def _fits(self, curves: list[Any]) -> list[_Fit]:
        """Fit each curve together with the base, for every noise."""
        cosines, noise_times, roots = _noises(self._count)
        basis, sizes = np.linalg.qr(roots[:, :, None] * (cosines @ self._base))
        columns = cosines @ np.column_stack([*curves, self._means])
        explained = (roots[:, :, None] * basis).transpose(0, 2, 1) @ columns
        products = roots**2 @ (columns * columns[:, -1:])
        products -= (explained * explained[:, :, -1:]).sum(axis=1)
        lengths = roots**2 @ columns**2 - (explained**2).sum(axis=1)
        lengths = np.maximum(lengths[:, :-1], 1e-15)
        amplitudes = products[:, :-1] / lengths
        squares = np.maximum(products[:, -1:] - amplitudes**2 * lengths, 0)
        # means of values that are rounded apart err by a tenth of what one value does
        squares += self._count * self._floor**2 / 12 / 100
        determinants = 2 * np.log(roots).sum(axis=1, keepdims=True)
        whole = (determinants - (self._count - 1) * np.log(squares)) / 2
        diagonals = np.abs(np.diagonal(sizes, axis1=1, axis2=2))
        design = 2 * np.log(diagonals).sum(axis=1, keepdims=True) + np.log(lengths)
        freedom = self._count - 1 - self._base.shape[1]
        restricted = (determinants - design - freedom * np.log(squares)) / 2
        weights = np.exp(restricted - restricted.max(axis=0))
        weights /= weights.sum(axis=0)
        walk = restricted[noise_times == _TIMES[0]].max(axis=0)
        level = restricted[noise_times <= _TIMES[1]].max(axis=0)
        found = (
            whole.max(axis=0),
            (weights * amplitudes).sum(axis=0),
            np.exp((weights * np.log(squares / freedom / lengths)).sum(axis=0) / 2),
            walk - level,
        )
        return [_Fit(*map(float, each)) for each in zip(*found, strict=True)]

    def _add_wave(self) -> None:
        """Add to the base the cosine and sine that stand out of every noise, if any do."""
        without = self._fits([self._times])[0].likelihood
        best = self._best_wave(np.arange(1.25, self._count / 2, 0.25))
        best = self._best_wave(best + np.linspace(-0.25, 0.25, 51))
        angles = math.tau * best * self._times
        base = self._base
        self._base = np.column_stack([base, np.cos(angles), np.sin(angles)])
        gain = self._fits([self._times])[0].likelihood - without
        if gain < 1.5 * math.log(self._count) + limits.WAVE:
            self._base = base
        else:
            self._cycles = best

    def _best_wave(self, cycles: Any) -> float:
        """Return the cycles of the wave that explains most besides the base and a line."""
        basis = np.linalg.qr(np.column_stack([self._base, self._times]))[0]
        angles = math.tau * cycles[:, None] * self._times
        waves = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        waves = np.linalg.qr(waves - basis @ (basis.T @ waves))[0]
        rest = self._means - basis @ (basis.T @ self._means)
        return float(cycles[np.argmax(((rest @ waves) ** 2).sum(axis=1))])

    @property
    def _widens(self) -> bool:
        """Whether it fluctuates more from quarter to quarter, and far more at the end."""
        sizes = [float(np.abs(part).mean()) for part in np.array_split(self.rest, 4)]
        return sizes == sorted(sizes) and sizes[-1] > limits.WIDENING * (sizes[0] + self._floor)

    @property
    def _has_settled(self) -> bool:
        """Whether a curve that settles is far likelier than any that moves, and leaves the band."""
        likelier = self._settled.likelihood - self._moving.likelihood > limits.ODDS
        return likelier and self._settled.amplitude**2 > self._within

    def transient(self) -> int:
        """Return how many samples belong to an approach to a level that is over early."""
        if not self._has_settled or self._settling > limits.TRANSIENT:
            return 0
        size = abs(self._settled.amplitude) / max(math.sqrt(self._within), self._floor)
        end = self._settling / 3 * min(max(math.log(size) + 1, 3.0), 6.0)
        return int(np.searchsorted(self._at, end))

    def conclude(self) -> Judgement:
        """Return the verdict that the best curves of each kind allow."""
        few = self.independent < limits.MIN_INDEPENDENT or self._cycles < limits.MIN_CYCLES
        least = limits.CURVE_OF_FEW if few else limits.TREND
        if self._constant:
            return Judgement("bounded")
        if self._has_settled and self._settled.sigmas > least:
            return Judgement("caught")
        rise = self.line.amplitude
        still = self.line.sigmas < limits.STILL or abs(rise) < max(2 * self._floor, self.incomplete)
        settled = self._settled.likelihood - limits.ODDS
        moves = settled < max(self.line.likelihood, self._moving.likelihood - 2 * limits.ODDS)
        trend = self.line.sigmas > limits.LINE_OF_FEW or self._moving.sigmas > least
        if moves and trend and not still:
            return Judgement("grows" if rise > 0 else "loses")
        if still and not few:
            return Judgement("wanders" if self._widens else "bounded")
        walks = self._level.walks > limits.WALK_ODDS and math.isinf(self._cycles)
        if self.line.sigmas < limits.TREND and walks:
            return Judgement("wanders")
        if self._cycles < limits.MIN_CYCLES:
            return _too_early(self._cycles, limits.MIN_CYCLES, "cycles of its wave")
        need = max(limits.MIN_INDEPENDENT, 2 * self.independent)
        return _too_early(self.independent, need, "independent samples")


def _means(values: Any, count: int) -> Any:
    """Return the means of so many blocks of as many values."""
    ends = np.arange(count) * len(values) // count
    return np.add.reduceat(values, ends) / np.diff(ends, append=len(values))
