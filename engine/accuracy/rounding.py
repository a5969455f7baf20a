"""The rounding floor: errors that a smaller h does not reduce, because every step rounds."""

import math
import sys
from statistics import fmean

from engine.scenes import Scene

# relative; small even next to the separatrix, and far above the exact swing's own error
NUDGE = 1e-9


def rounding_floor(scene: Scene, time: float) -> tuple[float, float]:
    """Return the rounding error of energy (relative) and theta [rad] per square root of steps.

    A step changes the energy by a relative epsilon, at random (Brouwer, Astron. J. 46 (1937) 149);
    by more where theta has grown by many turns and its last digit is coarse.  Theta follows the
    energy as the exact swing does when it passes the bottom a little slower: the more the longer,
    and steeply next to the separatrix. An estimate from above: RK4 at tiny steps errs by 0.005 to
    0.6 times it.
    """
    epsilon = sys.float_info.epsilon
    exact = scene.exact()
    if exact.regime == "equilibrium":
        return epsilon, epsilon
    swing = ((exact.period or time) * sample / 400 for sample in range(401))
    start = max(map(exact.at, swing), key=lambda state: abs(state.omega))
    moving = scene.altered(theta=start.theta, omega=start.omega).exact()
    slower = scene.altered(theta=start.theta, omega=start.omega * (1 - NUDGE)).exact()
    times = [time * sample / 400 for sample in range(401)]
    widest = max(abs(exact.at(t).theta) for t in times)
    fastest = max(abs(exact.at(t).omega) for t in times)
    # squares of 1e-170 are 0
    pace = scene.w0 * math.sqrt(widest) * math.sqrt(min(widest, 1.0)) / fastest
    # twice: errors above the floor are then due to the method, but for a fraction
    energy = 2 * epsilon * max(1.0, pace * pace)
    response = [(moving.at(t).theta - slower.at(t).theta) / NUDGE for t in times]
    # changes come at any time of the run
    return energy, energy * math.sqrt(fmean(r * r for r in response))
