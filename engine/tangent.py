"""The step's own derivative, by complex step: what stability, area and symplecticity are read from."""

import cmath
from typing import NamedTuple

from engine.methods import Step
from engine.pendulum import acceleration

_TINY = 1e-100  # a complex step has no subtraction, so it may be as small as one likes


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

    @property
    def trace(self) -> float:
        """Sum of the two multipliers."""
        return self.theta_theta + self.omega_omega


def jacobian(step: Step, w0_squared: float, theta: float, omega: float, h: float) -> Jacobian:
    """The step's Jacobian at (theta, omega), exact to rounding.

    Complex-step derivative: f(x + i·tiny) = f(x) + i·tiny·f'(x) + O(tiny²).
    Squire & Trapp, SIAM Review 40 (1998) 110.
    """
    force = acceleration(w0_squared, cmath.sin)
    by_theta = step(force, (complex(theta, _TINY), complex(omega)), h)
    by_omega = step(force, (complex(theta), complex(omega, _TINY)), h)
    return Jacobian(
        by_theta[0].imag / _TINY, by_omega[0].imag / _TINY, by_theta[1].imag / _TINY, by_omega[1].imag / _TINY
    )
