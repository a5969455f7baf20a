"""What the times and energies of any program tell: a verdict, and an order of its method.

A symplectic method of order p makes the energy fluctuate by an amount that goes as h^p; a force
that is one step old, a forgotten half kick or a thermostat does not.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.run import levels
from pendu_tui.engine.run.core import Bins, judge_bins
from pendu_tui.engine.run.verdicts import FAILED, Judgement

BATCHES = 16  # a quarter of the fewest samples: each has a mean of its own


def judge_record(times: Any, energies: Any, failed: bool = False) -> Judgement:
    """Judge arrays of finite `energies` at increasing `times`; slopes have their units.

    `failed`: nan or inf came after the last of them.  Nothing depends on the zero of energy.
    """
    if failed:
        return Judgement(FAILED)
    if len(times) < levels.MIN_SAMPLES:
        reason = levels.FEW.format(need=levels.MIN_SAMPLES)
        return Judgement(reason=reason, independent=float(len(times)))
    unit = float(np.abs(energies).max()) or 1.0
    scaled = energies / unit  # differences must not overflow
    bins = bins_of(times, scaled - scaled[0], max(resolution(scaled), levels.ROUNDING))
    judgement = judge_bins(bins).scaled(unit)
    return judgement._replace(independent=min(judgement.independent, float(len(times))))


def bins_of(times: Any, energies: Any, rounding: float) -> Bins:
    """Return blocks of equally many samples; of equal time, if those would last unequally long."""
    count = min(levels.MAX_BINS, len(times) // 4 * 2)
    begins = np.arange(count) * len(times) // count
    lengths = np.diff(times[begins], append=times[-1])
    if lengths.max() > levels.UNEVEN * lengths.min():
        begins = _begins_in_time(times, begins)
    sizes = np.diff(begins, append=len(times))
    means = np.add.reduceat(energies, begins) / sizes
    squares = np.add.reduceat((energies - np.repeat(means, sizes)) ** 2, begins) / sizes
    return Bins(
        times=np.add.reduceat(times - times[0], begins) / sizes,
        means=means,
        lows=np.minimum.reduceat(energies, begins),
        highs=np.maximum.reduceat(energies, begins),
        spreads=np.sqrt(squares),
        rounding=rounding,
        white=math.sqrt((squares / (sizes - 1)).mean()),
    )


def _begins_in_time(times: Any, default: Any) -> Any:
    """Return where blocks of equal time and two or more samples begin, if they are not too few."""
    begins = [0]
    edges = np.linspace(times[0], times[-1], len(default) + 1)
    for begin in np.searchsorted(times, edges).tolist():
        if begins[-1] + 2 <= begin <= len(times) - 2:
            begins.append(begin)
    return default if len(begins) < len(default) / 4 else np.array(begins)


def resolution(energies: Any) -> float:
    """Return the smallest difference of energies that repeat, as printed ones do; or rounding."""
    rounding = 8 * math.ulp(1.0)
    differences = np.diff(np.unique(energies))
    differences = differences[differences > rounding]
    jumps = (np.abs(np.diff(energies)) > rounding).sum()
    repeat = 0 < len(differences) < len(energies) / 2
    are_digits = repeat and (jumps >= levels.MIN_JUMPS or jumps == len(differences))
    return float(differences.min()) if are_digits else rounding


class Fluctuation(NamedTuple):
    """The standard deviation of energies about a line, with its standard error, in their unit."""

    size: float
    uncertainty: float


class Order(NamedTuple):
    """The power of the step size with which a fluctuation scales, with its standard error."""

    power: float
    uncertainty: float

    @property
    def highest(self) -> float | None:
        """The highest power that the runs allow; None: they allow more than one order."""
        if 2 * self.uncertainty >= 1:
            return None
        return self.power + 2 * self.uncertainty

    @property
    def doubt(self) -> str:
        """A sentence for an order without a highest power, and how long the runs should be."""
        longer = math.ceil((2 * self.uncertainty) ** 2 + 1)
        why = f"runs about {longer} times as long would distinguish one order from the next"
        return f"cannot tell: the energy fluctuates as {self}; {why}"

    def __str__(self) -> str:
        return f"h^({self.power:.2f} ± {self.uncertainty:.2f})"


def fluctuation(times: Any, energies: Any) -> Fluctuation:
    """Return how far energies fluctuate about the line through them.

    The uncertainty is that of batch means: Flegal & Jones, Annals of Statistics 38 (2010) 1034.
    It is right if a batch, a sixteenth of the record, is longer than the energy remembers.  Raises
    ValueError for fewer than levels.MIN_SAMPLES samples.
    """
    if len(energies) < levels.MIN_SAMPLES:
        raise ValueError(
            f"{len(energies)} energies are too few; give {levels.MIN_SAMPLES} or more."
        )
    t = (times - times.mean()) / (times[-1] - times[0])
    largest = float(np.abs(energies).max()) or 1.0
    e = energies / largest
    e = e - e.mean()
    e = e - t * (t @ e) / (t @ t)
    squares = np.array([batch.mean() for batch in np.array_split(e * e, BATCHES)])
    error = float(squares.std(ddof=1)) / math.sqrt(BATCHES)
    size = math.sqrt(squares.mean())
    return Fluctuation(largest * size, largest * error / (2 * size) if size else 0.0)


def order_of(steps: Sequence[float], fluctuations: Sequence[Fluctuation]) -> Order:
    """Return the slope of log fluctuation over log step, weighted by the uncertainties.

    Raises ValueError unless two step sizes differ and each has a fluctuation above zero.
    """
    if len(set(steps)) < 2 or min(steps) <= 0:
        raise ValueError("give two or more step sizes, all above zero and not all the same.")
    if len(fluctuations) != len(steps):
        raise ValueError("give one fluctuation for each step size.")
    if not all(each.size > 0 for each in fluctuations):
        raise ValueError("an energy that never changes has no order.")
    sizes, uncertainties = np.array(fluctuations).T
    weights = 1 / np.maximum(uncertainties / sizes, 1e-12)
    (power, _), covariance = np.polyfit(np.log(steps), np.log(sizes), 1, w=weights, cov="unscaled")
    return Order(float(power), math.sqrt(covariance[0, 0]))
