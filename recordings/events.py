"""Event: an action in the lab, or a milestone.  Entry: a sample or an event, with its time in the recording.

A recording may name methods and models that this version does not know.  Stand-ins for them play as they were
recorded: nothing is computed of them, so they cannot be verified.
"""

import math
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple

from engine.methods import Method, method_of
from engine.models import MODELS, PARAMETERS, Model
from engine.models.model import Energy, EnergyReference, ExactMotion, Force, Phase, Sine, State
from engine.run.lockstep import Sample
from engine.scenes import Scene

if TYPE_CHECKING:
    from engine.methods.own import OwnMethod
    from engine.run.observer import Milestone

EventKind = Literal["start", "set_h", "mark", "pause", "resume", "speed", "stop", "noticed"]


class Event(NamedTuple):
    """Something done in the lab, or noticed by it.  It applies before `step` of `run`.

    Replay and verification need only events and samples: a `start` (the scene with its model and methods) and
    the `set_h` after it determine a run; the other kinds change no number.  A run that continues
    from an earlier step of another one begins with that one's start and repeats its `set_h`.
    What is `noticed` is what the lab said, which is seen somewhat later than it happens.
    """

    kind: EventKind
    run: int  # counts from 1
    step: int
    t: float  # s, simulated
    scene: Scene | None = None  # start
    h: float | None = None  # set_h [s]
    equal_cost: bool = False  # set_h: methods that need fewer force evaluations take the step in parts
    speed: float | None = None  # speed, times real time
    text: str | None = None  # mark
    milestone: "Milestone | None" = None  # noticed


class Entry(NamedTuple):
    """A sample or an event at its time in a recording."""

    clock: float  # s, the recording clock: running time since the recording began, pauses excluded
    value: Sample | Event


class Seal(NamedTuple):
    """What a recording holds up to here."""

    samples: int
    events: int
    sha256: str
    end: bool  # the recording was finished here


def noticed(run: int, milestone: "Milestone") -> Event:
    """The event of a milestone."""
    return Event("noticed", run, milestone.step, milestone.t, milestone=milestone)


_own: dict[str, "OwnMethod"] = {}


def remember(own: Iterable["OwnMethod"]) -> None:
    """Know these methods when a recording names them; nothing in a recording is ever executed."""
    _own.update({name_of(method): method for method in own})


def name_of(method: Method) -> str:
    """What a recording calls a method: its key, and for a user's own one the hash of its text."""
    sha256 = getattr(method, "sha256", "")
    return f"{method.key}@{sha256}" if sha256 else method.key


def method_named(name: str) -> Method:
    """The method of this name, or a stand-in."""
    key, _, sha256 = name.partition("@")
    try:
        return _own[name] if sha256 else method_of(key)
    except KeyError:
        return _unknown_method(key, sha256)


def scene_named(name: str, **fields: Any) -> Scene:
    """The scene of these fields; its model may be a stand-in."""
    parameters = {each: value for each in PARAMETERS if (value := fields.pop(each, 0.0))}
    kind = Scene if fields["model"] in MODELS else _UnknownScene
    return kind(name, parameters=parameters, **fields)


def unknown_in(scene: Scene, only: Collection[str] | None = None) -> str | None:
    """What of a scene this version does not know; None if it knows all of it, or all of the methods of these keys."""
    if scene.model not in MODELS:
        return f"the model {scene.model}"
    unknown = (method for method in scene.cast if method.phases is _no_phases and (only is None or method.key in only))
    return next(map(_described, unknown), None)


def _described(method: Method) -> str:
    if not (sha256 := getattr(method, "sha256", "")):
        return f"the method {method.key}"
    return (
        f"the method {method.key}, a user's own; give it with --method FILE.py:{method.key}, "
        f"its file as it was (SHA-256 {sha256[:12]}…)"
    )


class _Unknown(Method):
    """A method of which only what was recorded is known: of a user's own, the SHA-256 of its text is its reference."""

    __slots__ = ()

    @property
    def sha256(self) -> str:
        return self.reference


def _no_phases(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Phases that are no numbers, so that no loop takes a step."""
    theta, omega = phase
    while True:
        yield math.nan * theta, math.nan * omega


@lru_cache(64)
def _unknown_method(key: str, sha256: str) -> Method:
    return _Unknown(
        key=key,
        label=key,
        letter="?",
        phases=_no_phases,
        formula="unknown",
        order=1,
        force_evaluations=1,
        linear_limit=0.0,
        reference=sha256,
        used=None,
        models=tuple(MODELS),
    )


@dataclass(frozen=True)
class _UnknownModel(Model):
    """A model of which only what was recorded is known."""

    w0_squared: float

    key: ClassVar[str] = "unknown"
    equation: ClassVar[str] = "unknown"
    turns: ClassVar[bool] = False

    def force(self, sin: Sine = math.sin) -> Force:
        return lambda theta: math.nan * theta

    def slope(self, theta: float) -> float:
        return math.nan

    def energy(self, sin: Sine = math.sin) -> Energy:
        return lambda phase: math.nan * phase[0]

    def exact(self, theta: float, omega: float) -> ExactMotion:
        return ExactMotion(lambda t: State(math.nan, math.nan), "libration")

    def reference(self, theta: float, omega: float) -> EnergyReference:
        return EnergyReference(0.0, 1.0)


class _UnknownScene(Scene):
    __slots__ = ()

    @property
    def equations(self) -> Model:
        return _UnknownModel(self.w0_squared)
