"""Chaos in a method's own map: at large steps a pendulum, which cannot be chaotic, is given motion that is.

Symplectic Euler on the pendulum is the Chirikov standard map with K = z²; velocity Verlet is the same map,
seen half a kick earlier.  Up to Greene's threshold invariant curves fence the chaotic orbits in; above
it they wander off without bound.  Greene, J. Math. Phys. 20 (1979) 1183.
"""

import cmath
import math

from engine.methods import Step
from engine.models.pendulum import acceleration
from engine.models.state import Phase
from engine.phase_space.tangent import tangent_map

GREENE_K = 0.971635
GREENE_Z = math.sqrt(GREENE_K)  # 0.985716


def lyapunov(step: Step, theta: float, omega: float, z: float, steps: int) -> float:
    """Largest Lyapunov exponent per step, with w0 = 1: mean growth of ln |a small displacement| along an orbit.

    The displacement is brought back to length 1 after each step: Benettin et al., Meccanica 15 (1980) 9.
    Regular orbits tend to 0 as ln(steps)/steps, chaotic ones to a positive number; for K >= 10 that
    is ln(K/2): Chirikov, Phys. Rep. 52 (1979) 263.
    """
    force = acceleration(1.0, cmath.sin)
    phase: Phase = theta, omega
    along: Phase = 1.0, 0.0
    total = 0.0
    for _ in range(steps):
        phase, along = tangent_map(step, force, phase, along, z)
        growth = math.hypot(*along)
        along = along[0] / growth, along[1] / growth
        total += math.log(growth)
    return total / steps


def is_chaotic(step: Step, theta: float, z: float, steps: int = 10_000) -> bool:
    """Whether a swing from rest at theta [rad] is chaotic, judged from `steps` steps.

    The threshold is ten times what a regular orbit shows at most, ln(steps)/steps.  Of the swings that leave
    the band of engine.stability.outcomes in 10 000 steps, chaotic ones showed 31 to 930 times it.
    """
    return lyapunov(step, theta, 0.0, z, steps) > 10 * math.log(steps) / steps
