"""The pendulum with friction: theta'' = -w0² sin theta - gamma omega.

Energy only decreases: dE/dt = -gamma omega².  Area shrinks alike everywhere, by exp(-gamma t).
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from pendu_tui.engine.models.model import (
    ENERGY_RATIO,
    Force,
    Model,
    Number,
    Phase,
    Rates,
    Sine,
    Step,
    compose_verlet,
)
from pendu_tui.engine.models.pendulum import Pendulum


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
        # beyond, the pendulum creeps, and its exact motion takes too many steps
        Number("friction", "s⁻¹", "friction gamma in s⁻¹", 0.0, 100.0, max_over_w0=100),
    )
    offers = ("parts", "rates")
    has_separatrix = False
    error = ENERGY_RATIO
    caption = "curves of equal energy; damped motion crosses them inwards"
    without_force = "Maps and studies apply to a pendulum with no friction, which keeps its energy."
    exact = Model.exact

    def rates(self, sin: Sine = math.sin) -> Rates:
        force, friction = self.parts(sin)

        def damped_rates(phase: Phase) -> Phase:
            theta, omega = phase
            return omega, force(theta) - friction * omega

        return damped_rates

    def parts(self, sin: Sine = math.sin) -> DampedParts:
        return DampedParts(self.force(sin), self.friction)

    def exact_step(self) -> tuple[Step, float]:
        return compose_verlet(self.force(), self.friction), 0.05 / max(self.w0, self.friction)

    def area_share(self, t: float) -> float:
        return math.exp(-self.friction * t)
