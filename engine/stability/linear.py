"""The linear oscillator theta'' = -w0² theta, the limit of small swings: up to which step a method stays bounded.

Everything is read from the method's own step, and depends on z = h·w0 only.
"""

import cmath
import math
from fractions import Fraction
from numbers import Rational
from typing import Any, NamedTuple

import numpy as np

from engine.methods import Method
from engine.models.model import Number
from engine.run.tangent import at_bottom

ROUNDING = 1e-13  # of a determinant and a trace in floats; some hundred times what the steps here make
HIGHEST, RUNGS = 8, 2048  # z is looked at up to here, in steps of 1/2048: two thirds of the narrowest gap, BM6's


def amplification(method: Method, z: float) -> float:
    """Largest |multiplier| of one step at the bottom of the pendulum, from the step's Jacobian.

    Below a symplectic method's limit it is 1 to rounding, 1e-15; at the limit the two multipliers
    meet and rounding shows as its square root, 1e-8.
    """
    a, b, c, d = at_bottom(method, z)
    mean, spread = (a + d) / 2, cmath.sqrt((a - d) ** 2 / 4 + b * c)
    return max(abs(mean + spread), abs(mean - spread))


def is_stable(method: Method, z: Number) -> Any:
    """Whether neither multiplier of the step is larger than 1, for one z or an array of them.

    Both lie in the closed unit disc if det <= 1 and |trace| <= 1 + det: Jury, Theory and Application of the
    z-Transform Method (1964).  A step has only + and * on the phase, so if its coefficients are rational a Fraction
    goes through it exactly, and |multiplier| = 1, the case of symplectic methods, needs no tolerance.  Floats get one.
    """
    a, c = method.step(_spring, (1, 0), z)
    b, d = method.step(_spring, (0, 1), z)
    determinant = a * d - b * c
    most = 1 if isinstance(determinant, Rational) else 1 + ROUNDING
    return (determinant <= most) & (abs(a + d) <= most + determinant)


def _spring(theta: Number) -> Number:
    return -theta


def linear_limit(method: Method) -> float:
    """The first z beyond which the step is unstable, to 1e-9; 0.0 where no step is small enough.

    Looked for upwards, as high-order methods are stable again beyond it, in islands.
    """
    rungs = np.arange(1, HIGHEST * RUNGS + 1)
    unstable = np.flatnonzero(~is_stable(method, rungs / RUNGS))
    first = int(rungs[unstable[0]]) if len(unstable) else HIGHEST * RUNGS
    below, above = Fraction(first - 1, RUNGS), Fraction(first, RUNGS)
    while above - below > Fraction(1, 2**33):  # 1.2e-10
        middle = (below + above) / 2
        if is_stable(method, middle):
            below = middle
        else:
            above = middle
    return float(below)


class Wobble(NamedTuple):
    """How far a bounded linear swing from rest goes, over its start."""

    lowest: float  # energy
    highest: float
    widest: float  # |theta|


def wobble(method: Method, z: float) -> Wobble:
    """The lowest and highest energy and the largest amplitude that this step takes a linear swing from rest to.

    A symplectic step keeps a quadratic form, not the energy: the swing stays on the ellipse
    -c theta² + (a - d) theta omega + b omega² = -c theta0², where ((a, b), (c, d)) is its Jacobian at
    w0 = 1.  The half axes, squared, are the extremes of the energy: (1 - z²/4, 1) for velocity Verlet, for symplectic
    Euler (1/(1 + z/2), 1/(1 - z/2)).  Explicit Euler and RK4 do not wobble: (1, 1).  The reach of the ellipse is 1 for
    velocity Verlet, 1/sqrt(1 - z²/4) for symplectic Euler.  Beyond the limit of a symplectic step there is no
    ellipse, and (0, 1, 1) is what velocity Verlet's has become there.
    """
    a, b, c, d = at_bottom(method, z)
    skew = (a - d) ** 2 / 4 + b * c
    if skew >= 0:
        return Wobble(0.0, 1.0, 1.0)
    mean, spread = (b - c) / 2, math.hypot((b + c) / 2, (a - d) / 2)
    return Wobble(-c / (mean + spread), -c / (mean - spread), math.sqrt(b * c / skew))
