"""Scene: everything that determines a run."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import USUAL_CAST, Cast
from pendu_tui.engine.models import COMMON, DEFAULT_MODEL, MODELS, NUMBERS
from pendu_tui.engine.models.model import ExactMotion, Model, Number
from pendu_tui.engine.quantities import ENERGY_ERROR

MAX_METHODS = 6  # of a cast: more cannot be told apart on a screen
Z_LIMITS = (1e-9, 1e3)  # z = h·w0; the methods' own limits lie at 2 and 2√2


def check_h(h: float, w0: float, forwards: bool = False) -> None:
    """Raise InputError unless |h|, or `forwards` h itself, is a usable step for this w0."""
    low, high = Z_LIMITS
    if not low <= (h if forwards else abs(h)) * w0 <= high:  # also refuses nan
        raise InputError(
            f"h = {h:g} s is not a usable step; use {low / w0:.2g} to {high / w0:.2g} s, for "
            f"example {0.15 / w0:.1g}."
        )


def _check_range(number: Number, value: float, w0: float = math.inf) -> None:
    """Raise InputError unless a value of the number lies within its limits for this w0 [rad/s]."""
    high = min(number.max, number.max_over_w0 * w0)
    if not number.min <= value <= high:  # also refuses nan
        limits = f"{number.min:g} to {high:g} {number.unit}"
        raise InputError(f"{number.name} = {value:g} {number.unit} is out of range; use {limits}.")


def _complete(model: str, given: Mapping[str, float]) -> dict[str, float]:
    """Return a model's parameters in its order, with defaults for those that are not given."""
    own = {each.name: each.default for each in MODELS[model].parameters}
    for name, value in given.items():
        if name not in own and value:
            owners = [key for key, other in MODELS.items() if NUMBERS.get(name) in other.parameters]
            why = f"the model {model} has no {name}; {' or '.join(owners)} does"
            raise InputError(f"{why}: choose a scene of that model.")
    return {name: given.get(name, default) for name, default in own.items()}


@dataclass(frozen=True)
class Line:
    """A reference line in the chart of its quantity, or on both sides of zero in phase space."""

    quantity: str  # of a chart, or "omega"
    value: float
    name: str


@dataclass(frozen=True)
class Shot:
    """How a lab shows a run, and what a lesson asks about it; it changes no number of the start."""

    view: str = "lab"
    theta: float | None = None  # rad, from the middle of phase space to its edge; None: the motion
    quantity: str = ENERGY_ERROR.name  # of the chart
    log: bool = True
    seconds: float | None = None  # of the chart; None: all
    line: Line | None = None
    front: tuple[str, ...] = ()  # keys of the methods that are shown; (): all
    ring: bool = False  # of neighbouring starts in phase space
    under: float | None = None  # s, the step size of a run laid under this one, in a lesson
    moment: float | None = None  # s, simulated, of a pause
    sentence: str = ""  # shown there
    question: str = ""  # asked there
    answers: tuple[str, ...] = ()
    right: int = 1  # the number of the right answer
    truth: str = ""  # told after the answer
    equal_cost: bool = False  # each method gets the same number of force evaluations
    returns: bool = False  # time reverses at the moment; the pause comes at t = 0


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything that determines a run, with a name and what to watch."""

    name: str = "custom"
    theta: float = NUMBERS["theta"].default  # rad from the downward vertical
    omega: float = NUMBERS["omega"].default  # rad/s
    length: float = NUMBERS["length"].default  # m
    gravity: float = NUMBERS["gravity"].default  # m/s²
    h: float = NUMBERS["h"].default  # s, the step size; positive at a start
    watch: str = ""
    model: str = DEFAULT_MODEL  # a key of MODELS
    cast: Cast = USUAL_CAST  # the methods, in order
    # the model's own, such as friction
    parameters: Mapping[str, float] = field(default_factory=dict, hash=False)
    # a common belief about such scenes, and what is true of it
    often_said: str = field(default="", compare=False)
    speed: float = field(default=1.0, compare=False)  # of the lab, in real time
    shot: Shot = field(default=Shot(), compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "parameters", _complete(self.model, self.parameters))
        for each in COMMON:
            if each.name != "h":  # its limits depend on w0
                _check_range(each, getattr(self, each.name))
        for each in MODELS[self.model].parameters:
            _check_range(each, self.parameters[each.name], self.w0)
        check_h(self.h, self.w0, forwards=True)
        if not 0 < self.speed < math.inf:
            raise InputError(
                f"speed = {self.speed:g} is not usable; use a number above zero, 1 for real time."
            )
        for method in self.cast:
            if self.model not in method.models:
                suited = " or ".join(method.models)
                why = f"{method.label} is not for the model {self.model}"
                raise InputError(f"{why}; it is for {suited}: choose a scene of such a model.")

    @property
    def equations(self) -> Model:
        """The model with this scene's parameters."""
        model: Callable[..., Model] = MODELS[self.model]
        return model(self.w0_squared, *self.parameters.values())

    @property
    def numbers(self) -> dict[str, float]:
        """The numbers that determine the run."""
        return {each.name: getattr(self, each.name) for each in COMMON} | dict(self.parameters)

    def exact(self) -> ExactMotion:
        """The exact motion from the scene's initial state."""
        return self.equations.exact(self.theta, self.omega)

    @property
    def w0_squared(self) -> float:
        """g/L [s⁻²]."""
        return self.gravity / self.length

    @property
    def w0(self) -> float:
        """Natural frequency sqrt(g/L) [rad/s]."""
        return math.sqrt(self.w0_squared)

    @property
    def z(self) -> float:
        """The step times the highest frequency, as a rule h·w0."""
        return self.h * self.equations.fastest

    @property
    def why_not_mapped(self) -> str:
        """Why studies and maps do not apply to this scene, as a sentence; "" if they do."""
        if why := self.equations.without_force:
            return why
        counted = [method for method in self.cast if method.force_evaluations]
        names = ", ".join(method.label for method in counted if not method.general)
        if names:
            return f"Maps and studies apply to methods that take any force, not to {names}."
        return ""

    @property
    def why_no_ring(self) -> str:
        """Why the cast cannot carry a ring of neighbouring states, as a sentence; "" if it can."""
        if why := self.equations.without_ring:
            return why
        names = ", ".join(method.label for method in self.cast if not method.any_numbers)
        if names:
            return f"No ring with {names} among the methods."
        return ""

    def fields(self) -> dict[str, Any]:
        """All fields that determine the run, with its name, as JSON shows them."""
        named = {"name": self.name, **self.numbers, "watch": self.watch, "model": self.model}
        return named | {"methods": [method.key for method in self.cast]}

    def altered(self, **changes: Any) -> "Scene":
        """Return the scene with other fields or parameters; its name stays if nothing changes."""
        fields = {name: value for name, value in changes.items() if name in self.__slots__}
        others = {name: value for name, value in changes.items() if name not in fields}
        if fields.get("model", self.model) != self.model:
            fields["parameters"] = {}
        if others:
            fields["parameters"] = {**fields.get("parameters", self.parameters), **others}
        if all(value == getattr(self, name) for name, value in fields.items()):
            return self
        return replace(
            self, **{**fields, "name": "custom", "watch": "", "often_said": "", "shot": Shot()}
        )

    def with_cast(self, cast: Cast) -> "Scene":
        """Return the scene with other methods; `watch` stays if all its methods stay."""
        watch = self.watch if set(self.cast) <= set(cast) else ""
        return replace(self, cast=cast, watch=watch)
