"""The slope of binned numbers in a noise of unknown colour.

The bins' orthonormal cosine transform has nearly all of a line in its first term, and a noise's
terms are independent, with its spectrum as variances.  A model of the noise is a shape s of the
spectrum up to an edge q; each octave beyond has a variance of its own, so waves, beats and digits,
which live there, never pretend a slope.  Given a model, a slope with a flat prior is Student's t
with q - 1 degrees of freedom; models are averaged by their marginal likelihoods.  Müller & Watson,
Econometrica 76 (2008) 979; Lazarus, Lewis, Stock & Watson, J. Bus. Econ. Stat. 36 (2018) 541.

Sums are in a fixed order, without BLAS, so results have the same bits wherever `log` has.
"""

import math
from functools import cache, cached_property
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.run import levels

_EDGES = (7, 15, 31)  # and the last term
_KNEES = (7, 15, 31)  # of 1/(1 + (j/k)²): correlation times of a 22nd, 47th and 97th of the record
_PINK_PRIOR = 0.3  # of 1/j, which few integrators make; other shapes have 1
_OCTAVE = math.log(2 * math.log(1000))  # the cost of a variance: a flat prior of its logarithm
_KNOWN = 60  # degrees of freedom of a known variance: as good as endless
_HALVINGS = 10  # of an interval that holds a quantile: to a thousandth of its size
_NEGLIGIBLE = 1e-7  # weight of a model


class _Models(NamedTuple):
    """The models of a noise in n bins, one a row."""

    cosines: Any  # (n - 1, n)
    inverse: Any  # 1/s, 0 beyond the edge: (models, n - 1)
    freedoms: Any  # (models,)
    priors: Any  # ln of the prior and of what depends on the model alone
    octaves: Any  # ones in each octave beyond the edge: (models, octaves, n - 1)
    walks: Any  # whether the variance has no limit


@cache
def _models(count: int) -> _Models:
    angles = np.pi * np.arange(1, count) / count
    cosines = np.cos(angles[:, None] * (np.arange(count) + 0.5)) * math.sqrt(2 / count)
    j = np.arange(1.0, count)
    digits = np.frexp(j)[1]  # binary ones of j: the same within an octave
    shapes = [1 + 0 * j, *(1 / (1 + (j / knee) ** 2) for knee in _KNEES), 1 / j, 1 / j**2]
    weights = [1.0] * (1 + len(_KNEES)) + [_PINK_PRIOR, 1.0]
    rows = []
    for edge in dict.fromkeys(min(edge, count - 1) for edge in (*_EDGES, count - 1)):
        octaves = (digits == np.arange(4, 7)[:, None]) & (j > edge)
        prior = math.lgamma((edge - 1) / 2) + math.log((edge + 1) / 2)
        prior -= (edge - 1) / 2 * math.log(math.pi)
        for size in filter(None, octaves.sum(axis=1).tolist()):
            prior += math.lgamma(size / 2) - size / 2 * math.log(math.pi) - _OCTAVE
        for shape, weight in zip(shapes, weights, strict=True):
            inverse = np.where(j <= edge, 1 / shape, 0.0)
            total = prior - np.log(shape[:edge]).sum() / 2 + math.log(weight)
            rows.append((inverse, edge - 1, total, octaves, shape is shapes[-1]))
    return _Models(cosines, *map(np.array, zip(*rows, strict=True)))


def _white_model(v: Any, x: Any, white: float) -> tuple[Any, ...]:
    """Return the slope's distribution if the noise is white, with a known standard deviation."""
    square = (v * v).sum()
    centre = (v * x).sum() / square
    misfit = ((x - centre * v) ** 2).sum() / white**2
    log = _OCTAVE + math.log((len(x) + 1) / 2) - math.log(square) / 2
    log -= ((len(x) - 1) * math.log(math.tau * white**2) + misfit) / 2
    return centre, white / math.sqrt(square), _KNOWN, False, log


class Slope:
    """The slope of four or more values: a mixture of Student's t, one for each noise model."""

    def __init__(self, times: Any, values: Any, rounding: float, white: float = 0.0) -> None:
        """Each value is rounded to `rounding`.

        `white`: the values' standard deviation if they are means of independent samples, which is
        one more model.
        """
        models = _models(len(values))
        v = (models.cosines * times).sum(axis=1)
        x = (models.cosines * values).sum(axis=1)
        squares = (models.inverse * v * v).sum(axis=1)
        centres = (models.inverse * v * x).sum(axis=1) / squares
        rest = (x - centres[:, None] * v) ** 2 + max(rounding, 1e-150) ** 2 / 12
        residual = (models.inverse * rest).sum(axis=1)
        sums = (models.octaves * rest[:, None, :]).sum(axis=2)
        sizes = models.octaves.sum(axis=2)
        log_sums = np.log(np.where(sizes > 0, sums, 1.0))
        log = models.priors - models.freedoms / 2 * np.log(residual) - np.log(squares) / 2
        log = log - (sizes / 2 * log_sums).sum(axis=1)
        deviations = np.sqrt(residual / models.freedoms / squares)
        table = np.stack((centres, deviations, models.freedoms, models.walks, log))
        if white > 0:
            table = np.column_stack((table, _white_model(v, x, white)))
        centres, deviations, freedoms, walks, log = table
        weights = np.exp(log - log.max())
        weights = weights / weights.sum()
        self.mean = float((weights * centres).sum())
        self.uncertainty = float((weights * deviations).sum())  # 68 % lie within
        self.walk = weights[walks > 0].sum()  # probability of an endless variance
        parts = np.column_stack((centres, deviations, freedoms, weights))
        self._parts = parts[weights > _NEGLIGIBLE].tolist()

    def below(self, slope: float) -> float:
        """Return the probability of a smaller slope."""
        total = 0.0
        for centre, deviation, freedom, weight in self._parts:
            total += weight * student(slope - centre, deviation, freedom)
        return total

    @cached_property
    def chance(self) -> float:
        """The probability of so large a slope of either sign by chance."""
        below = self.below(0.0)
        return 2 * min(below, 1 - below)

    @cached_property
    def bound(self) -> float:
        """|slope| is below it with a probability of levels.CERTAIN."""
        high = abs(self.mean) + self.uncertainty
        while not self._is_within(high) and math.isfinite(high):
            high *= 2
        low = 0.0
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            if self._is_within(middle):
                high = middle
            else:
                low = middle
        return high

    def _is_within(self, size: float) -> bool:
        return self.below(size) - self.below(-size) >= levels.CERTAIN


def student(distance: float, deviation: float, freedom: float) -> float:
    """Return the distribution function of Student's t at a distance from its centre.

    Wallace, Ann. Math. Statist. 30 (1959) 1121, converts t to a normal deviate, to 2 % from 6
    degrees of freedom on; with fewer, chances come out too large.
    """
    t = distance / deviation
    size = math.sqrt(freedom * math.log1p(t * t / freedom))
    normal = math.copysign((8 * freedom + 1) / (8 * freedom + 3) * size, t)
    return math.erfc(-normal / math.sqrt(2)) / 2
