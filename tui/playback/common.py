"""What a lab and a replay share."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from pendu_tui.engine.models.model import ExactMotion
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.rewindable import RewindableRun
from pendu_tui.engine.run.stepping import Stepping, SteppingChange
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.events import Event
from pendu_tui.tui.playback.history import History
from pendu_tui.tui.playback.shown import Shown

if TYPE_CHECKING:
    from pendu_tui.tui.playback.ghost import Ghost


@dataclass(slots=True)
class Playhead:
    """The position of playback, in seconds of what is played."""

    position: float = 0.0  # s
    speed: float = 1.0  # seconds played per second of clock
    paused: bool = False
    seen: float | None = None  # s, the last clock reading

    def follow(self, now: float) -> None:
        """Follow a clock to `now` [s]; ignore a clock that goes back."""
        if self.seen is not None and not self.paused:
            self.position += max(0.0, now - self.seen) * self.speed
        self.seen = now


class RecordingStatus(NamedTuple):
    name: str
    seconds: float  # of the recording clock
    failed: str | None = None  # why nothing is being recorded, in a sentence


class RunState(NamedTuple):
    run: RewindableRun
    history: History
    ghost: "Ghost | None"  # the previous run, if it is laid under this one


class State(NamedTuple):
    """Everything that undo restores."""

    stepping: Stepping
    speed: float
    shown: Shown
    run: RunState | None  # None in a replay


class Playback(ABC):
    """One Sample a frame, and its run so far.  The caller passes the clock's times [s]."""

    playhead: Playhead
    history: History
    """The run up to the sample; after a jump, a replay reads it over some frames."""
    pace: float = 1.0
    """The share of the chosen speed that the processor reaches."""
    knows_past = True
    """Whether the past of the sample has been read."""
    failure: str | None = None
    """Why the run stands still: the error of a user's method, in a sentence."""

    @property
    def sample(self) -> Sample:
        return self.history.sample

    @property
    def scene(self) -> Scene:
        return self.history.scene

    @property
    def exact(self) -> ExactMotion:
        return self.history.exact

    @property
    def changes(self) -> Sequence[SteppingChange]:
        """The run's changes of step, in order; a recording's include later ones."""
        return self.history.changes

    @property
    @abstractmethod
    def events(self) -> Sequence[Event]:
        """The user's changes and marks up to the playhead."""


def doubled(speed: float, times: int) -> float:
    """Return the speed doubled (or halved) so many times, from 2^-10 to 2^20; the sign stays."""
    return math.copysign(min(max(abs(speed) * 2.0**times, 2.0**-10), 2.0**20), speed)
