"""Which swings of the pendulum a method holds, for how long, and how it loses them.

A swing starts at rest at an amplitude theta and depends on z = h·w0 only; here w0 = 1 and h = z.
engine.stability.LOST says when a swing is lost.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models import Pendulum
from pendu_tui.engine.run import verdicts
from pendu_tui.engine.run.ensemble import Floats as Floats
from pendu_tui.engine.run.ensemble import Watched, compiled, plain
from pendu_tui.engine.stability import BAND
from pendu_tui.engine.stability.chaos import is_chaotic
from pendu_tui.engine.stability.linear import wobble

PARKED = 1 / 8  # share of an ensemble's swings: when so many are lost, it goes on without them

FATES = (
    *("holds", "over the top", verdicts.GROWS, verdicts.LOSES),
    *("holds, wobbling", "holds elsewhere", verdicts.CHAOTIC),
)
"""What becomes of a swing: it swings as wide as it should; |theta| passes pi; its energy leaves the
band upwards or downwards; it stays, but swings wider; it stays beyond a symplectic method's linear
limit, as around the two places between which velocity Verlet then jumps; neighbouring swings
separate exponentially.
"""

HOLDS, OVER_THE_TOP, GROWS, LOSES, WOBBLES, ELSEWHERE, CHAOTIC = range(len(FATES))
HELD = (HOLDS, WOBBLES, ELSEWHERE)
UNKNOWN = 255  # not computed

CELL = np.dtype([("steps", "<i4"), ("error", "<f8"), ("fate", "u1")])
"""Steps survived, largest relative energy error before the swing was lost, index into FATES."""

Cells = NDArray[Any]  # of CELL


def is_lost(cells: Cells) -> NDArray[np.bool_]:
    """Return which swings a method loses; UNKNOWN cells do not count."""
    return ~np.isin(cells["fate"], (*HELD, UNKNOWN))


def _bounds(method: Method, theta: Floats, z: Floats, start: Floats) -> tuple[Floats, ...]:
    """Return how far a held swing's energy may rise and fall, and theta's largest value [rad]."""
    distinct, where = np.unique(z, return_inverse=True)
    wobbles = np.array([wobble(method, value) for value in distinct.tolist()]).T
    lowest, highest, widest = wobbles[:, where]
    up = ((1 + BAND) * highest - 1) * start
    down = (1 - (1 - BAND) * lowest) * start
    if method.symplectic:
        up[:] = down[:] = math.inf  # its energy comes back
    return up, down, widest * theta


@np.errstate(all="ignore")  # lost swings may overflow
def outcomes(method: Method, theta: Floats, z: Floats, steps: int, fast: bool = False) -> Cells:
    """Return the outcome of each of many swings within `steps` steps; `fast`: compiled by Numba.

    theta [rad], between 0 and pi, and z are one-dimensional and of one length, as are the CELLs
    returned.  No cell depends on the others.
    """
    model = Pendulum(1.0)
    watch = (compiled if fast else plain)(method, model)
    h = z
    rest = np.zeros(len(theta))
    phase = (theta, rest)
    start: Floats = model.energy(np.sin)(phase)
    up, down, reach = _bounds(method, theta, z, start)
    band = np.minimum(up, down)
    watched = Watched(start, band, rest + math.pi, rest.copy(), rest.copy(), theta.copy())
    index: NDArray[Any] = np.arange(len(theta))
    cells = np.zeros(len(theta), CELL)
    cells["steps"] = steps
    begun = 0
    while begun < steps and len(index):
        parked = np.zeros(len(index), np.bool_)
        for done, phase in watch(phase, h, watched, steps - begun):  # noqa: B020
            over = np.abs(phase[0]) > watched.top
            above = watched.off > up
            lost = over | above | (watched.off < -down)
            now = index[lost]
            cells["steps"][now] = begun + done - 1
            cells["error"][now] = watched.worst[lost] / watched.start[lost]
            cells["fate"][now] = np.where(over, OVER_THE_TOP, np.where(above, GROWS, LOSES))[lost]
            parked |= lost
            for limit in (watched.band, watched.top, up, down):
                limit[lost] = math.inf
            if np.count_nonzero(parked) > PARKED * len(parked):
                break
        begun = begun + done
        kept = ~parked
        index, h, up, down = (each[kept] for each in (index, h, up, down))
        phase = (phase[0][kept], phase[1][kept])
        watched = Watched(*(each[kept] for each in watched))
    cells["error"][index] = watched.worst / watched.start
    if method.symplectic and len(index):
        wobbling = index[(watched.width > 1.1 * reach[index]) | (z[index] > method.linear_limit)]
        if len(wobbling):
            cells["fate"][wobbling] = _unsteady(method, theta[wobbling], z[wobbling], steps)
    return cells


def _unsteady(method: Method, theta: Floats, z: NDArray[Any], steps: int) -> NDArray[Any]:
    """Return the fates of held swings that are too wide or beyond the linear limit."""
    chaotic = is_chaotic(method, theta, z, min(steps, 2000))
    steady = np.where(z > method.linear_limit, ELSEWHERE, WOBBLES)
    return np.where(chaotic, CHAOTIC, steady)


@dataclass(frozen=True, slots=True)
class Failure:
    """The smallest z tried at which a method loses the swing."""

    z: float
    steps: int  # survived
    reason: str  # over the top | grows | loses | chaotic


def first_failure(z: Floats, cells: Cells) -> Failure | None:
    """Return the first failure on an ascending ladder of z; None if the swing is held on all of it.

    `cells` are the outcomes on the ladder.  Bisection would not do, because above the first failure
    there are windows of z where the swing is held again.
    """
    lost = is_lost(cells)
    if not lost.any():
        return None
    first = int(np.argmax(lost))
    return Failure(float(z[first]), int(cells["steps"][first]), FATES[cells["fate"][first]])
