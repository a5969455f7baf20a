"""The frictionless pendulum.  Mass cancels; energies are per unit m·L², in s⁻²."""

import math
from dataclasses import dataclass
from typing import Any

from pendu_tui.engine.models.exact_pendulum import exact_pendulum
from pendu_tui.engine.models.model import Energy, ExactMotion, Force, Model, Phase, Sine


@dataclass(frozen=True)
class Pendulum(Model):
    """theta'' = -w0² sin theta."""

    w0_squared: float  # g/L [s⁻²]

    key = "pendulum"
    equation = "theta'' = -w0² sin theta"
    turns = True
    has_separatrix = True

    def force(self, sin: Sine = math.sin) -> Force:
        """theta -> -w0² sin theta [rad/s²]."""
        strength = -self.w0_squared

        def pendulum_force(theta: Any) -> Any:
            return strength * sin(theta)

        return pendulum_force

    def slope(self, theta: float) -> float:
        return -self.w0_squared * math.cos(theta)

    def energy(self, sin: Sine = math.sin) -> Energy:
        """(theta, omega) -> omega²/2 + 2 w0² sin²(theta/2) [s⁻²].

        Equal to omega²/2 + w0² (1 - cos theta), which would cancel to nothing near the bottom.
        """
        twice = 2 * self.w0_squared

        def pendulum_energy(phase: Phase) -> Any:
            theta, omega = phase
            half = sin(theta * 0.5)
            return omega * omega * 0.5 + twice * half * half

        return pendulum_energy

    def exact(self, theta: float, omega: float) -> ExactMotion:
        return exact_pendulum(self.w0_squared, theta, omega)

    def level(self, theta: Any, omega: Any, cos: Sine = math.cos) -> Any:
        """Return 1 - E/E_separatrix: 1 at rest, 0 on the separatrix, negative in rotation.

        It is computed as a product, because the difference cancels near the separatrix.
        """
        c = cos(theta / 2)
        v = omega / (2 * self.w0)
        return (c - v) * (c + v)
