"""The pendulum's own stability: which swings a method holds, for how long, and how it loses them.

A swing starts at rest at an amplitude theta and depends on z = h·w0 only, so everything here is
computed with w0 = 1 and h = z.  It is lost when it goes over the top or its energy leaves the band.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.methods import Method
from engine.models.pendulum import acceleration, energy
from engine.models.state import Number
from engine.stability.chaos import is_chaotic
from engine.stability.linear import energy_range

BAND = 0.5
"""How far, as a fraction, energy may go above the highest and below the lowest that the method's own
bounded wobble on the linear oscillator takes it to (engine.stability.linear.wobble)."""

FATES = ("holds", "over the top", "grows", "loses")
"""What becomes of a swing: it stays, |theta| passes pi, its energy leaves the band upwards or downwards."""

HOLDS, OVER_THE_TOP, GROWS, LOSES = range(len(FATES))
UNKNOWN = 255  # the fate of a cell that was not computed

CELL = np.dtype([("steps", "<i4"), ("error", "<f8"), ("fate", "u1")])
"""Steps survived; largest relative energy error |E - E0|/E0 up to the step that lost the swing; index into FATES."""

Floats = NDArray[np.float64]
Cells = NDArray[Any]  # of CELL


def outcomes(method: Method, theta: Floats, z: Floats, steps: int) -> Cells:
    """What becomes of each of many swings within `steps` steps.

    theta [rad], between 0 and pi, and z are one-dimensional and of one length; the answer is a CELL
    for each.  A swing that is lost leaves the ensemble at once.  No cell depends on the others.
    """
    force = acceleration(1.0, np.sin)
    h: Number = z
    distinct, where = np.unique(z, return_inverse=True)
    lowest, highest = np.array([energy_range(method.step, value) for value in distinct.tolist()]).T
    phase: tuple[Floats, Floats] = (theta, np.zeros(len(theta)))
    start: Floats = energy(1.0, *phase, np.sin)
    floor = (1 - BAND) * lowest[where] * start
    ceiling = (1 + BAND) * highest[where] * start
    worst = np.zeros(len(theta))
    index = np.arange(len(theta))
    cells = np.zeros(len(theta), CELL)
    cells["steps"] = steps
    for step in range(steps):
        phase = method.step(force, phase, h)
        value = energy(1.0, *phase, np.sin)
        np.maximum(worst, np.abs(value - start), out=worst)
        over, above = np.abs(phase[0]) > math.pi, value > ceiling
        lost = over | above | (value < floor)
        if lost.any():
            gone = index[lost]
            cells["steps"][gone] = step
            cells["error"][gone] = worst[lost] / start[lost]
            cells["fate"][gone] = np.where(over, OVER_THE_TOP, np.where(above, GROWS, LOSES))[lost]
            kept = ~lost
            phase = (phase[0][kept], phase[1][kept])
            index, h, start, floor, ceiling, worst = (a[kept] for a in (index, h, start, floor, ceiling, worst))
            if not len(index):
                break
    cells["error"][index] = worst / start
    return cells


@dataclass(frozen=True, slots=True)
class Failure:
    """The smallest z tried at which a method loses the swing."""

    z: float
    steps: int  # survived
    reason: str  # over the top | grows | loses | resonance | chaotic


def first_failure(method: Method, theta: float, z: Floats, cells: Cells) -> Failure | None:
    """The first failure of the swing from theta [rad] on an ascending ladder of z; None if it holds on all of it.

    `cells` are the outcomes on the ladder.  There is no bisection: above the first failure there
    are windows of z where the swing is bounded again.
    """
    lost = np.flatnonzero(cells["fate"] != HOLDS)
    if not len(lost):
        return None
    cell, first = cells[lost[0]], float(z[lost[0]])
    return Failure(first, int(cell["steps"]), reason(method, theta, first, int(cell["fate"])))


def reason(method: Method, theta: float, z: float, fate: int, steps: int = 10_000) -> str:
    """Why the swing from theta [rad] is lost at z; its fate, but for a symplectic method below its linear limit.

    There energy neither grows nor falls for good: the orbit is chaotic, or it is regular and a
    resonance of step and swing carries it out of the band.  Which of the two, `steps` steps tell.
    """
    if fate in (GROWS, LOSES) and method.symplectic and z < method.linear_limit:
        return "chaotic" if is_chaotic(method.step, theta, z, steps) else "resonance"
    return FATES[fate]
