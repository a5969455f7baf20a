"""The rounding floor: errors that a smaller h does not reduce, because every step rounds."""

import math
import sys
from statistics import fmean

from pendu_tui.engine.scenes import Scene

NUDGE = 1e-9  # relative; small even near the separatrix, but far above the exact swing's error


def rounding_floor(scene: Scene, time: float) -> tuple[float, float]:
    """Return the rounding error of energy (relative) and theta [rad] per square root of steps.

    A step changes the energy at random by a relative epsilon (Brouwer, Astron. J. 46 (1937) 149),
    or by more where theta has grown by many turns and its last digit is coarse.  Theta responds to
    a change of energy as the exact swing to passing the bottom a little slower: the more the later,
    and steeply near the separatrix.  The floor is an upper estimate: RK4 at tiny steps errs by
    0.005 to 0.6 times it.
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
    # not the root of a square, which underflows for 1e-170
    pace = scene.w0 * math.sqrt(widest) * math.sqrt(min(widest, 1.0)) / fastest
    # twice, so that nearly all errors above the floor are due to the method
    energy = 2 * epsilon * max(1.0, pace * pace)
    response = [(moving.at(t).theta - slower.at(t).theta) / NUDGE for t in times]
    # energy changes at any time of the run
    return energy, energy * math.sqrt(fmean(r * r for r in response))
