"""Explicit Runge-Kutta methods, of which explicit Euler is the first."""

import math
from collections.abc import Iterator

from pendu_tui.engine.methods.method import HAIRER, Method
from pendu_tui.engine.models import MODELS
from pendu_tui.engine.models.model import Force, Phase, Rates


def explicit_euler(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Explicit (forward) Euler: both updates from the old state."""
    theta, omega = phase
    while True:
        theta, omega = theta + h * omega, omega + h * force(theta)
        yield theta, omega


def explicit_euler_on_rates(rates: Rates, phase: Phase, h: float) -> Iterator[Phase]:
    """Explicit Euler on a first-order system."""
    while True:
        phase = euler_step(phase, h, rates(phase))
        yield phase


def euler_step(phase: Phase, h: float, rates: Phase) -> Phase:
    """Return the phase after a step of h [s] at these rates."""
    return tuple(value + h * rate for value, rate in zip(phase, rates, strict=True))


def rk4(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """The classical Runge-Kutta method."""
    theta, omega = phase
    half = h / 2
    sixth = h / 6
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


def heun(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Heun's method: the mean of the slopes at both ends of a step of explicit Euler."""
    theta, omega = phase
    half = h / 2
    while True:
        a = force(theta)
        omega_end = omega + h * a
        a_end = force(theta + h * omega)
        theta = theta + half * (omega + omega_end)
        omega = omega + half * (a + a_end)
        yield theta, omega


def explicit_midpoint(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """The explicit midpoint rule: the slope in the middle of a step of explicit Euler."""
    theta, omega = phase
    half = h / 2
    while True:
        a_half = force(theta + half * omega)
        theta = theta + h * (omega + half * force(theta))
        omega = omega + h * a_half
        yield theta, omega


def rk4_on_rates(rates: Rates, phase: Phase, h: float) -> Iterator[Phase]:
    """The classical Runge-Kutta method on a first-order system."""
    while True:
        k1 = rates(phase)
        k2 = rates(euler_step(phase, h / 2, k1))
        k3 = rates(euler_step(phase, h / 2, k2))
        k4 = rates(euler_step(phase, h, k3))
        slopes = zip(k1, k2, k3, k4, strict=True)
        phase = euler_step(phase, h / 6, tuple(a + 2 * b + 2 * c + d for a, b, c, d in slopes))
        yield phase


EXPLICIT_EULER = Method(
    key="explicit_euler",
    label="Explicit Euler",
    letter="e",
    hue=0,
    phases=explicit_euler,
    formula="theta' = theta + h omega;  omega' = omega + h a(theta)",
    order=1,
    force_evaluations=1,
    linear_limit=0.0,
    other_names=("forward Euler",),
    reference=f"{HAIRER}, I.1.2",
    used="equations with additive noise (Euler-Maruyama): Brian 2 [brian2.readthedocs.io, "
    "Numerical integration]",
    others={"rates": explicit_euler_on_rates},
    models=tuple(MODELS),
)

RK4 = Method(
    key="rk4",
    label="RK4",
    letter="r",
    hue=3,
    phases=rk4,
    formula="y' = y + h/6 (k1 + 2 k2 + 2 k3 + k4), with slopes k at the start, twice in the "
    "middle, and at the end",
    order=4,
    force_evaluations=4,
    linear_limit=2 * math.sqrt(2),
    other_names=("classical Runge-Kutta",),
    reference=f"{HAIRER}, II.1.1",
    used="energy-conserving systems in MuJoCo, integrator RK4 [mujoco.readthedocs.io, Computation]",
    others={"rates": rk4_on_rates},
    models=tuple(MODELS),
)

_GAINS = "It gains energy: a step multiplies that of small swings by 1 + z⁴/4."

HEUN = Method(
    key="heun",
    label="Heun",
    letter="w",
    phases=heun,
    formula="y' = y + h/2 (k1 + k2), with slopes k at the start and the end of an "
    "explicit Euler step",
    order=2,
    force_evaluations=2,
    linear_limit=0.0,
    other_names=("RK2", "improved Euler", "explicit trapezoidal rule"),
    reference=f"{HAIRER}, II.1.1",
    used="equations with multiplicative noise: Brian 2, heun [brian2.readthedocs.io, Numerical "
    "integration]",
    note=_GAINS,
)

EXPLICIT_MIDPOINT = Method(
    key="explicit_midpoint",
    label="Explicit midpoint",
    letter="q",
    phases=explicit_midpoint,
    formula="y' = y + h k2, with slope k2 in the middle of an explicit Euler step",
    order=2,
    force_evaluations=2,
    linear_limit=0.0,
    other_names=("modified Euler",),
    reference=f"{HAIRER}, II.1.1",
    used="neurons: Brian 2, rk2 [brian2.readthedocs.io, Numerical integration]",
    note=_GAINS,
)

FAMILY = (RK4, HEUN, EXPLICIT_MIDPOINT)
