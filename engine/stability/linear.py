"""What a step does to the amplitude of the linear oscillator, the limit of small swings.

Everything is read from the method's own step, and depends on z = h·w0 only.  Up to which z a method
stays bounded is a claim of `methods`, measured in `methods.measure`.
"""

import cmath
import math
from typing import NamedTuple

from engine.methods import Method
from engine.run.tangent import at_bottom


def amplification(method: Method, z: float) -> float:
    """Largest |multiplier| of one step at the bottom of the pendulum, from the step's Jacobian.

    Below a symplectic method's limit it is 1 to rounding, 1e-15; at the limit the two multipliers
    meet and rounding shows as its square root, 1e-8.
    """
    a, b, c, d = at_bottom(method, z)
    mean = (a + d) / 2
    spread = cmath.sqrt((a - d) ** 2 / 4 + b * c)
    return max(abs(mean + spread), abs(mean - spread))


class Wobble(NamedTuple):
    """How far a bounded linear swing from rest goes, over its start."""

    lowest: float  # energy
    highest: float
    widest: float  # |theta|


def wobble(method: Method, z: float) -> Wobble:
    """Return the energy's range and the largest amplitude of a linear swing from rest.

    A symplectic step keeps a quadratic form, not the energy: the swing stays on the ellipse
    -c theta² + (a - d) theta omega + b omega² = -c theta0², with its Jacobian ((a, b), (c, d)) at
    w0 = 1.  Its half axes, squared, are the energy's extremes: (1 - z²/4, 1, 1) for velocity
    Verlet, (1/(1 + z/2), 1/(1 - z/2), 1/sqrt(1 - z²/4)) for symplectic Euler, (1, 1, 1) for
    explicit Euler and RK4.  Beyond its limit a symplectic step has no ellipse: (0, 1, 1), velocity
    Verlet's at its limit.
    """
    a, b, c, d = at_bottom(method, z)
    skew = (a - d) ** 2 / 4 + b * c
    if skew >= 0:
        return Wobble(0.0, 1.0, 1.0)
    mean = (b - c) / 2
    spread = math.hypot((b + c) / 2, (a - d) / 2)
    return Wobble(-c / (mean + spread), -c / (mean - spread), math.sqrt(b * c / skew))
