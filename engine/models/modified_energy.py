"""Modified (shadow) energies: what the symplectic methods conserve instead of the energy.

A symplectic method with a constant step follows, but for terms of higher order, the exact flow of
a nearby energy.  The energy itself then wobbles and comes back; the modified energy looks flat.
Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), IX.3 and IX.8.
"""

from collections.abc import Callable

from engine.models.model import Model, Phase

ModifiedEnergy = Callable[[Model, Phase, float], float]
"""(model, (theta, omega), h [s]) -> modified energy [s⁻²]."""


def velocity_verlet_modified_energy(model: Model, phase: Phase, h: float) -> float:
    """Return H - h² (2 omega² f'(theta) + f(theta)²)/24 [s⁻²], where f is the force.

    What remains oscillates with h⁴.
    """
    omega, force, slope, energy = _parts(model, phase)
    return energy - h * h / 24 * (2 * omega * omega * slope + force * force)


def symplectic_euler_modified_energy(model: Model, phase: Phase, h: float) -> float:
    """Return Verlet's modified energy half a kick later.

    Symplectic Euler is velocity Verlet seen between its kicks.
    """
    theta, omega = phase
    return velocity_verlet_modified_energy(model, (theta, omega + h / 2 * model.force()(theta)), h)


def position_verlet_modified_energy(model: Model, phase: Phase, h: float) -> float:
    """H + h² (omega² f'(theta) + 2 f(theta)²)/24 [s⁻²], f being the force."""
    omega, force, slope, energy = _parts(model, phase)
    return energy + h * h / 24 * (omega * omega * slope + 2 * force * force)


def implicit_midpoint_modified_energy(model: Model, phase: Phase, h: float) -> float:
    """Return H + h² (omega² f'(theta) - f(theta)²)/24 [s⁻²], where f is the force.

    For small swings it is a multiple of H.
    """
    omega, force, slope, energy = _parts(model, phase)
    return energy + h * h / 24 * (omega * omega * slope - force * force)


def _parts(model: Model, phase: Phase) -> tuple[float, float, float, float]:
    """Return omega, the force, its slope and the energy."""
    theta, omega = phase
    return omega, float(model.force()(theta)), model.slope(theta), float(model.energy()(phase))
