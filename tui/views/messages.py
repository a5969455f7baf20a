"""Messages from a view to the lab."""

from dataclasses import dataclass

from textual.message import Message

from engine.run.stepping import Stepping
from engine.scenes import Scene
from tui.playback.shown import Stretch


@dataclass
class SceneChosen(Message):
    """The user wants a run of this scene."""

    scene: Scene


@dataclass
class StepSizeChosen(Message):
    """The user wants to continue with this step size."""

    stepping: Stepping


@dataclass
class MethodChosen(Message):
    """The user wants to see this method alone or, if it is, all of them again."""

    place: int  # in the cast


@dataclass
class Held(Message):
    """The user holds the pendulums at an angle [rad], or no longer."""

    theta: float | None


@dataclass
class Zoomed(Message):
    """The user wants to see this part of the run in the chart, or all of it."""

    stretch: Stretch | None


@dataclass
class Asked(Message):
    """The user clicked what a key does as well."""

    action: str  # of the screen
