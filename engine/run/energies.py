"""Judge the record of any program from times and energies alone.

The means of up to 64 blocks are fitted by least squares with a level, perhaps a wave, and one more
curve at a time.  Some curves still move at the end (a line, exponentials, logarithms), others have
settled (approaches, steps).  The likelihoods of the best of each kind give the verdict.

The noise may have any correlation time up to a random walk's, and white noise on top.  The terms of
its cosine transform are independent, with its spectrum as variances (Whittle, J. R. Stat. Soc. B 15
(1953) 125).  A fit is averaged over a grid of spectra, weighted by restricted likelihood (Harville,
J. Am. Stat. Assoc. 72 (1977) 320), so its uncertainties hold for correlated energies, too.
"""

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.run import judgement as limits
from pendu_tui.engine.run.bands import MAX_BINS
from pendu_tui.engine.run.verdicts import Judgement, Progress, in_todays_words

# correlation times over the record's length: noise with the first walks, others have a level
_TIMES = 1 / np.array([0.5, 5, 10, 20, 40, 80])
_WHITE = np.array([0.0, 3, 100])  # variances of white noise, over those of the other's increments
_RATES = np.array([-4, -3, -2, -1.4, -1, *np.geomspace(1, 25, 15)])  # exponentials that still move
_LOGARITHMS = np.geomspace(1, 3000, 15)  # k of log(1 + k t), which never settles
_SETTLING = np.geomspace(6, 600, 30)  # exponential approaches that end within the record


def judge_record(
    times: Any, energies: Any, failed: bool = False, absolute: bool = True
) -> Judgement:
    """Judge as `_judge_record` does, in today's words."""
    judgement = _judge_record(times, energies, failed, absolute)
    rises = bool(energies[-1] > energies[0])
    return in_todays_words(judgement, rises, symplectic=False)


def _judge_record(times: Any, energies: Any, failed: bool, absolute: bool) -> Judgement:
    """Judge arrays of finite `energies` at increasing `times`; the slope has their units.

    `failed`: nan or inf came after the last of them.  `absolute`: zero is the least possible
    energy, so that an energy can be lost or multiplied.
    """
    if failed:
        return Judgement("failed")
    if len(times) < limits.MIN_SAMPLES:
        return _too_early(len(times), limits.MIN_SAMPLES, "samples")
    unit = float(np.abs(energies).max()) or 1.0
    energies = energies / unit  # squares must not overflow
    end = np.abs(energies[-(len(energies) // 4) :]).max()
    if absolute and end < limits.LOST * abs(energies[0]):
        return Judgement("loses" if energies[0] > 0 else "grows")
    rounding = max(_resolution(energies), limits.ROUNDING)
    first = _outliers(energies, rounding)
    record = _Record(times[first:], energies[first:], rounding)
    if transient := record.transient():
        first += transient
        record = _Record(times[first:], energies[first:], rounding)
    judgement = record.conclude()
    signed = np.sign(energies[0]) * energies[first:]
    multiplied = absolute and signed.max() > limits.MULTIPLIED * signed.min() > 0
    if multiplied and judgement.verdict not in ("grows", "loses"):
        logarithms = np.sign(energies[0]) * np.log(signed)
        judgement = _Record(times[first:], logarithms, limits.ROUNDING).conclude()
    scale = unit / float(times[-1] - times[first])
    return judgement._replace(
        slope=record.line.amplitude * scale,
        uncertainty=math.hypot(record.line.deviation, record.tilt) * scale,
        transient=float(times[first] - times[0]),
        first=first,
        independent=record.independent,
        fluctuation=float(np.std(record.residuals)) * unit,
    )


def _too_early(have: float, need: float, unit: str) -> Judgement:
    return Judgement("too early", progress=Progress(int(have), int(need), unit))


def _resolution(energies: Any) -> float:
    """Return the smallest difference of energies that repeat, as printed ones do; or rounding."""
    differences = np.diff(np.unique(energies))
    rounding = 8 * float(np.finfo(float).eps)
    differences = differences[differences > rounding]
    return float(differences.min()) if 0 < len(differences) < len(energies) / 2 else rounding


def _outliers(energies: Any, rounding: float) -> int:
    """Return how many samples to drop: up to the last early one that is far from the others.

    The others are those after the first tenth; "far" is half their band's width outside it.
    """
    early = int(len(energies) * limits.TRANSIENT)
    index = np.arange(len(energies))
    line = np.polyfit(index[early:], energies[early:], 1)
    residuals = energies - np.polyval(line, index)
    low = residuals[early:].min()
    high = residuals[early:].max()
    margin = max((high - low) / 2, rounding)
    outside = (residuals[:early] < low - margin) | (residuals[:early] > high + margin)
    return int(np.flatnonzero(outside).max(initial=-1)) + 1


class _Fit(NamedTuple):
    """A curve fitted with a level and perhaps a wave.  The likeliest fit compares as largest."""

    likelihood: float  # logarithm, with the most likely noise
    amplitude: float  # averaged over the noises
    deviation: float  # standard deviation of the amplitude
    walk_odds: float  # logarithm of the likelihood ratio of a random walk to noise about a level

    @property
    def sigmas(self) -> float:
        """The amplitude in standard deviations."""
        return abs(self.amplitude) / self.deviation


@cache
def _noises(count: int) -> tuple[Any, Any, Any]:
    """Return the cosine transform, and the correlation time and whitening factors of each noise.

    A whitening factor is one over the standard deviation of a cosine's term.
    """
    angles = np.pi * np.arange(count) / count
    cosines = np.cos(angles[:, None] * (np.arange(count) + 0.5)) * math.sqrt(2 / count)
    spectra = [np.ones(count - 1)]
    for time in _TIMES:
        # a first-order autoregression
        correlated = 1 / np.abs(1 - math.exp(-1 / (time * count)) * np.exp(1j * angles[1:])) ** 2
        spectra += [correlated + white for white in _WHITE]
    # the first cosine is constant: it belongs to the level
    whitening = np.insert(1 / np.sqrt(spectra), 0, 1.0, axis=1)
    return cosines, np.array([0.0, *np.repeat(_TIMES, len(_WHITE))]), whitening


class _Record:
    """The best curve of each kind through the means of blocks, over times from 0 to 1."""

    def __init__(self, times: Any, energies: Any, rounding: float) -> None:
        self._rounding = rounding
        self._is_constant = np.ptp(energies) <= 2 * rounding
        self._count = count = min(MAX_BINS, len(times) // 2)
        self._at = (times - times[0]) / (times[-1] - times[0])
        energies = energies - float(energies.mean())
        self._times = _block_means(self._at, count)
        self._means = _block_means(energies, count)
        self._base = np.ones((count, 1))  # the level, and perhaps the wave
        self._cycles = math.inf  # of the wave
        self._add_wave()
        self._fit_curves()
        self.residuals = energies - np.polyval(np.polyfit(self._at, energies, 1), self._at)
        error = max(self.line.deviation, rounding / len(times))
        # n independent samples give a slope the variance 12/n; they are two correlation times apart
        correlation_times = 24 * float(np.mean(self.residuals**2)) / error**2
        self.independent = min(float(len(self._at)), correlation_times)
        # the slope that an incomplete oscillation at the end gives to a line
        self.tilt = 12 * float(np.std(self.residuals)) / len(self._at)
        self._variance_within = max(float(np.mean(energies**2) - np.mean(self._means**2)), 0.0)

    def _fit_curves(self) -> None:
        """Fit every curve, and keep the line, the best moving and the best settled one."""
        times = self._times
        edge = max(2, self._count // 8)
        # blocks since each step; a step within a block moves its mean by a part
        since = np.arange(self._count) - np.arange(edge, self._count - edge, 0.25)[:, None] + 1
        moving = [
            times,
            *np.expm1(_RATES[:, None] * times) / np.expm1(_RATES)[:, None],
            *np.log1p(_LOGARITHMS[:, None] * times),
        ]
        settled = [*-np.expm1(-_SETTLING[:, None] * times), *np.clip(since, 0, 1)]
        fits = self._fits(moving + settled)
        self._level = self._fits([0 * times])[0]
        self.line = fits[0]
        self._moving = max(fits[: len(moving)])
        self._settled = max(fits[len(moving) :])
        # an approach has 1/20 of its way left; a step may be anywhere
        settled_at = [*(3 / _SETTLING), *np.ones(len(since))]
        self._settled_at = float(settled_at[fits.index(self._settled) - len(moving)])

    def _fits(self, curves: list[Any]) -> list[_Fit]:
        """Fit each curve together with the base, averaged over the noises by their likelihood."""
        _, noise_times, whitening = _noises(self._count)
        amplitudes, lengths, squares, base = self._least_squares(curves)
        determinants = 2 * np.log(whitening).sum(axis=1, keepdims=True)  # ln, of precision matrices
        likelihoods = (determinants - (self._count - 1) * np.log(squares)) / 2
        design = base + np.log(lengths)
        freedom = self._count - 1 - self._base.shape[1]
        restricted = (determinants - design - freedom * np.log(squares)) / 2
        weights = np.exp(restricted - restricted.max(axis=0))
        weights /= weights.sum(axis=0)
        walk = restricted[noise_times == _TIMES[0]].max(axis=0)
        level = restricted[noise_times <= _TIMES[1]].max(axis=0)
        by_curve = zip(
            likelihoods.max(axis=0),
            (weights * amplitudes).sum(axis=0),
            np.exp((weights * np.log(squares / freedom / lengths)).sum(axis=0) / 2),
            walk - level,
            strict=True,
        )
        return [_Fit(*map(float, values)) for values in by_curve]

    def _least_squares(self, curves: list[Any]) -> tuple[Any, Any, Any, Any]:
        """Fit each curve together with the base in every noise: arrays (noises, curves).

        Returns the curves' amplitudes, their squared lengths without what the base explains, the
        sums of squared residuals, and ln of the determinant of the base's normal matrix.
        """
        cosines, _, whitening = _noises(self._count)
        basis, triangles = np.linalg.qr(whitening[:, :, None] * (cosines @ self._base))
        columns = cosines @ np.column_stack([*curves, self._means])
        explained = (whitening[:, :, None] * basis).transpose(0, 2, 1) @ columns  # by the base
        products = whitening**2 @ (columns * columns[:, -1:])  # with the means
        products -= (explained * explained[:, :, -1:]).sum(axis=1)
        lengths = whitening**2 @ columns**2 - (explained**2).sum(axis=1)
        lengths = np.maximum(lengths[:, :-1], 1e-15)
        amplitudes = products[:, :-1] / lengths
        squares = np.maximum(products[:, -1:] - amplitudes**2 * lengths, 0)
        # rounding has the variance r²/12; the mean of a block errs by a tenth of what a value does
        squares += self._count * self._rounding**2 / 12 / 100
        diagonals = np.abs(np.diagonal(triangles, axis1=1, axis2=2))
        return amplitudes, lengths, squares, 2 * np.log(diagonals).sum(axis=1, keepdims=True)

    def _add_wave(self) -> None:
        """Add a cosine and a sine to the base if they stand out from every noise."""
        without = self._fits([self._times])[0].likelihood
        cycles = self._best_cycles(np.arange(1.25, self._count / 2, 0.25))
        cycles = self._best_cycles(cycles + np.linspace(-0.25, 0.25, 51))
        angles = math.tau * cycles * self._times
        base = self._base
        self._base = np.column_stack([base, np.cos(angles), np.sin(angles)])
        gain = self._fits([self._times])[0].likelihood - without
        # the Bayesian information criterion asks 1.5 ln n for three parameters
        if gain < 1.5 * math.log(self._count) + limits.WAVE_GAIN:
            self._base = base
        else:
            self._cycles = cycles

    def _best_cycles(self, cycles: Any) -> float:
        """Return the cycles of the wave that explains most besides the base and a line."""
        basis = np.linalg.qr(np.column_stack([self._base, self._times]))[0]
        angles = math.tau * cycles[:, None] * self._times
        waves = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        waves = np.linalg.qr(waves - basis @ (basis.T @ waves))[0]
        residuals = self._means - basis @ (basis.T @ self._means)
        return float(cycles[np.argmax(((residuals @ waves) ** 2).sum(axis=1))])

    @property
    def _widens(self) -> bool:
        """Whether it fluctuates more from quarter to quarter, and far more at the end."""
        sizes = [float(np.abs(part).mean()) for part in np.array_split(self.residuals, 4)]
        far_more = sizes[-1] > limits.WIDENING * (sizes[0] + self._rounding)
        return far_more and sizes == sorted(sizes)

    @property
    def _has_settled(self) -> bool:
        """Whether a settled curve is far likelier than any that moves, and leaves the band."""
        likelier = self._settled.likelihood - self._moving.likelihood > limits.ODDS
        return likelier and self._settled.amplitude**2 > self._variance_within

    def transient(self) -> int:
        """Return how many samples at the start approach a level, if that is over early."""
        if not self._has_settled or self._settled_at > limits.TRANSIENT:
            return 0
        size = abs(self._settled.amplitude) / max(math.sqrt(self._variance_within), self._rounding)
        # until the approach has sunk into the noise: 3 to 6 of its time constants
        end = self._settled_at / 3 * min(max(math.log(size) + 1, 3.0), 6.0)
        return int(np.searchsorted(self._at, end))

    def conclude(self) -> Judgement:
        """Return the verdict that the best curves of each kind allow."""
        few = self.independent < limits.MIN_INDEPENDENT or self._cycles < limits.MIN_CYCLES
        min_sigmas = limits.CURVE_SIGMAS_OF_FEW if few else limits.TREND_SIGMAS
        if self._is_constant:
            return Judgement("bounded")
        if self._has_settled and self._settled.sigmas > min_sigmas:
            return Judgement("caught")
        rise = self.line.amplitude
        small = abs(rise) < max(2 * self._rounding, self.tilt)
        level = small or self.line.sigmas < limits.LEVEL_SIGMAS
        # a curve has more freedom than a line, so its likelihood must exceed the others' by more
        likeliest = max(self.line.likelihood, self._moving.likelihood - 2 * limits.ODDS)
        moves = likeliest > self._settled.likelihood - limits.ODDS
        clear = self.line.sigmas > limits.LINE_SIGMAS_OF_FEW or self._moving.sigmas > min_sigmas
        if moves and clear and not level:
            return Judgement("grows" if rise > 0 else "loses")
        if level and not few:
            return Judgement("wanders" if self._widens else "bounded")
        walks = self._level.walk_odds > limits.WALK_ODDS and math.isinf(self._cycles)
        if walks and self.line.sigmas < limits.TREND_SIGMAS:
            return Judgement("wanders")
        if self._cycles < limits.MIN_CYCLES:
            return _too_early(self._cycles, limits.MIN_CYCLES, "cycles of its wave")
        need = max(limits.MIN_INDEPENDENT, 2 * self.independent)
        return _too_early(self.independent, need, "independent samples")


def _block_means(values: Any, count: int) -> Any:
    """Return the means of `count` blocks of equally many values."""
    ends = np.arange(count) * len(values) // count
    return np.add.reduceat(values, ends) / np.diff(ends, append=len(values))
