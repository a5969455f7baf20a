"""The pendulum with friction: theta'' = -w0² sin theta - gamma omega.

Energy only decreases: dE/dt = -gamma omega².  Area shrinks alike everywhere, by exp(-gamma t).
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

from pendu_tui.engine.models.model import (
    EnergyReference,
    ExactMotion,
    Force,
    Number,
    Phase,
    Rates,
    Regime,
    Sine,
    State,
)
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.models.reference import ACCURACY, Reference, compose_verlet
from pendu_tui.engine.quantities import ENERGY_ERROR, Chart, Head

STEP = 0.05  # of the reference, times the larger of w0 and gamma


class DampedParts(NamedTuple):
    """The parts of the model for methods made for friction."""

    force: Force  # gravity's
    friction: float  # gamma [s⁻¹]


@dataclass(frozen=True)
class DampedPendulum(Pendulum):
    """theta'' = -w0² sin theta - gamma omega."""

    friction: float  # gamma [s⁻¹]

    key = "damped"
    equation = "theta'' = -w0² sin theta - gamma omega"
    parameters = (
        # beyond, the pendulum creeps, and its reference takes too many steps
        Number("friction", "s⁻¹", "friction in s⁻¹", 0.0, 100.0, max_over_w0=100),
    )
    offers = ("parts", "rates")
    has_separatrix = False
    conserves_energy = False
    error = ENERGY_ERROR._replace(
        label="ln(E/E_true)",
        head=Head("ln E/Et", 8, "ln E/Et", 8),
        sentence="the logarithm of the energy over that of the exact motion, which loses energy, "
        "too",
        chart=Chart("ln(E/E_true)", "|ln(E/E_true)|"),
    )
    caption = "curves of equal energy; damped motion crosses them inwards"
    without_force = "Maps and studies are for a pendulum that keeps its energy; friction takes it."

    def rates(self, sin: Sine = math.sin) -> Rates:
        force, friction = self.parts(sin)

        def damped_rates(phase: Phase) -> Phase:
            theta, omega = phase
            return omega, force(theta) - friction * omega

        return damped_rates

    def parts(self, sin: Sine = math.sin) -> DampedParts:
        return DampedParts(self.force(sin), self.friction)

    def exact(self, theta: float, omega: float) -> ExactMotion:
        """Return the reference's motion, a rotation as long as the energy is enough."""

        def at(t: float) -> State:
            return State(*_reference(self, theta, omega).at(t))

        energy = self.energy()((theta, omega))
        if energy == 0:
            return ExactMotion(at, "equilibrium")
        regime: Regime = "rotation"
        if energy < 2 * self.w0_squared:
            regime = "libration"
        return ExactMotion(at, regime, accuracy=ACCURACY)

    def reference(self, theta: float, omega: float) -> EnergyReference:
        """Return the reference's energy; errors are ln(E/E_true)."""
        energy = self.energy()

        def true(t: float) -> float:
            value: float = energy(_reference(self, theta, omega).at(t))
            return value

        start = super().reference(theta, omega)
        least = max(1e-24 * min(self.w0_squared, start.scale), 1e-300)  # of 1e-12 rad
        return start._replace(true=true, least=least)

    def area_share(self, t: float) -> float:
        return math.exp(-self.friction * t)


@lru_cache(maxsize=16)
def _reference(model: DampedPendulum, theta: float, omega: float) -> Reference:
    start: Phase = theta, omega
    step = compose_verlet(model.force(), model.friction)
    return Reference(step, start, STEP / max(model.w0, model.friction))
