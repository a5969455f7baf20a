"""Scene: everything that determines a run."""

import math
from dataclasses import dataclass, field, fields, replace
from functools import cache
from typing import Any

from engine.methods import USUAL_CAST, Cast
from engine.models import MODELS
from engine.models.model import ExactMotion, Model

LIMITS = {  # inclusive; a value beyond them is a typing error
    "theta": (-1e9, 1e9),
    "omega": (-1e9, 1e9),
    "length": (1e-6, 1e6),
    "gravity": (1e-6, 1e6),
}
PARAMETERS = {  # likewise, of models that have them; 0 in the scenes of other models
    "friction": (0.0, 100.0),
    "stiffness": (1.0, 1e18),
}
MOST_DAMPED = 100  # friction over w0: beyond, the pendulum creeps, and its reference takes too many steps
UNITS = {
    "theta": "rad",
    "omega": "rad/s",
    "length": "m",
    "gravity": "m/s²",
    "h": "s",
    "friction": "s⁻¹",
    "stiffness": "s⁻²",
}
MOST_METHODS = 6  # of a cast: more cannot be told apart on a screen
Z_LIMITS = (1e-9, 1e3)  # z = h·w0; the methods' own limits lie at 2 and 2√2


class SceneError(ValueError):
    """A scene that cannot be run; its text is a sentence for the user."""


def check_h(h: float, w0: float) -> None:
    """Raise SceneError unless |h| is a step that this pendulum can be given."""
    low, high = Z_LIMITS
    if not math.isfinite(h) or not low <= abs(h) * w0 <= high:
        raise SceneError(
            f"h = {h:g} s is not a usable step; use {low / w0:.2g} to {high / w0:.2g} s, for example {0.15 / w0:.1g}."
        )


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything that determines a run, with a name and what to watch."""

    name: str = "custom"
    theta: float = 1.0  # rad from the downward vertical
    omega: float = 0.0  # rad/s
    length: float = 1.0  # m
    gravity: float = 9.81  # m/s²
    h: float = 0.05  # s, the step size; positive at a start
    watch: str = ""
    model: str = "pendulum"  # a key of MODELS
    cast: Cast = USUAL_CAST  # the methods, in order
    friction: float = 0.0  # gamma [s⁻¹], of the model damped
    stiffness: float = 0.0  # spring constant over mass [s⁻²], of the model spring
    speed: float = field(default=1.0, compare=False)  # times real time, at which a lab starts: it changes no number

    def __post_init__(self) -> None:
        parameters = self.parameters
        for name in PARAMETERS:
            if name not in parameters and getattr(self, name):
                raise SceneError(f"the model {self.model} has no {name}; leave it out, or use a model that has.")
        for name, (low, high) in (LIMITS | {name: PARAMETERS[name] for name in parameters}).items():
            value, unit = getattr(self, name), UNITS[name]
            if name == "friction":
                high = min(high, MOST_DAMPED * self.w0)
            if not low <= value <= high:  # also refuses nan
                raise SceneError(f"{name} = {value:g} {unit} is out of range; use {low:g} to {high:g} {unit}.")
        if self.h <= 0:
            raise SceneError(
                f"h = {self.h:g} s is not a usable step; use a positive one, for example {0.15 / self.w0:.1g}."
            )
        check_h(self.h, self.w0)
        if not 0 < self.speed < math.inf:
            raise SceneError(f"speed = {self.speed:g} is not usable; use a number above zero, 1 for real time.")
        for method in self.cast:
            if self.model in MODELS and self.model not in method.models:
                raise SceneError(
                    f"{method.label} is not for the model {self.model}; it is for {' and '.join(method.models)}."
                )

    @property
    def equations(self) -> Model:
        """The model with this scene's parameters."""
        return _equations(self.model, self.w0_squared, *(getattr(self, name) for name in self.parameters))

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of the model's own parameters, such as friction; none for an unknown model."""
        return MODELS[self.model].parameters if self.model in MODELS else ()

    def exact(self) -> ExactMotion:
        """The exact motion from this scene's start."""
        return self.equations.exact(self.theta, self.omega)

    @property
    def w0_squared(self) -> float:
        """g/L [s⁻²], the only parameter of the motion."""
        return self.gravity / self.length

    @property
    def w0(self) -> float:
        """Natural frequency sqrt(g/L) [rad/s]."""
        return math.sqrt(self.w0_squared)

    @property
    def z(self) -> float:
        """h·w0, the only number that linear stability depends on; of a spring h times its frequency."""
        return self.h * self.equations.fastest

    @property
    def general(self) -> bool:
        """Whether model and methods take any force and numbers, as maps, areas and error-cost charts need."""
        return self.equations.plain and all(method.general for method in self.cast)

    def fields(self) -> dict[str, Any]:
        """All fields that determine the run, with its name, as JSON shows them."""
        others = {"cast", "speed"} | set(PARAMETERS) - set(self.parameters)
        named = {each.name: getattr(self, each.name) for each in fields(self) if each.name not in others}
        return named | {"methods": [method.key for method in self.cast]}

    def altered(self, **changes: Any) -> "Scene":
        """This scene with other numbers; it keeps its name only if nothing changes."""
        other = replace(self, **changes)
        return self if other == self else replace(other, name="custom", watch="")

    def with_cast(self, cast: Cast) -> "Scene":
        """This scene with other methods; it keeps `watch` if it keeps all methods that show it."""
        return replace(self, cast=cast, watch=self.watch if set(self.cast) <= set(cast) else "")


@cache
def _equations(model: str, w0_squared: float, *parameters: float) -> Model:
    return MODELS[model](w0_squared, *parameters)
