"""The derivative J of a step, by complex step: it gives stability, chaos and change of area.

step(x + i·tiny·v) = step(x) + i·tiny·J v + O(tiny²).  Squire & Trapp, SIAM Review 40 (1998) 110.
"""

import cmath
import math
from itertools import islice
from typing import Any, NamedTuple

from pendu_tui.engine.methods.method import BoundPhases, Method
from pendu_tui.engine.models import LinearOscillator
from pendu_tui.engine.models.model import Model, Phase

_TINY = 1e-100  # no subtraction, so no cancellation: it may be as small as one likes


def tangent_map(
    phases: BoundPhases, phase: Phase, along: Phase, h: Any, steps: int = 1
) -> tuple[Phase, Phase]:
    """Return the phase after some steps, and the derivative's product with `along`.

    `phases` must take complex numbers.
    """
    displaced = phase[0] + 1j * (_TINY * along[0]), phase[1] + 1j * (_TINY * along[1])
    theta, omega = next(islice(phases(displaced, h), steps - 1, None))
    return (theta.real, omega.real), (theta.imag / _TINY, omega.imag / _TINY)


class Jacobian(NamedTuple):
    """The derivative of one step: d(theta', omega') / d(theta, omega), row by row."""

    theta_theta: float
    theta_omega: float  # s
    omega_theta: float  # 1/s
    omega_omega: float

    @property
    def determinant(self) -> float:
        """Area after the step over area before it; 1 for a symplectic method."""
        return self.theta_theta * self.omega_omega - self.theta_omega * self.omega_theta


def jacobian(phases: BoundPhases, phase: Phase, h: float) -> Jacobian:
    """Return the step's Jacobian at a phase, exact to rounding; `phases` take complex numbers."""
    _, by_theta = tangent_map(phases, phase, (1.0, 0.0), h)
    _, by_omega = tangent_map(phases, phase, (0.0, 1.0), h)
    return Jacobian(by_theta[0], by_omega[0], by_theta[1], by_omega[1])


def at_bottom(method: Method, z: float) -> Jacobian:
    """Return the step's Jacobian for small swings with h·w0 = z, in units where w0 = 1."""
    return jacobian(method.on(LinearOscillator(1.0), cmath.sin), (0.0, 0.0), z)


class Stretching:
    """The separation of a neighbouring start: `log` is ln of its growth over `steps` steps."""

    def __init__(self, method: Method, model: Model, h: float) -> None:
        self._phases = method.on(model, cmath.sin)
        self._h = h
        self._w0 = model.w0
        self._along: Phase = (1.0, 0.0)
        self.log = 0.0
        self.steps = 0

    def carry(self, phase: Phase, steps: int) -> None:
        """Advance the displacement from this phase, by few enough steps not to overflow."""
        try:
            _, (theta, omega) = tangent_map(self._phases, phase, self._along, self._h, steps)
            length = math.hypot(theta, omega / self._w0)
            growth = math.log(length)
        except (ArithmeticError, ValueError):  # sine of a large imaginary number, or log 0
            return
        if growth < math.inf:
            self._along = theta / length, omega / length
            self.log += growth
            self.steps += steps
