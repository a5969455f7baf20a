"""Modified (shadow) energies: what the symplectic methods conserve instead of the energy.

A symplectic method with a constant step follows, but for terms of higher order, the exact flow of
a nearby energy.  The energy itself then wobbles and comes back; the modified energy looks flat.
Hairer, Lubich & Wanner, Geometric Numerical Integration (2006), IX.3 and IX.8.
"""

from math import cos, sin

from engine.models.pendulum import energy


def velocity_verlet_modified_energy(w0_squared: float, theta: float, omega: float, h: float) -> float:
    """H + h² (w0²/24) (2 omega² cos theta - w0² sin² theta) [s⁻²]; what remains wobbles with h⁴."""
    correction = 2 * omega * omega * cos(theta) - w0_squared * sin(theta) ** 2
    return float(energy(w0_squared, theta, omega)) + h * h * w0_squared / 24 * correction


def symplectic_euler_modified_energy(w0_squared: float, theta: float, omega: float, h: float) -> float:
    """Verlet's modified energy half a kick later: symplectic Euler is Verlet seen between its kicks."""
    return velocity_verlet_modified_energy(w0_squared, theta, omega - h / 2 * w0_squared * sin(theta), h)
