"""Model: the physics that methods integrate, and the exact motion that they are compared with."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, ClassVar, Literal, NamedTuple

from pendu_tui.engine.inputs import angle, number, seconds, start_angle
from pendu_tui.engine.quantities import CHARTED, ENERGY_ERROR, Chart, Head, Quantity

Phase = tuple[Any, ...]
"""(theta, omega) as methods take and yield it: a plain tuple, because it is fast.

The numbers are floats, complex, NumPy arrays or mpmath numbers.  Some models have others, or more;
`Model.observe` reads any phase.
"""

Force = Callable[[Any], Any]
"""theta in rad -> theta'' in rad/s²."""

Energy = Callable[[Phase], Any]
"""(theta, omega) -> energy [s⁻²], per unit m·L²."""

Rates = Callable[[Phase], Phase]
"""A phase -> the time derivative of each of its numbers."""

Step = Callable[[Phase, float], Phase]
"""(phase, h) -> the phase after h [s]."""

Sine = Callable[[Any], Any]

Offer = Literal["force", "rates", "parts"]
"""What a method takes of a model: the name of the function that returns it."""


class State(NamedTuple):
    """A point of phase space."""

    theta: float  # rad from the downward vertical, unwrapped
    omega: float  # rad/s


class ExtraColumn(NamedTuple):
    """A column of a model's readings in tables, besides the common ones."""

    head: str
    wide_head: str  # where there is room
    about: str
    value: Callable[[Mapping[str, float]], float]  # of Reading.extra


NO_EXTRA: Mapping[str, float] = {}


class Observation(NamedTuple):
    """A phase as floats by name."""

    theta: float  # rad from the downward vertical, unwrapped
    omega: float  # rad/s
    extra: Mapping[str, float] = NO_EXTRA  # the model's own variables, `Model.variables`


class EnergyReference(NamedTuple):
    """What the energy errors of a run are relative to."""

    start: float  # s⁻², the energy at the start
    scale: float  # s⁻², its size, or 2 w0² where that is zero
    true: Callable[[float], float] | None = None  # energy [s⁻²] at a time [s], if not conserved
    least: float = 1e-300  # s⁻²; energies below are mostly rounding, and are replaced by it

    def errors(self, t: float, *energies: float) -> list[float]:
        """Return (E - E0)/|E0| for each energy at a time [s]; ln(E/E_true) if not conserved."""
        if self.true is None:
            return [(energy - self.start) / self.scale for energy in energies]
        true = self._log(self.true(t))
        return [self._log(energy) - true for energy in energies]

    def _log(self, energy: float) -> float:
        """Return ln of an energy [s⁻²], finite even if the energy is 0 or inf."""
        return math.log(min(max(energy, self.least), 1e300))


ENERGY_RATIO = ENERGY_ERROR._replace(
    label="ln(E/E_true)",
    head=Head("ln E/Et", 8, "ln E/Et", 8),
    sentence="ln of the energy over the energy of the exact motion, which also falls",
    chart=Chart("ln(E/E_true)", "|ln(E/E_true)|"),
)
"""The energy error of a model that does not conserve its energy."""

Regime = Literal["libration", "rotation", "separatrix", "equilibrium"]


class ExactMotion(NamedTuple):
    """The exact motion from one initial state."""

    at: Callable[[float], State]  # at any time [s]
    regime: Regime
    period: float | None = None  # s, of a swing or turn; None: not periodic
    accuracy: float = 0.0  # rad, largest error of theta in the first minute; 0: closed form


_HALF = (
    0.13020248308889008088,
    0.56116298177510838456,
    -0.38947496264484728641,
    0.15884190655515560090,
    -0.39590389413323757734,
    0.18453964097831570709,
    0.25837438768632204729,
    0.29501172360931029887,
)
WEIGHTS = (*_HALF, -0.60550853383003451170, *_HALF[::-1])
"""Of a composition of order 8: Kahan & Li, Math. Comput. 66 (1997) 1089."""

ACCURACY = 1e-10  # rad, of theta, with the steps that the models give it
MAX_SPEED = 800  # w0; beyond, gravity does little
EVERY = 64  # steps from one kept phase to the next


def compose(step: Step) -> Step:
    """Return a step of order 8, composed of a symmetric step of order 2."""

    def composed(phase: Phase, h: float) -> Phase:
        for weight in WEIGHTS:
            phase = step(phase, weight * h)
        return phase

    return composed


def compose_verlet(force: Force, friction: float = 0.0) -> Step:
    """Return the composition of velocity Verlet, or with friction [s⁻¹] of conformal Verlet.

    Adjacent parts share a force.
    """

    def composed(phase: Phase, h: float) -> Phase:
        position, velocity = phase
        a = force(position)
        for weight in WEIGHTS:
            part = weight * h
            damping = math.exp(-friction * part / 2)
            velocity = velocity * damping + part / 2 * a
            position = position + part * velocity
            a = force(position)
            velocity = (velocity + part / 2 * a) * damping
        return position, velocity

    return composed


class Reference:
    """The motion from a start, computed on demand; its bits do not depend on earlier calls."""

    def __init__(self, step: Step, start: Phase, h: float) -> None:
        self._step = step
        self._h = h  # s
        self._kept = {0: start}  # by number of steps, which may be negative
        self._last = 0, start  # the last whole step of the previous call

    def at(self, t: float) -> Phase:
        """Return the phase at a time [s], after whole steps and a shorter one."""
        steps = int(t / self._h)
        way = int(math.copysign(1, steps))
        begin = steps // (way * EVERY) * way * EVERY
        while begin not in self._kept:
            begin -= way * EVERY
        phase = self._kept[begin]
        last, last_phase = self._last
        if begin * way <= last * way <= steps * way:
            begin = last
            phase = last_phase
        try:
            for n in range(begin + way, steps + way, way):
                phase = self._step(phase, way * self._h)
                if n % EVERY == 0:
                    self._kept[n] = phase
            self._last = steps, phase
            rest = t - steps * self._h
            if rest:
                return self._step(phase, rest)
            return phase
        except (ValueError, ArithmeticError):
            return phase  # long before the start friction makes it faster than doubles hold


class Number(NamedTuple):
    """A number of a scene, or of its model's equations."""

    name: str  # of the field, in scenes, files, recordings and on the command line
    unit: str
    about: str  # in the help of its option
    min: float  # inclusive
    max: float  # inclusive; a larger value is a typo
    default: float = 0.0
    read: Callable[[str], float] = number
    hint: str = ""  # beside its field in a form, after the unit
    metavar: str = "NUMBER"
    max_over_w0: float = math.inf


COMMON = (
    Number(
        "theta",
        "rad",
        "initial angle from straight down: 2 (in rad), pi/2 or 115deg",
        min=-1e9,
        max=1e9,
        default=1.0,
        read=start_angle,
        hint=", or 115deg",
        metavar="RAD|DEGdeg",
    ),
    Number(
        "omega",
        "rad/s",
        "initial angular velocity: 2 (in rad/s) or 30deg/s",
        min=-1e9,
        max=1e9,
        read=angle,
        hint=", or 90deg/s",
        metavar="RAD_S",
    ),
    Number("length", "m", "length in m", min=1e-6, max=1e6, default=1.0, metavar="M"),
    Number("gravity", "m/s²", "gravity in m/s²", 1e-6, 1e6, default=9.81, metavar="M_S2"),
    Number(
        "h",
        "s",
        "step size: 0.05 (in s) or 50ms",
        min=0.0,  # its limits depend on w0: engine.scenes.check_h
        max=math.inf,
        default=0.05,
        read=seconds,
        hint=", the step size",
        metavar="S",
    ),
)
"""The numbers of every scene; a model adds its own."""


class Model(ABC):
    """Equations of motion: a frozen dataclass of their parameters.

    `offers` names what methods can take of it, the best first: its `force`, if it is
    theta'' = force(theta), its `rates` as a first-order system, or the `parts` of its equations.
    """

    key: ClassVar[str]  # in scenes, recordings and on the command line
    equation: ClassVar[str]  # for people
    parameters: ClassVar[tuple[Number, ...]] = ()  # the fields after w0_squared, in order
    turns: ClassVar[bool]  # theta + 2 pi is the same place, and it can go over the top
    is_linear: ClassVar[bool] = False  # a stable step stays stable, and none is chaotic
    offers: ClassVar[tuple[Offer, ...]] = ("force", "parts")
    counted_parts: ClassVar[tuple[str, ...]] = ("force",)  # of `parts`, as force evaluations
    rigid: ClassVar[bool] = True  # the bob stays at one distance from the pivot
    variables: ClassVar[tuple[Quantity, ...]] = ()  # besides those of QUANTITIES
    extra_columns: ClassVar[tuple[ExtraColumn, ...]] = ()
    error: ClassVar[Quantity] = ENERGY_ERROR  # ENERGY_RATIO, if it does not conserve its energy
    frequency_symbol: ClassVar[str] = "w0"  # of `fastest`
    has_separatrix: ClassVar[bool] = False  # where `level` is 0
    caption: ClassVar[str] = ""  # of a phase portrait that does not follow curves of equal energy
    without_force: ClassVar[str] = ""  # why studies and maps do not apply; "": they do
    without_ring: ClassVar[str] = ""  # why a ring of neighbouring starts does not apply

    w0_squared: float  # the square of the frequency of small swings [s⁻²]

    @classmethod
    def charted(cls) -> tuple[Quantity, ...]:
        """Return the quantities that charts can show, the energy error first."""
        own = (each for each in cls.variables if each.chart.title)
        return cls.error, *own, *CHARTED[1:]

    @property
    def conserves_energy(self) -> bool:
        """Whether it conserves its energy; else energy errors are ln(E/E_true)."""
        return self.error is ENERGY_ERROR

    @property
    def w0(self) -> float:
        """The frequency of small swings [rad/s]."""
        return math.sqrt(self.w0_squared)

    @property
    def fastest(self) -> float:
        """The highest frequency [rad/s], which limits h."""
        return self.w0

    def start(self, theta: float, omega: float) -> Phase:
        """Return the first phase of a run from theta [rad] and omega [rad/s]."""
        return theta, omega

    def rest_phase(self, theta: float) -> Phase:
        """Return the phase of least energy at an angle [rad]."""
        return theta, 0.0

    def observe(self, phase: Phase) -> Observation:
        """Return angle, angular velocity and the model's own variables of a phase."""
        theta, omega = phase
        return Observation(float(theta), float(omega))  # a method may carry other numbers

    def theta_error(self, theta: float, exact: float) -> float:
        """Return theta - exact theta [rad]."""
        return theta - exact

    def length(self, extra: Mapping[str, float]) -> float:
        """Return the distance of the bob from the pivot, over the length at rest."""
        return 1.0

    def force(self, sin: Sine = math.sin) -> Force:
        """Return the force for numbers with this `sin`: NumPy's, cmath's, mpmath's."""
        raise NotImplementedError

    def slope(self, theta: float) -> float:
        """Return d force / d theta [s⁻²]."""
        raise NotImplementedError

    def rates(self, sin: Sine = math.sin) -> Rates:
        """Return the equations as a first-order system, for the same numbers."""
        raise NotImplementedError

    def parts(self, sin: Sine = math.sin) -> Any:
        """Return the parts of the equations for this model's methods."""
        return self

    @abstractmethod
    def energy(self, sin: Sine = math.sin) -> Energy:
        """Return the energy, for the same numbers."""

    def reference(self, theta: float, omega: float) -> EnergyReference:
        """Return what energy errors from theta [rad] and omega [rad/s] are relative to."""
        energy = self.energy()
        start: float = energy(self.start(theta, omega))
        scale = abs(start) or 2 * self.w0_squared
        if self.conserves_energy:
            return EnergyReference(start, scale)
        least = max(1e-24 * min(self.w0_squared, scale), 1e-300)  # of 1e-12 rad
        return EnergyReference(
            start, scale, lambda t: energy(self.exact_phase(theta, omega, t)), least
        )

    def exact(self, theta: float, omega: float) -> ExactMotion:
        """Return the exact motion from theta [rad] and omega [rad/s], here by steps of order 8."""

        def at(t: float) -> State:
            return State(*self.observe(self.exact_phase(theta, omega, t))[:2])

        return ExactMotion(at, self.regime(theta, omega), accuracy=ACCURACY)

    def regime(self, theta: float, omega: float) -> Regime:
        """Return the kind of motion that the energy at the start allows."""
        energy = self.energy()
        start = energy(self.start(theta, omega))
        if start == energy(self.rest_phase(0.0)):
            return "equilibrium"
        return "libration" if start < energy(self.rest_phase(math.pi)) else "rotation"

    def exact_phase(self, theta: float, omega: float, t: float) -> Phase:
        """Return the phase at a time [s] by steps of order 8."""
        return _reference(self, theta, omega).at(t)

    def exact_step(self) -> tuple[Step, float]:
        """Return the step of order 8, and the size [s] with which it is accurate to ACCURACY."""
        return compose_verlet(self.force()), 0.05 / self.fastest

    def invariant(self) -> Callable[[Phase], float] | None:
        """Return a positive invariant besides the energy, or None."""
        return None

    def exact_length(self, theta: float, omega: float, t: float) -> float:
        """Return the bob's exact distance from the pivot at a time [s], over the rest length."""
        return 1.0

    def area_share(self, t: float) -> float:
        """Return the share of a phase-space area that the exact flow leaves after a time [s]."""
        return 1.0

    def level(self, theta: Any, omega: Any, cos: Sine = math.cos) -> Any:
        """Return a function of the energy alone, 1 - E/E_separatrix if there is a separatrix."""
        return 0 * (theta + omega)


@lru_cache
def _reference(model: Model, theta: float, omega: float) -> Reference:
    step, h = model.exact_step()
    speed = min(max(abs(omega), model.w0), MAX_SPEED * model.w0)
    return Reference(step, model.start(theta, omega), min(h, 0.4 / speed))  # 0.4 rad
