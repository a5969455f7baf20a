"""The classical Runge-Kutta method."""

import math
from collections.abc import Callable, Iterator
from typing import Any

from engine.methods.method import Method, Phases
from engine.models.model import Force, Number, Phase

Field = Callable[[Number, Number], tuple[Number, Number]]
"""(theta, omega) -> (theta', omega')."""


def rk4(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """The classical Runge-Kutta method of order 4.

    Neither symplectic nor reversible: det - 1 ~ h⁶, so it loses a little area on most of the plane and gains
    some near upright.  Hairer, Lubich & Wanner (2006), II.1.1.
    """
    theta, omega = phase
    half, sixth = h / 2, h / 6
    while True:
        a1 = force(theta)
        omega2 = omega + half * a1
        a2 = force(theta + half * omega)
        omega3 = omega + half * a2
        a3 = force(theta + half * omega2)
        omega4 = omega + h * a3
        a4 = force(theta + h * omega3)
        theta = theta + sixth * (omega + 2.0 * omega2 + 2.0 * omega3 + omega4)
        omega = omega + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
        yield theta, omega


def rk4_on(field: Callable[[Any], Field]) -> Phases:
    """The classical Runge-Kutta method on y' = field(force)(theta, omega), for more than theta'' = force(theta)."""

    def rk4_on_a_field(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        """The classical Runge-Kutta method of order 4 on any field.  Hairer, Lubich & Wanner (2006), II.1.1."""
        rate = field(force)
        theta, omega = phase
        while True:
            v1, a1 = rate(theta, omega)
            v2, a2 = rate(theta + h / 2 * v1, omega + h / 2 * a1)
            v3, a3 = rate(theta + h / 2 * v2, omega + h / 2 * a2)
            v4, a4 = rate(theta + h * v3, omega + h * a3)
            theta = theta + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
            omega = omega + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
            yield theta, omega

    return rk4_on_a_field


def _with_friction(force: Any) -> Field:
    return lambda theta, omega: (omega, force(theta) - force.friction * omega)


RK4 = Method(
    key="rk4",
    label="RK4",
    letter="r",
    phases=rk4,
    formula="y' = y + h/6 (k1 + 2 k2 + 2 k3 + k4), the slopes k at the start, twice the middle, the end",
    order=4,
    force_evaluations=4,
    linear_limit=2 * math.sqrt(2),
    other_names=("classical Runge-Kutta",),
    reference="Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), II.1.1",
    used="energy-conserving systems in MuJoCo, integrator RK4 [mujoco.readthedocs.io, Computation]",
    with_friction=rk4_on(_with_friction),
    models=("pendulum", "linear", "damped", "spring"),
)

FAMILY = (RK4,)
