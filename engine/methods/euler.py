"""The Euler methods: one force evaluation a step, order 1."""

from collections.abc import Iterator

from pendu_tui.engine.methods.method import HAIRER, Method
from pendu_tui.engine.models import FIRST_ORDER
from pendu_tui.engine.models.model import Force, Phase, Rates
from pendu_tui.engine.models.modified_energy import symplectic_euler_modified_energy


def explicit_euler(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Explicit (forward) Euler: both updates from the old state.

    The step's determinant is 1 + h² w0² cos theta.
    """
    theta, omega = phase
    while True:
        theta, omega = theta + h * omega, omega + h * force(theta)
        yield theta, omega


def explicit_euler_on_rates(rates: Rates, phase: Phase, h: float) -> Iterator[Phase]:
    """Explicit Euler on a first-order system.

    With friction, small swings gain energy from h = gamma/w0² on.
    """
    while True:
        phase = euler_step(phase, h, rates(phase))
        yield phase


def euler_step(phase: Phase, h: float, rates: Phase) -> Phase:
    """Return the phase after a step of h [s] at these rates."""
    return tuple(value + h * rate for value, rate in zip(phase, rates, strict=True))


def symplectic_euler(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Symplectic Euler: kick omega, then drift theta with the new omega."""
    theta, omega = phase
    while True:
        omega = omega + h * force(theta)
        theta = theta + h * omega
        yield theta, omega


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
    on_rates=explicit_euler_on_rates,
    models=("pendulum", "linear", *FIRST_ORDER),
)

SYMPLECTIC_EULER = Method(
    key="symplectic_euler",
    label="Symplectic Euler",
    letter="s",
    hue=1,
    phases=symplectic_euler,
    formula="omega' = omega + h a(theta);  theta' = theta + h omega'",
    order=1,
    force_evaluations=1,
    symplectic=True,
    linear_limit=2.0,
    other_names=("semi-implicit Euler", "Euler-Cromer"),
    reference=f"{HAIRER}, I.1.2",
    used="robots and physics simulation: the default of MuJoCo [mujoco.readthedocs.io, XML "
    "Reference, integrator]",
    modified_energy=symplectic_euler_modified_energy,
)

FAMILY = (EXPLICIT_EULER, SYMPLECTIC_EULER)
