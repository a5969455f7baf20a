"""The Verlet methods: half a kick, a drift, half a kick; or half a drift, a kick, half a drift."""

from collections.abc import Iterator

from pendu_tui.engine.methods.method import HAIRER, Method
from pendu_tui.engine.models.model import Force, Phase
from pendu_tui.engine.models.modified_energy import (
    position_verlet_modified_energy,
    velocity_verlet_modified_energy,
)


def velocity_verlet(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Velocity Verlet: half a kick, a drift, half a kick; the last force is used again."""
    theta, omega = phase
    half = h / 2
    a = force(theta)
    while True:
        omega_half = omega + half * a
        theta = theta + h * omega_half
        a = force(theta)
        omega = omega_half + half * a
        yield theta, omega


def position_verlet(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Position Verlet: half a drift, a kick, half a drift."""
    theta, omega = phase
    half = h / 2
    while True:
        theta_half = theta + half * omega
        omega = omega + h * force(theta_half)
        theta = theta_half + half * omega
        yield theta, omega


VELOCITY_VERLET = Method(
    key="velocity_verlet",
    label="Velocity Verlet",
    letter="v",
    hue=2,
    phases=velocity_verlet,
    formula="omega½ = omega + h/2 a(theta);  theta' = theta + h omega½;  omega' = omega½ + h/2 "
    "a(theta')",
    order=2,
    force_evaluations=1,
    first_same_as_last=True,
    symplectic=True,
    reversible=True,
    linear_limit=2.0,
    other_names=("Verlet", "Störmer-Verlet", "leapfrog", "kick-drift-kick"),
    reference=f"{HAIRER}, I.1.4",
    used="molecular dynamics: the default of LAMMPS [docs.lammps.org, run_style]",
    modified_energy=velocity_verlet_modified_energy,
    models=("pendulum", "linear", "spring"),
)

POSITION_VERLET = Method(
    key="position_verlet",
    label="Position Verlet",
    letter="o",
    phases=position_verlet,
    formula="theta½ = theta + h/2 omega;  omega' = omega + h a(theta½);  theta' = theta½ + h/2 "
    "omega'",
    order=2,
    force_evaluations=1,
    symplectic=True,
    reversible=True,
    linear_limit=2.0,
    other_names=("drift-kick-drift",),
    reference=f"{HAIRER}, VI.3.1",
    used="planets: REBOUND, integrator leapfrog [rebound.readthedocs.io, Integrators]",
    modified_energy=position_verlet_modified_energy,
    models=("pendulum", "linear", "spring"),
)

FAMILY = (VELOCITY_VERLET, POSITION_VERLET)
