"""Least squares where noise is correlated: lines, curves and waves through the means of blocks.

The noise may have any correlation time, from none to that of a random walk, with white noise on
top.  Likelihoods are averaged over a grid of such noises (generalised least squares with restricted
maximum likelihood: Harville, J. Am. Stat. Assoc. 72 (1977) 320), so the uncertainty of a slope
holds for correlated values, too.
"""

import math
from typing import Any, NamedTuple

import numpy as np

TIMES = 1 / np.array([0.5, 2, 7, 14, 28, 64])  # correlation times, of the record
WHITE = np.array([0.0, 1, 10, 100, 1000])  # variance of white noise, in mean squares of the steps
WALK_TIME = 1.9  # of the record: from here on noise looks like a random walk
LEVEL_TIME = 0.21  # of the record: up to here noise comes back to its level
MAX_WAVES = 3
MIN_WAVE = 1.1  # cycles: the search ends at 1, where curves end up


class Fit(NamedTuple):
    """One description fitted: its likelihood, and the amplitude of its last regressor."""

    likelihood: float  # logarithm, of the best noise
    amplitude: float  # averaged over the noises
    deviation: float
    walks: float  # logarithm of the likelihood ratio of a random walk and of noise about a level

    @property
    def sigmas(self) -> float:
        """The amplitude in its standard deviations."""
        return abs(self.amplitude) / self.deviation


class Noises:
    """The noises, as matrices that make each of them white."""

    def __init__(self, places: Any, sizes: Any, count: int, rounding: float) -> None:
        """Make the noises of blocks at some of `count` places; `rounding` is that of a value."""
        lags = np.abs(places[:, None] - places[None, :]) / count
        white = np.diag(sizes.mean() / sizes)
        matrices = [white]
        for time in TIMES:
            noise, step = _covariance(lags, time, 1 / count)
            matrices += [noise / step + share * white for share in WHITE]
        roots = np.linalg.cholesky(np.array(matrices))
        self.times = np.concatenate([[0.0], np.repeat(TIMES, len(WHITE))])
        self._rounding = len(places) * rounding**2 / 12
        self._whiten = np.linalg.inv(roots)
        self._log_determinants = 2 * np.log(np.diagonal(roots, axis1=1, axis2=2)).sum(axis=1)

    def fit(self, regressors: list[Any], means: Any) -> Fit:
        """Fit the means by regressors with every noise."""
        freedom = len(means) - len(regressors)
        columns = self._whiten @ np.column_stack([*regressors, means])
        products = columns.transpose(0, 2, 1) @ columns
        inverse = np.linalg.inv(products[:, :-1, :-1])
        amplitudes = (inverse @ products[:, :-1, -1:])[..., 0]
        explained = (amplitudes * products[:, :-1, -1]).sum(axis=1)
        squares = np.maximum(products[:, -1, -1] - explained, 0) + self._rounding
        whole = -(self._log_determinants + len(means) * np.log(squares)) / 2
        design = np.linalg.slogdet(products[:, :-1, :-1])[1]
        restricted = -(self._log_determinants + design + freedom * np.log(squares)) / 2
        weights = np.exp(restricted - restricted.max())
        weights /= weights.sum()
        deviations = np.sqrt(squares / freedom * np.maximum(inverse[:, -1, -1], 0))
        walk = restricted[self.times >= WALK_TIME].max()
        level = restricted[self.times <= LEVEL_TIME].max()
        return Fit(
            likelihood=float(whole.max()),
            amplitude=float(weights @ amplitudes[:, -1]),
            deviation=math.exp(float(weights @ np.log(deviations))),
            walks=float(walk - level),
        )


def _covariance(lags: Any, time: float, width: float) -> tuple[Any, float]:
    """Return the covariance of block means of noise with a correlation time, and of their steps."""
    blocks = width / time
    noise = np.exp(-lags / time) * (math.sinh(blocks / 2) / (blocks / 2)) ** 2
    next_one = math.exp(-blocks) * (math.sinh(blocks / 2) / (blocks / 2)) ** 2
    np.fill_diagonal(noise, 2 * (blocks - 1 + math.exp(-blocks)) / blocks**2)
    return noise, 2 * (float(noise[0, 0]) - next_one)


def regressors(frequencies: list[float], times: Any) -> list[Any]:
    """Return cosine and sine of each frequency [cycles in the record]."""
    angles = [math.tau * frequency * times for frequency in frequencies]
    return [wave for angle in angles for wave in (np.cos(angle), np.sin(angle))]


def waves(times: Any, means: Any) -> list[float]:
    """Return the frequencies of waves about a line that stand out of white noise."""
    found: list[float] = []
    grid = np.arange(1, len(times) / 2, 0.25)  # a line and less than a cycle look alike
    penalty = 3 * math.log(len(times)) + 6  # of three parameters, and of the search
    while len(found) < MAX_WAVES:
        base = [np.ones(len(times)), times, *regressors(found, times)]
        basis = np.linalg.qr(np.column_stack(base))[0]
        rest = means - basis @ (basis.T @ means)
        before = float(rest @ rest)
        if before < 1e-20 * float(means @ means):
            break
        gains = _gains(grid, times, basis, rest)
        best = float(grid[np.argmax(gains)])
        for width in (0.25, 0.05, 0.01):
            near = np.maximum(best + width * np.linspace(-1, 1, 11), 1.0)
            gains = _gains(near, times, basis, rest)
            best = float(near[np.argmax(gains)])
        after = max(before - float(gains.max()), 1e-12 * before)
        apart = min((abs(best - other) for other in found), default=1.0)
        if len(times) * math.log(before / after) < 2 * penalty or best < MIN_WAVE or apart < 0.75:
            break
        found.append(best)
    return found


def _gains(frequencies: Any, times: Any, basis: Any, rest: Any) -> Any:
    """Return how much of the rest a wave of each frequency explains, in squares."""
    angles = math.tau * np.asarray(frequencies)[:, None] * times
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
    return (others * first**2 - 2 * mixed * first * second + squares * second**2) / determinant
