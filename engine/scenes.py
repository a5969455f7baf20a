"""Scene: everything that determines a run.  SCENES: the ones worth watching, with what to watch."""

import math
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any

from engine.methods import USUAL_CAST, Cast
from engine.models import MODELS
from engine.models.model import ExactMotion, Model

LIMITS = {  # inclusive; beyond them a value is a typing error, not a pendulum
    "theta": (-1e9, 1e9),
    "omega": (-1e9, 1e9),
    "length": (1e-6, 1e6),
    "gravity": (1e-6, 1e6),
}
UNITS = {"theta": "rad", "omega": "rad/s", "length": "m", "gravity": "m/s²", "h": "s"}
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

    def __post_init__(self) -> None:
        for field, (low, high) in LIMITS.items():
            value = getattr(self, field)
            if not low <= value <= high:  # also refuses nan
                raise SceneError(
                    f"{field} = {value:g} {UNITS[field]} is out of range; use {low:g} to {high:g} {UNITS[field]}."
                )
        if self.h <= 0:
            raise SceneError(
                f"h = {self.h:g} s is not a usable step; use a positive one, for example {0.15 / self.w0:.1g}."
            )
        check_h(self.h, self.w0)

    @property
    def equations(self) -> Model:
        """The model with this scene's parameters."""
        return _equations(self.model, self.w0_squared)

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
        """h·w0, the only number that linear stability depends on."""
        return self.h * self.w0

    def fields(self) -> dict[str, Any]:
        """What determines the run and names it, as JSON shows it."""
        named = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "cast"}
        return named | {"methods": [method.key for method in self.cast]}

    def altered(self, **changes: Any) -> "Scene":
        """This scene with other numbers; it keeps its name only if nothing changes."""
        other = replace(self, **changes)
        return self if other == self else replace(other, name="custom", watch="")

    def with_cast(self, cast: Cast) -> "Scene":
        """This scene with other methods; what to watch goes with the methods that show it."""
        return replace(self, cast=cast, watch=self.watch if set(self.cast) <= set(cast) else "")


@cache
def _equations(model: str, w0_squared: float) -> Model:
    return MODELS[model](w0_squared)


_UNIT_W0 = 9.81  # m, the length with which w0 = 1 s⁻¹, so that z reads like h

SCENES: dict[str, Scene] = {
    scene.name: scene
    for scene in (
        Scene("drift", watch="Explicit Euler gains energy, the symplectic ones keep it, RK4 loses a little."),
        Scene(
            "gentle",
            theta=0.1,
            watch="Nearly linear: a step gains explicit Euler z² of its energy, costs RK4 z⁶/72.",
        ),
        Scene(
            "linear",
            length=_UNIT_W0,
            h=0.5,
            model="linear",
            watch="Linear, so theory is exact: a step gains explicit Euler 25 % of its energy.",
        ),
        Scene(
            "large-swing",
            theta=2.5,
            watch="A swing of 143° takes 1.64 small ones; explicit Euler never ends its first.",
        ),
        Scene(
            "crossover", h=0.2, watch="RK4 starts far ahead of Verlet in energy and falls behind after half a minute."
        ),
        Scene(
            "near-separatrix",
            theta=math.radians(179.9),
            h=0.02,
            watch="RK4's energy error is smallest, yet from 30 s on it falls at the wrong time.",
        ),
        Scene(
            "spin",
            theta=0.0,
            omega=8.0,
            h=0.02,
            watch="A turn a second: symplectic Euler is half a kick from Verlet, the angles agree.",
        ),
        Scene(
            "verlet-limit",
            theta=0.1,
            length=_UNIT_W0,
            h=1.98,
            watch="Just below z = 2: Verlet loses 98 % of its energy, has it back every 11 steps.",
        ),
        Scene(
            "verlet-limit-above",
            theta=0.1,
            length=_UNIT_W0,
            h=2.02,
            watch="Just above z = 2: Verlet leaves the bottom, the pendulum holds it at 0.48 rad.",
        ),
        Scene(
            "rk4-limit",
            theta=0.1,
            length=_UNIT_W0,
            h=2.80,
            watch="Just below z = 2√2: RK4 loses half its energy in 4 steps, the others go over.",
        ),
        Scene(
            "rk4-limit-above",
            theta=0.1,
            length=_UNIT_W0,
            h=2.86,
            watch="Just above z = 2√2: RK4 gains energy till the pendulum catches it at 0.2 rad.",
        ),
        Scene(
            "chaos-fenced",
            theta=3.14,
            length=_UNIT_W0,
            h=math.sqrt(0.95),
            watch="K = z² = 0.95: the symplectic ones tumble in chaos, yet |omega| stays < pi/h.",
        ),
        Scene(
            "chaos-loose",
            theta=3.14,
            length=_UNIT_W0,
            h=math.sqrt(1.1),
            watch="K = z² = 1.1: no fence is left, |omega| passes 2 pi/h within a million steps.",
        ),
    )
}
DEFAULT_SCENE = SCENES["drift"]
