"""The derivative of a step, by complex step; stability, chaos, area and symplecticity follow from it.

step(x + i·tiny·v) = step(x) + i·tiny·J v + O(tiny²).  Squire & Trapp, SIAM Review 40 (1998) 110.
"""

import cmath
from typing import NamedTuple

from engine.methods import Step
from engine.models.pendulum import acceleration
from engine.models.state import Acceleration, Phase

_TINY = 1e-100  # a complex step has no subtraction, so it may be as small as one likes


def tangent_map(step: Step, force: Acceleration, phase: Phase, along: Phase, h: float) -> tuple[Phase, Phase]:
    """The phase after one step, and J·along, what a small displacement `along` has become; `force` takes complexes."""
    displaced = phase[0] + 1j * (_TINY * along[0]), phase[1] + 1j * (_TINY * along[1])
    theta, omega = step(force, displaced, h)
    return (theta.real, omega.real), (theta.imag / _TINY, omega.imag / _TINY)


class Jacobian(NamedTuple):
    """Derivative of one step: d(theta', omega') / d(theta, omega), row by row."""

    theta_theta: float
    theta_omega: float  # s
    omega_theta: float  # 1/s
    omega_omega: float

    @property
    def determinant(self) -> float:
        """Area after the step over area before it; 1 for a symplectic method."""
        return self.theta_theta * self.omega_omega - self.theta_omega * self.omega_theta


def jacobian(step: Step, w0_squared: float, theta: float, omega: float, h: float) -> Jacobian:
    """The step's Jacobian at (theta, omega), exact to rounding."""
    force = acceleration(w0_squared, cmath.sin)
    _, by_theta = tangent_map(step, force, (theta, omega), (1.0, 0.0), h)
    _, by_omega = tangent_map(step, force, (theta, omega), (0.0, 1.0), h)
    return Jacobian(by_theta[0], by_omega[0], by_theta[1], by_omega[1])
