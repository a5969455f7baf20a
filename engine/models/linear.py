"""The linear oscillator theta'' = -w0² theta: the limit of small swings."""

import math
from dataclasses import dataclass
from typing import Any

from pendu_tui.engine.models.model import Energy, ExactMotion, Force, Model, Phase, Sine, State


@dataclass(frozen=True)
class LinearOscillator(Model):
    """theta'' = -w0² theta: one period for every amplitude, and never over the top."""

    w0_squared: float  # s⁻²

    key = "linear"
    equation = "theta'' = -w0² theta"
    turns = False

    def force(self, sin: Sine = math.sin) -> Force:
        w0_squared = self.w0_squared

        def linear_force(theta: Any) -> Any:
            return -w0_squared * theta

        return linear_force

    def slope(self, theta: float) -> float:
        return -self.w0_squared

    def energy(self, sin: Sine = math.sin) -> Energy:
        """(omega² + w0² theta²)/2 [s⁻²]."""
        w0_squared = self.w0_squared

        def linear_energy(phase: Phase) -> Any:
            theta, omega = phase
            return omega * omega / 2 + w0_squared / 2 * theta * theta

        return linear_energy

    def exact(self, theta: float, omega: float) -> ExactMotion:
        """theta cos w0 t + omega/w0 sin w0 t."""
        w0 = self.w0

        def at(t: float) -> State:
            c = math.cos(w0 * t)
            s = math.sin(w0 * t)
            return State(theta * c + omega / w0 * s, omega * c - theta * w0 * s)

        if theta == 0 == omega:
            return ExactMotion(at, "equilibrium")
        return ExactMotion(at, "libration", math.tau / w0)

    def level(self, theta: Any, omega: Any, cos: Sine = math.cos) -> Any:
        """Return minus a quarter of the squared amplitude."""
        return -(theta * theta + omega * omega / self.w0**2) / 4
