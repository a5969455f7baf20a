"""Modified (shadow) energies: what the symplectic methods conserve instead of the energy.

A symplectic method with a constant step follows the exact flow of a nearby energy, but for terms of
higher order.  Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), IX.3 and IX.8.
"""

from collections.abc import Callable

from pendu_tui.engine.models.model import Model, Phase

ModifiedEnergy = Callable[[Model, Phase, float], float]
"""(model, (theta, omega), h [s]) -> modified energy [s⁻²]."""


def _modified(moving: float, pulled: float) -> ModifiedEnergy:
    """Return H + h² (moving omega² f'(theta) + pulled f(theta)²)/24 [s⁻²], where f is the force.

    What remains oscillates with h⁴.
    """

    def modified_energy(model: Model, phase: Phase, h: float) -> float:
        theta, omega = phase
        force = float(model.force()(theta))
        parts = moving * omega * omega * model.slope(theta) + pulled * force * force
        modified: float = model.energy()(phase) + h * h / 24 * parts
        return modified

    return modified_energy


velocity_verlet_modified_energy = _modified(-2, -1)
position_verlet_modified_energy = _modified(1, 2)
implicit_midpoint_modified_energy = _modified(1, -1)  # for small swings a multiple of H


def symplectic_euler_modified_energy(model: Model, phase: Phase, h: float) -> float:
    """Return velocity Verlet's modified energy half a kick later, where the two methods agree."""
    theta, omega = phase
    return velocity_verlet_modified_energy(model, (theta, omega + h / 2 * model.force()(theta)), h)
