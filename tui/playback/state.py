"""State: a lab or a replay as an undo brings it back."""

from typing import TYPE_CHECKING, NamedTuple

from engine.run.rewindable import RewindableRun
from engine.run.stepping import Stepping
from engine.scenes import Scene
from tui.playback.shown import Shown
from tui.playback.so_far import RunSoFar

if TYPE_CHECKING:
    from tui.playback.ghost import Ghost


class RunState(NamedTuple):
    """A run of the lab where it was left, with its past."""

    run: RewindableRun
    so_far: RunSoFar
    left: "Ghost | None"  # the run before it, if that is laid under


class State(NamedTuple):
    """All that an undo may change."""

    scene: Scene  # with the cast
    t: float  # s, simulated
    number: int  # of the run
    stepping: Stepping
    speed: float
    shown: Shown
    run: RunState | None  # None: a replay has no other
