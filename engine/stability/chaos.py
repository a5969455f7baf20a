"""Chaos in a method's map: at large steps, a pendulum's numerical motion is chaotic.

Symplectic Euler on the pendulum is the Chirikov standard map with K = z²; velocity Verlet is the
same map half a kick later.  Up to Greene's threshold invariant curves fence chaotic orbits in;
above it they wander without bound.  Greene, J. Math. Phys. 20 (1979) 1183.
"""

import math
from typing import Any

import numpy as np

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models import Pendulum
from pendu_tui.engine.run.levels import CHAOTIC_SEPARATION
from pendu_tui.engine.run.tangent import tangent_map

GREENE_Z = math.sqrt(0.971635)  # Greene's K


def parting(method: Method, theta: Any, omega: Any, z: Any, steps: int) -> Any:
    """Return ln of the growth of neighbours' distance after so many steps, with w0 = 1.

    The displacement is rescaled to length 1 after each step: Benettin et al., Meccanica 15 (1980)
    9.  It grows in proportion to the steps on regular orbits, exponentially on chaotic ones.  The
    logarithm per step tends to the largest Lyapunov exponent, for K >= 10 ln(K/2): Chirikov, Phys.
    Rep. 52 (1979) 263.
    """
    phases = method.on(Pendulum(1.0), np.sin)
    along = 1.0 + 0.0 * theta
    across = 0.0 * theta
    total = 0.0 * theta
    for _ in range(steps):
        (theta, omega), (along, across) = tangent_map(phases, (theta, omega), (along, across), z)
        growth = np.hypot(along, across)
        along = along / growth
        across = across / growth
        total = total + np.log(growth)
    return total


def is_chaotic(method: Method, theta: Any, z: Any, steps: int = 10_000) -> Any:
    """Return whether swings from rest at theta [rad] are chaotic within `steps` steps.

    Over a million steps neighbours on regular orbits separate by at most e^14, on chaotic ones by
    e^28 within some thousand.  The exact swing from theta separates them by 1/cos²(theta/2), which
    does not count.
    """
    return parting(method, theta, 0.0 * theta, z, steps) > CHAOTIC_SEPARATION + math.log(
        steps
    ) - 2 * np.log(np.cos(theta / 2))
