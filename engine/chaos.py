"""Chaos in a method's own map: at large steps a pendulum, which cannot be chaotic, is given motion that is.

Symplectic Euler on the pendulum is the Chirikov standard map with K = z²; velocity Verlet is the same map,
seen half a kick earlier.  Up to Greene's threshold invariant curves fence the chaotic orbits in; above
it they wander off without bound.  Greene, J. Math. Phys. 20 (1979) 1183.
"""

import cmath
import math

from engine.methods import Step
from engine.pendulum import acceleration

GREENE_K = 0.971635
GREENE_Z = math.sqrt(GREENE_K)  # 0.985716

_TINY = 1e-100  # as in engine.tangent


def lyapunov(step: Step, theta: float, omega: float, z: float, steps: int) -> float:
    """Mean growth per step of ln |a small displacement| along an orbit of `steps` steps, with w0 = 1.

    The tangent map goes along as the imaginary part: step(x + i·tiny·v) = step(x) + i·tiny·J v.
    Regular orbits tend to 0 as ln(steps)/steps, chaotic ones to a positive number; for K >= 10 that
    is ln(K/2).
    """
    force = acceleration(1.0, cmath.sin)
    along_theta, along_omega, total = 1.0, 0.0, 0.0
    for _ in range(steps):
        phase = complex(theta, _TINY * along_theta), complex(omega, _TINY * along_omega)
        new_theta, new_omega = step(force, phase, z)
        theta, omega = new_theta.real, new_omega.real
        along_theta, along_omega = new_theta.imag / _TINY, new_omega.imag / _TINY
        growth = math.hypot(along_theta, along_omega)
        along_theta, along_omega = along_theta / growth, along_omega / growth
        total += math.log(growth)
    return total / steps


def is_chaotic(step: Step, theta: float, z: float, steps: int = 10_000) -> bool:
    """Whether a swing from rest at theta [rad] is chaotic, judged from `steps` steps.

    The threshold is ten times what a regular orbit shows, ln(steps)/steps; chaotic swings that
    leave the band show a hundred times it.
    """
    return lyapunov(step, theta, 0.0, z, steps) > 10 * math.log(steps) / steps
