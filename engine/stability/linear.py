"""What a step does to the amplitude of the linear oscillator, the limit of small swings.

It depends on z = h·w0 only.  The z up to which a method is stable is its `linear_limit`.
"""

import cmath
import math
from typing import NamedTuple

from pendu_tui.engine.methods import Method
from pendu_tui.engine.run.tangent import at_bottom


def amplification(method: Method, z: float) -> float:
    """Return the largest |eigenvalue| of the Jacobian of a step at the bottom.

    Below a symplectic method's limit it is 1 to rounding, 1e-15; at the limit two eigenvalues meet,
    and the error is the square root of rounding, 1e-8.
    """
    a, b, c, d = at_bottom(method, z)
    mean = (a + d) / 2
    spread = cmath.sqrt((a - d) ** 2 / 4 + b * c)
    return max(abs(mean + spread), abs(mean - spread))


class Wobble(NamedTuple):
    """The range of a bounded linear swing from rest, relative to its start."""

    lowest: float  # energy
    highest: float
    widest: float  # |theta|


def wobble(method: Method, z: float) -> Wobble:
    """Return the energy's range and the largest amplitude of a linear swing from rest.

    A symplectic step with the Jacobian ((a, b), (c, d)) at w0 = 1 keeps a swing on the ellipse
    -c theta² + (a - d) theta omega + b omega² = -c theta0².  The squares of its half axes are the
    energy's extremes: (1 - z²/4, 1, 1) for velocity Verlet, (1/(1 + z/2), 1/(1 - z/2),
    1/sqrt(1 - z²/4)) for symplectic Euler, (1, 1, 1) for explicit Euler and RK4.  Beyond its limit
    a symplectic step has no ellipse: (0, 1, 1), as for velocity Verlet at its limit.
    """
    a, b, c, d = at_bottom(method, z)
    skew = (a - d) ** 2 / 4 + b * c
    if skew >= 0:
        return Wobble(0.0, 1.0, 1.0)
    mean = (b - c) / 2
    spread = math.hypot((b + c) / 2, (a - d) / 2)
    return Wobble(-c / (mean + spread), -c / (mean - spread), math.sqrt(b * c / skew))
