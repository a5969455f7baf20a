"""Model: the physics that methods integrate, and what the rest of the lab needs to know of it."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
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


class Variable(NamedTuple):
    """A number that a model's readings have besides angle, angular velocity and energy."""

    name: str  # in recordings, JSON and --fail-if
    unit: str = ""
    about: str = ""
    is_state: bool = True
    """Whether it is a part of the phase.  Any other is a quantity of the phase, which charts can show."""
    relative: bool = False  # readings have it over its value at the start of the run


NO_EXTRA: Mapping[str, float] = {}


class Observation(NamedTuple):
    """A phase as floats by name."""

    theta: float  # rad from the downward vertical, unwrapped
    omega: float  # rad/s
    extra: Mapping[str, float] = NO_EXTRA
    """The values of the model's own variables, in the order of `Model.variables`."""


class EnergyReference(NamedTuple):
    """What the energy errors of a run are relative to."""

    start: float  # s⁻², the energy at the start
    scale: float  # s⁻², the same, or 2 w0² where that is zero
    true: Callable[[float], float] | None = None
    """The true motion's energy [s⁻²] at a time [s], where it is not conserved."""

    def error(self, energy: float, t: float = 0.0) -> float:
        """(E - E0)/E0, or where energy is not conserved ln(E/E_true) at this time [s]."""
        if self.true is None:
            return (energy - self.start) / self.scale
        return _log(energy) - _log(self.true(t))


def _log(energy: float) -> float:
    """The logarithm of an energy [s⁻²], finite also where there is none left, or too much for a double."""
    return math.log(min(max(energy, 1e-300), 1e300))


Regime = Literal["libration", "rotation", "separatrix", "equilibrium"]


class ExactMotion(NamedTuple):
    """The exact motion from one start."""

    at: Callable[[float], State]
    """The state at a time [s], negative times included; theta continues from the start, unwrapped."""
    regime: Regime
    period: float | None = None  # s, per swing or, in rotation, per turn; None: not periodic
    accuracy: float = 0.0  # rad; largest error of theta in the first minute; 0 where the motion has a closed form


class Model(ABC):
    """Equations of motion theta'' = force(theta): a frozen dataclass of their parameters.

    With friction the right side has a velocity as well, and in the plane a position is a complex number; the force
    then has attributes for the methods that need more than its value.
    """

    key: ClassVar[str]  # in scenes, recordings and on the command line
    equation: ClassVar[str]  # for people
    turns: ClassVar[bool]  # whether theta + 2 pi is the same place, and it can go over the top
    variables: ClassVar[tuple[Variable, ...]] = ()  # what its readings have besides theta, omega and energy
    rigid: ClassVar[bool] = True  # whether the bob stays at one distance from the pivot
    parameters: ClassVar[tuple[str, ...]] = ()  # fields of a scene, besides length and gravity
    plain: ClassVar[bool] = True  # theta'' = force(theta): it can be compiled and mapped, and its energy is conserved
    conserved: ClassVar[bool] = True  # whether the true motion keeps its energy

    w0_squared: float  # the square of the frequency of small swings [s⁻²]
    friction: float = 0.0  # s⁻¹

    @property
    def w0(self) -> float:
        """The frequency of small swings [rad/s]."""
        return math.sqrt(self.w0_squared)

    @property
    def fastest(self) -> float:
        """The highest frequency in it [rad/s], the one that limits h."""
        return self.w0

    def start(self, theta: float, omega: float) -> Phase:
        """The phase that a run from theta [rad] and omega [rad/s] starts with."""
        return theta, omega

    def still(self, theta: float) -> Phase:
        """The phase of least energy at an angle [rad]: at rest."""
        return theta, 0.0

    def observe(self, phase: Phase) -> Observation:
        """Return angle, angular velocity and the model's own variables of a phase."""
        theta, omega = phase
        return Observation(float(theta), float(omega))  # a method may carry other numbers

    def phase_of(self, theta: float, omega: float, extra: Mapping[str, float]) -> Phase:
        """Return the phase from which a method goes on after a reading with these values."""
        return theta, omega

    def theta_error(self, theta: float, exact: float) -> float:
        """Return theta - exact theta [rad]."""
        return theta - exact

    def length(self, extra: Mapping[str, float]) -> float:
        """Return the distance of the bob from the pivot, over the length at rest."""
        return 1.0

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
        start: float = self.energy()(self.start(theta, omega))
        return EnergyReference(start, start if start > 0 else 2 * self.w0_squared)
