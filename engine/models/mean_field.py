"""A pendulum whose bob carries a quantum two-level system, in mean field (Ehrenfest's dynamics).

The two levels are the Bloch vector s, of length 1 for a pure state.  It turns about the field
b(theta) = (sin theta, 0, cos theta), and the pendulum feels the expectation value of the energy:

    theta' = omega,  omega' = -w0² sin theta - kappa b'(theta)·s,  s' = nu b(theta) × s

Energy and |s| are conserved for any nu: Tully, Faraday Discuss. 110
(1998) 407.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from pendu_tui.engine.models.model import (
    Energy,
    ExtraColumn,
    Model,
    Number,
    Observation,
    Phase,
    Rates,
    Sine,
    Step,
    compose,
)
from pendu_tui.engine.quantities import Chart, Quantity


@dataclass(frozen=True)
class MeanField(Model):
    """A phase is (theta, omega, sx, sy, sz)."""

    w0_squared: float  # s⁻²
    coupling: float  # kappa [s⁻²]: energy of the two levels, per unit m·L²
    level_frequency: float  # nu [s⁻¹]: how fast the Bloch vector turns

    key = "mean_field"
    equation = "theta'' = -w0² sin theta - kappa b'·s, s' = nu b × s"
    parameters = (
        Number(
            "coupling",
            "s⁻²",
            "coupling of the bob to the two-level system in s⁻²",
            min=-1e6,
            max=1e6,
            default=2.0,
        ),
        Number(
            "level_frequency",
            "s⁻¹",
            "angular frequency of the two-level transition in s⁻¹",
            min=1e-3,
            max=1e4,
            default=20.0,
            max_over_w0=1_000,  # beyond, its exact motion takes too many steps
        ),
    )
    turns = True
    offers = ("parts", "rates")
    variables = (
        Quantity("sx", about="of the Bloch vector"),
        Quantity("sy", about="of the Bloch vector"),
        Quantity("sz", about="of the Bloch vector"),
        Quantity(
            "probability_error",
            about="length of the Bloch vector - 1; the true motion keeps it at 0",
            chart=Chart("length of the Bloch vector - 1"),
        ),
    )
    extra_columns = (
        ExtraColumn(
            "|s|",
            "length |s|",
            "the length of the Bloch vector, which the true motion keeps at 1",
            lambda extra: 1 + extra["probability_error"],
        ),
    )
    frequency_symbol = "nu"
    caption = "a projection: angle and angular velocity, without the two levels"
    without_force = (
        "Maps and studies apply to a single angle; here there is a Bloch vector as well."
    )
    without_ring = (
        "A projection from five dimensions onto two: no curves of equal energy and no ring."
    )

    @property
    def fastest(self) -> float:
        return max(self.w0, self.level_frequency)

    def start(self, theta: float, omega: float) -> Phase:
        return theta, omega, 1.0, 0.0, 0.0  # an equal superposition of both levels

    def rest_phase(self, theta: float) -> Phase:
        """Return the phase of least energy at an angle [rad]: s against the field."""
        sign = math.copysign(1.0, self.coupling)
        return theta, 0.0, -sign * math.sin(theta), 0.0, -sign * math.cos(theta)

    def observe(self, phase: Phase) -> Observation:
        theta, omega, sx, sy, sz = phase
        extra = {"sx": sx, "sy": sy, "sz": sz, "probability_error": _length(phase) - 1}
        return Observation(theta, omega, extra)

    def invariant(self) -> Callable[[Phase], float]:
        """Return |s|, the total probability, as a function."""
        return _length

    def rates(self, sin: Sine = math.sin) -> Rates:
        def mean_field_rates(phase: Phase) -> Phase:
            theta, omega, sx, sy, sz = phase
            sine = sin(theta)
            cosine = sin(theta + math.pi / 2)
            acceleration = -self.w0_squared * sine - self.coupling * (cosine * sx - sine * sz)
            return (
                omega,
                acceleration,
                -self.level_frequency * cosine * sy,
                self.level_frequency * (cosine * sx - sine * sz),
                self.level_frequency * sine * sy,
            )

        return mean_field_rates

    def kick(self, phase: Phase, h: float) -> Phase:
        """Return the exact phase after h [s] in which theta is constant.

        b, b' and b × b' are orthonormal: s keeps its part along b, and its parts u and v along the
        other two turn by nu h.
        """
        theta, omega, sx, sy, sz = phase
        sine = math.sin(theta)
        cosine = math.cos(theta)
        along = sine * sx + cosine * sz
        u = cosine * sx - sine * sz
        v = sy
        turned = self.level_frequency * h
        integral = (u * math.sin(turned) - v * (1 - math.cos(turned))) / self.level_frequency
        omega = omega - self.w0_squared * h * sine - self.coupling * integral
        u_after = u * math.cos(turned) - v * math.sin(turned)
        v_after = v * math.cos(turned) + u * math.sin(turned)
        return (
            theta,
            omega,
            sine * along + cosine * u_after,
            v_after,
            cosine * along - sine * u_after,
        )

    def energy(self, sin: Sine = math.sin) -> Energy:
        def mean_field_energy(phase: Phase) -> Any:
            theta, omega, sx, _, sz = phase
            half = sin(theta / 2)
            field = sin(theta) * sx + sin(theta + math.pi / 2) * sz
            return omega * omega / 2 + 2 * self.w0_squared * half * half + self.coupling * field

        return mean_field_energy

    def exact_step(self) -> tuple[Step, float]:
        strongest = math.sqrt(self.w0_squared + abs(self.coupling))
        return compose(partial(strang, self)), 0.4 / max(self.fastest, 4 * strongest)


def _length(phase: Phase) -> float:
    return math.hypot(*phase[2:])


def strang(model: MeanField, phase: Phase, h: float) -> Phase:
    """Return the phase after half a drift, the exact kick, and half a drift."""
    theta, omega, *bloch = phase
    theta, omega, *bloch = model.kick((theta + h / 2 * omega, omega, *bloch), h)
    return theta + h / 2 * omega, omega, *bloch
