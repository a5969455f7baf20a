"""The model: a frictionless pendulum, and no more than that.

theta'' = -w0² sin theta.  Mass cancels; energies are per unit m·L², in s⁻².
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from engine.models.state import Acceleration

Sine = Callable[[Any], Any]


def acceleration(w0_squared: float, sin: Sine = math.sin) -> Acceleration:
    """theta -> -w0² sin theta [rad/s²].  Pass the `sin` of your numbers: NumPy's, cmath's, mpmath's."""

    def pendulum_acceleration(theta: Any) -> Any:
        return -w0_squared * sin(theta)

    return pendulum_acceleration


def energy(w0_squared: float, theta: Any, omega: Any, sin: Sine = math.sin) -> Any:
    """omega²/2 + 2 w0² sin²(theta/2) [s⁻²].

    Equal to omega²/2 + w0² (1 - cos theta), which would cancel to nothing near the bottom.
    """
    half = sin(theta / 2)
    return omega * omega / 2 + 2 * w0_squared * half * half


def separatrix_energy(w0_squared: float) -> float:
    """2 w0² [s⁻²]: below it the pendulum swings (libration), above it spins (rotation)."""
    return 2 * w0_squared


def separatrix_margin(w0: float, theta: Any, omega: Any, cos: Callable[[Any], Any] = math.cos) -> Any:
    """1 - E/E_separatrix: 1 at rest, 0 on the separatrix, negative in rotation.  Pass the `cos` of your numbers.

    The product of two numbers of which one is exact near the separatrix, where 1 - E/E_separatrix
    itself would cancel.
    """
    c, v = cos(theta / 2), omega / (2 * w0)
    return (c - v) * (c + v)


class EnergyReference(NamedTuple):
    """What the energy errors of a run are relative to."""

    start: float  # s⁻², the energy at the start
    scale: float  # s⁻², the same, or 2 w0² where that is zero

    def error(self, energy: float) -> float:
        return (energy - self.start) / self.scale


def energy_reference(w0_squared: float, theta: float, omega: float) -> EnergyReference:
    """The reference of a run that starts at theta [rad] and omega [rad/s]."""
    start: float = energy(w0_squared, theta, omega)
    return EnergyReference(start, start if start > 0 else separatrix_energy(w0_squared))
