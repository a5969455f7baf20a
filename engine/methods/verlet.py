"""Velocity Verlet: half a kick, a drift, half a kick."""

from collections.abc import Iterator

from engine.methods.method import Method
from engine.models.model import Force, Phase
from engine.models.modified_energy import velocity_verlet_modified_energy


def velocity_verlet(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Velocity Verlet: half a kick, a drift, half a kick; the last force is the next step's first.

    Order 2, symplectic and reversible.  Hairer, Lubich & Wanner (2006), I.1.4.
    """
    theta, omega = phase
    half = h / 2
    a = force(theta)
    while True:
        omega_half = omega + half * a
        theta = theta + h * omega_half
        a = force(theta)
        omega = omega_half + half * a
        yield theta, omega


VELOCITY_VERLET = Method(
    key="velocity_verlet",
    label="Velocity Verlet",
    letter="v",
    hue=2,
    phases=velocity_verlet,
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
    models=("pendulum", "linear", "spring"),
)

FAMILY = (VELOCITY_VERLET,)
