"""The pendulum with friction: theta'' = -w0² sin theta - gamma omega.

Energy only decreases: dE/dt = -gamma omega².  Area shrinks alike everywhere, by exp(-gamma t).
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

from engine.models.model import EnergyReference, ExactMotion, Force, Phase, Regime, Sine, State
from engine.models.pendulum import Pendulum, separatrix_energy
from engine.models.reference import Reference

STEP = 0.05  # of the reference, times the larger of w0 and gamma
ACCURACY = 1e-10  # rad


@dataclass(frozen=True)
class DampedPendulum(Pendulum):
    """theta'' = -w0² sin theta - gamma omega."""

    friction: float  # gamma [s⁻¹]

    key: ClassVar[str] = "damped"
    equation: ClassVar[str] = "theta'' = -w0² sin theta - gamma omega"
    parameters: ClassVar[tuple[str, ...]] = ("friction",)
    plain: ClassVar[bool] = False
    conserved: ClassVar[bool] = False

    def force(self, sin: Sine = math.sin) -> Force:
        """Gravity's; its attribute `friction` is gamma [s⁻¹]."""
        force = super().force(sin)
        force.friction = self.friction  # type: ignore[attr-defined]
        return force

    def exact(self, theta: float, omega: float) -> ExactMotion:
        """By the reference; it swings down to rest, and turns before if its energy is enough."""

        def at(t: float) -> State:
            return State(*_reference(self, theta, omega).at(t))

        energy = self.energy()((theta, omega))
        if energy == 0:
            return ExactMotion(at, "equilibrium")
        regime: Regime = "libration" if energy < separatrix_energy(self.w0_squared) else "rotation"
        return ExactMotion(at, regime, accuracy=ACCURACY)

    def reference(self, theta: float, omega: float) -> EnergyReference:
        """The energy of the motion by the reference; errors are ln(E/E_true)."""
        energy, start = self.energy(), super().reference(theta, omega)

        def true(t: float) -> float:
            value: float = energy(_reference(self, theta, omega).at(t))
            return value

        return start._replace(true=true)


@lru_cache(maxsize=16)
def _reference(model: DampedPendulum, theta: float, omega: float) -> Reference:
    start: Phase = theta, omega
    return Reference(model.force(), start, STEP / max(model.w0, model.friction), model.friction)
