"""The four methods, each written as in the book, and the list that everything else derives from.

A method is a plain function (acceleration, phase, h) -> phase with only + and * on the phase.  It
therefore runs unchanged on floats, NumPy arrays, complex numbers, mpmath numbers and under Numba.
To add a method, write its function and add its entry to METHODS.  Every field of an entry is a
claim, and tests/engine/test_methods.py measures each of them (test_shadow.py that of the shadow).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from engine.models.modified_energy import symplectic_euler_modified_energy, velocity_verlet_modified_energy
from engine.models.state import Acceleration, Phase

Step = Callable[[Acceleration, Phase, float], Phase]

ModifiedEnergy = Callable[[float, float, float, float], float]
"""(w0_squared [s⁻²], theta [rad], omega [rad/s], h [s]) -> shadow energy [s⁻²]."""


def explicit_euler(acceleration: Acceleration, phase: Phase, h: float) -> Phase:
    """Explicit (forward) Euler: both updates from the old state.

    theta' = theta + h omega,  omega' = omega + h a(theta).  Order 1.  Not symplectic: the step's
    determinant is 1 + h² w0² cos theta.  Hairer, Lubich & Wanner (2006), I.1.2.
    """
    theta, omega = phase
    return theta + h * omega, omega + h * acceleration(theta)


def symplectic_euler(acceleration: Acceleration, phase: Phase, h: float) -> Phase:
    """Symplectic Euler: kick omega, then drift theta with the new omega.

    omega' = omega + h a(theta),  theta' = theta + h omega'.  Order 1, symplectic.  Not reversible
    under omega -> -omega.  Hairer, Lubich & Wanner (2006), I.1.2 and VI.3.1.
    """
    theta, omega = phase
    omega = omega + h * acceleration(theta)
    return theta + h * omega, omega


def velocity_verlet(acceleration: Acceleration, phase: Phase, h: float) -> Phase:
    """Velocity Verlet: half a kick, a drift, half a kick.

    Order 2, symplectic and reversible.  The second half kick's acceleration is the next step's
    first ("first same as last"), so a loop that keeps it, as engine.run.loops does, pays one
    evaluation a step.  Hairer, Lubich & Wanner (2006), I.1.4.
    """
    theta, omega = phase
    omega_half = omega + h / 2 * acceleration(theta)
    theta = theta + h * omega_half
    return theta, omega_half + h / 2 * acceleration(theta)


def rk4(acceleration: Acceleration, phase: Phase, h: float) -> Phase:
    """The classical Runge-Kutta method of order 4.

    Neither symplectic nor reversible: det - 1 ~ h⁶, so it loses a little area on most of the plane and gains
    some beside upright.
    Hairer, Lubich & Wanner (2006), II.1.1.
    """
    theta, omega = phase
    a1 = acceleration(theta)
    omega2 = omega + h / 2 * a1
    a2 = acceleration(theta + h / 2 * omega)
    omega3 = omega + h / 2 * a2
    a3 = acceleration(theta + h / 2 * omega2)
    omega4 = omega + h * a3
    a4 = acceleration(theta + h * omega3)
    return (
        theta + h / 6 * (omega + 2 * omega2 + 2 * omega3 + omega4),
        omega + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4),
    )


@dataclass(frozen=True, slots=True)
class Method:
    """A method and what is claimed of it."""

    key: str  # in topics, JSON and on the command line
    label: str  # for people
    letter: str  # its mark on charts, never colour alone
    step: Step
    formula: str
    order: int  # global order on the nonlinear pendulum, over at most one period
    force_evaluations: int  # a step, with the last acceleration kept where first_same_as_last
    first_same_as_last: bool
    symplectic: bool  # the step's Jacobian has determinant 1
    reversible: bool  # the step and omega -> -omega undo each other
    linear_limit: float  # largest z = h·w0 that is stable on the linear oscillator; 0: none
    other_names: tuple[str, ...]
    reference: str
    used: str  # where, and in brackets who says so
    modified_energy: ModifiedEnergy | None = (
        None  # energy of which it keeps all but O(h⁴); None: none is known, or there is none
    )


METHODS: tuple[Method, ...] = (
    Method(
        key="explicit_euler",
        label="Explicit Euler",
        letter="e",
        step=explicit_euler,
        formula="theta' = theta + h omega;  omega' = omega + h a(theta)",
        order=1,
        force_evaluations=1,
        first_same_as_last=False,
        symplectic=False,
        reversible=False,
        linear_limit=0.0,
        other_names=("forward Euler",),
        reference="Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), I.1.2",
        used="equations with additive noise (Euler-Maruyama): Brian 2 [brian2.readthedocs.io, Numerical integration]",
    ),
    Method(
        key="symplectic_euler",
        label="Symplectic Euler",
        letter="s",
        step=symplectic_euler,
        formula="omega' = omega + h a(theta);  theta' = theta + h omega'",
        order=1,
        force_evaluations=1,
        first_same_as_last=False,
        symplectic=True,
        reversible=False,
        linear_limit=2.0,
        other_names=("semi-implicit Euler", "Euler-Cromer"),
        reference="Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), I.1.2",
        used="robots and physics simulation: the default of MuJoCo [mujoco.readthedocs.io, XML Reference, integrator]",
        modified_energy=symplectic_euler_modified_energy,
    ),
    Method(
        key="velocity_verlet",
        label="Velocity Verlet",
        letter="v",
        step=velocity_verlet,
        formula="omega½ = omega + h/2 a(theta);  theta' = theta + h omega½;  omega' = omega½ + h/2 a(theta')",
        order=2,
        force_evaluations=1,
        first_same_as_last=True,
        symplectic=True,
        reversible=True,
        linear_limit=2.0,
        other_names=("Störmer-Verlet", "leapfrog (kick-drift-kick)"),
        reference="Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), I.1.4",
        used="molecular dynamics: the default of LAMMPS [docs.lammps.org, run_style]",
        modified_energy=velocity_verlet_modified_energy,
    ),
    Method(
        key="rk4",
        label="RK4",
        letter="r",
        step=rk4,
        formula="y' = y + h/6 (k1 + 2 k2 + 2 k3 + k4), the slopes k at the start, twice the middle, the end",
        order=4,
        force_evaluations=4,
        first_same_as_last=False,
        symplectic=False,
        reversible=False,
        linear_limit=2 * math.sqrt(2),
        other_names=("classical Runge-Kutta",),
        reference="Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), II.1.1",
        used="energy-conserving systems in MuJoCo, integrator RK4 [mujoco.readthedocs.io, Computation]",
    ),
)
