"""What a model is: the physics that methods integrate, and what the rest of the lab asks of it."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, NamedTuple

Number = Any  # float, complex, NumPy array or mpmath number: one definition of a method serves them all

Phase = tuple[Number, Number]
"""(theta, omega) as a method takes and yields it: a bare tuple, the quickest value CPython builds."""

Force = Callable[[Number], Number]
"""theta in rad -> theta'' in rad/s²."""

Energy = Callable[[Phase], Number]
"""(theta, omega) -> energy [s⁻²], per unit m·L²."""

Sine = Callable[[Any], Any]


class State(NamedTuple):
    """A point of phase space."""

    theta: float  # rad from the downward vertical, unwrapped
    omega: float  # rad/s


class EnergyReference(NamedTuple):
    """What the energy errors of a run are relative to."""

    start: float  # s⁻², the energy at the start
    scale: float  # s⁻², the same, or 2 w0² where that is zero

    def error(self, energy: float) -> float:
        return (energy - self.start) / self.scale


Regime = Literal["libration", "rotation", "separatrix", "equilibrium"]


@dataclass(frozen=True, slots=True)
class ExactMotion:
    """The exact motion from one start."""

    at: Callable[[float], State]
    """The state at a time [s], negative times included; theta continues from the start, unwrapped."""
    regime: Regime
    period: float | None = None  # s, per swing or, in rotation, per turn; None: not periodic


class Model(ABC):
    """Equations of motion theta'' = force(theta): a frozen dataclass of their parameters."""

    key: ClassVar[str]  # in scenes, recordings and on the command line
    equation: ClassVar[str]  # for people
    turns: ClassVar[bool]  # whether theta + 2 pi is the same place, and it can go over the top

    w0_squared: float  # the square of the frequency of small swings [s⁻²]

    @property
    def w0(self) -> float:
        """The frequency of small swings [rad/s]."""
        return math.sqrt(self.w0_squared)

    @abstractmethod
    def force(self, sin: Sine = math.sin) -> Force:
        """The force.  Pass the `sin` of your numbers: NumPy's, cmath's, mpmath's."""

    @abstractmethod
    def slope(self, theta: float) -> float:
        """d force / d theta [s⁻²]."""

    @abstractmethod
    def energy(self, sin: Sine = math.sin) -> Energy:
        """The energy, for the same numbers."""

    @abstractmethod
    def exact(self, theta: float, omega: float) -> ExactMotion:
        """The exact motion from theta [rad] and omega [rad/s]."""

    def reference(self, theta: float, omega: float) -> EnergyReference:
        """What the energy errors of a run from theta [rad] and omega [rad/s] are relative to."""
        start: float = self.energy()((theta, omega))
        return EnergyReference(start, start if start > 0 else 2 * self.w0_squared)
