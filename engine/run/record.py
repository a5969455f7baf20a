"""Judge the record of any program from times and energies alone."""

from typing import Any

import numpy as np

from pendu_tui.engine.run import levels
from pendu_tui.engine.run.core import Bins, judge_bins
from pendu_tui.engine.run.verdicts import FAILED, Judgement


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
    scaled = energies / unit  # squares must not overflow
    bins = bins_of(times, scaled - scaled[0], max(resolution(scaled), levels.ROUNDING))
    judgement = judge_bins(bins).scaled(unit)
    return judgement._replace(independent=min(judgement.independent, float(len(times))))


def bins_of(times: Any, energies: Any, rounding: float) -> Bins:
    """Return blocks of equally many samples."""
    count = min(levels.MAX_BINS, len(times) // 4 * 2)
    begins = np.arange(count) * len(times) // count
    sizes = np.diff(begins, append=len(times))
    means = np.add.reduceat(energies, begins) / sizes
    squares = np.add.reduceat((energies - np.repeat(means, sizes)) ** 2, begins) / sizes
    return Bins(
        np.add.reduceat(times - times[0], begins) / sizes,
        means,
        np.minimum.reduceat(energies, begins),
        np.maximum.reduceat(energies, begins),
        np.sqrt(squares),
        rounding,
        sizes,
    )


def resolution(energies: Any) -> float:
    """Return the smallest difference of energies that repeat, as printed ones do; or rounding."""
    some = energies[:: len(energies) // 10_000 + 1]
    differences = np.diff(np.unique(some))
    rounding = 8 * float(np.finfo(float).eps)
    differences = differences[differences > rounding]
    return float(differences.min()) if 0 < len(differences) < len(some) / 2 else rounding
