"""Least squares where noise is correlated: lines, curves and steps through the means of blocks.

The cosine transform of stationary noise has independent terms, whose variances are the spectrum
(Whittle, J. R. Stat. Soc. B 15 (1953) 125).  The noise may have any correlation time, from none to
that of a random walk, and white noise on top.  Likelihoods are averaged over a grid of such spectra
(restricted maximum likelihood: Harville, J. Am. Stat. Assoc. 72 (1977) 320), so the uncertainty of
a slope holds for correlated values, too.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from engine.run import judgement as limits

# correlation times, of the record: the first looks like a walk, the others like a level
TIMES = 1 / np.array([0.5, 5, 10, 20, 40, 80])
WHITE = np.array([0.0, 1, 10, 100, 1000])  # variance of white noise, in that of the kicks
MAX_WAVES = 3


class Fit(NamedTuple):
    """One description fitted: its likelihood, and the amplitude of its last regressor."""

    likelihood: float  # logarithm, of the best noise
    walks: float  # logarithm of the likelihood ratio of a random walk and of noise about a level
    amplitude: float = 0.0  # averaged over the noises
    deviation: float = 1.0

    @property
    def sigmas(self) -> float:
        """The amplitude in its standard deviations."""
        return abs(self.amplitude) / self.deviation


class Noises:
    """A grid of noises of `count` blocks."""

    def __init__(self, count: int, rounding: float) -> None:
        """Make them; `rounding` is that of a value."""
        self.cycles = math.inf  # of the slowest wave found
        angles = np.pi * np.arange(count) / count
        cosines = np.cos(angles[:, None] * (np.arange(count) + 0.5)) * math.sqrt(2 / count)
        self._cosines = cosines[1:]  # the first is the level
        turns = np.exp(1j * angles[1:])
        spectra = [np.ones(count - 1)]
        for time in TIMES:
            kicked = 1 / np.abs(1 - math.exp(-1 / (time * count)) * turns) ** 2
            spectra += [kicked + share for share in WHITE]
        self._times = np.concatenate([[0.0], np.repeat(TIMES, len(WHITE))])
        self._weights = 1 / np.array(spectra)
        self._log_determinants = -np.log(self._weights).sum(axis=1)
        # means of values that are rounded apart err by a tenth of what one value does
        self._rounding = count * rounding**2 / 12 / 100

    def fit(self, regressors: list[Any], means: Any) -> Fit:
        """Fit the means, about their level, by regressors with every noise."""
        columns = self._cosines @ np.column_stack([*regressors, means])
        size = columns.shape[1]
        pairs = columns[:, :, None] * columns[:, None, :]
        products = (self._weights @ pairs.reshape(len(columns), -1)).reshape(-1, size, size)
        inverse = np.linalg.inv(products[:, :-1, :-1])
        amplitudes = (inverse @ products[:, :-1, -1:])[..., 0]
        explained = (amplitudes * products[:, :-1, -1]).sum(axis=1)
        squares = np.maximum(products[:, -1, -1] - explained, 0) + self._rounding
        whole = -(self._log_determinants + len(columns) * np.log(squares)) / 2
        design = np.linalg.slogdet(products[:, :-1, :-1])[1]
        freedom = len(columns) - len(regressors)
        restricted = -(self._log_determinants + design + freedom * np.log(squares)) / 2
        walk = restricted[self._times == TIMES[0]].max()
        level = restricted[self._times <= TIMES[1]].max()
        fit = Fit(likelihood=float(whole.max()), walks=float(walk - level))
        if not regressors:
            return fit
        weights = np.exp(restricted - restricted.max())
        weights /= weights.sum()
        deviations = np.sqrt(squares / freedom * np.maximum(inverse[:, -1, -1], 1e-300))
        return fit._replace(
            amplitude=float(weights @ amplitudes[:, -1]),
            deviation=math.exp(float(weights @ np.log(deviations))),
        )

    def waves(self, times: Any, means: Any) -> list[Any]:
        """Return cosines and sines that stand out of every noise, as regressors."""
        found: list[Any] = []
        before = self.fit([times], means).likelihood
        while len(found) < 2 * MAX_WAVES:
            basis = np.linalg.qr(np.column_stack([np.ones(len(times)), times, *found]))[0]
            rest = means - basis @ (basis.T @ means)
            cycles = np.arange(1.25, len(times) / 2, 0.25)
            best = _best_wave(cycles, times, basis, rest)
            best = _best_wave(best + np.linspace(-0.25, 0.25, 51), times, basis, rest)
            angles = math.tau * best * times
            wave = [np.cos(angles), np.sin(angles)]
            after = self.fit([*found, *wave, times], means).likelihood
            if after - before < 1.5 * math.log(len(times)) + limits.WAVE:
                break
            self.cycles = min(self.cycles, best)
            found += wave
            before = after
        return found


def _best_wave(cycles: Any, times: Any, basis: Any, rest: Any) -> float:
    """Return the cycles of the wave that explains most of the rest, in squares."""
    angles = math.tau * cycles[:, None] * times
    cosines = np.cos(angles)
    sines = np.sin(angles)
    cosines = cosines - (cosines @ basis) @ basis.T
    sines = sines - (sines @ basis) @ basis.T
    first = cosines @ rest
    second = sines @ rest
    squares = (cosines**2).sum(axis=1)
    others = (sines**2).sum(axis=1)
    mixed = (cosines * sines).sum(axis=1)
    determinant = np.maximum(squares * others - mixed**2, 1e-6 * squares * others)
    gains = others * first**2 - 2 * mixed * first * second + squares * second**2
    return float(cycles[np.argmax(gains / determinant)])
