"""What a lab and a replay share."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from engine.models.model import ExactMotion
from engine.run.lockstep import Sample
from engine.run.rewindable import RewindableRun
from engine.run.stepping import Stepping, SteppingChange
from engine.scenes import Scene
from recordings.events import Event
from tui.playback.history import History
from tui.playback.shown import Shown

if TYPE_CHECKING:
    from tui.playback.ghost import Ghost


@dataclass(slots=True)
class Playhead:
    """How far playback has come, in seconds of what is played."""

    position: float = 0.0  # s
    speed: float = 1.0  # seconds played per second of clock
    paused: bool = False
    seen: float | None = None  # s, the last clock reading

    def follow(self, now: float) -> None:
        """Follow a clock to `now` [s]; one that goes back moves nothing."""
        if self.seen is not None and not self.paused:
            self.position += max(0.0, now - self.seen) * self.speed
        self.seen = now


class RecordingStatus(NamedTuple):
    name: str
    seconds: float  # of the recording clock
    failed: str | None = None  # why nothing is recorded right now, in a sentence


class RunState(NamedTuple):
    run: RewindableRun
    history: History
    left: "Ghost | None"  # the run before it, if that is laid under


class State(NamedTuple):
    """All that an undo may change."""

    stepping: Stepping
    speed: float
    shown: Shown
    run: RunState | None  # None: a replay has no other


class Playback(ABC):
    """One Sample a frame, and what is known around it.  Times of the clock are passed in, in s."""

    playhead: Playhead
    history: History
    """The run on screen up to the sample; after a jump, a replay's past grows for some frames."""
    pace: float = 1.0
    """1: in real time; below, the processor cannot follow."""
    knows_past = True
    """Whether the whole past of the sample is at hand."""
    failure: str | None = None
    """Why the run stands still: what is wrong with a user's method, in a sentence."""

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
        """How the run steps, in order; in a recording including what is still to come."""
        return self.history.changes

    @property
    @abstractmethod
    def events(self) -> Sequence[Event]:
        """What was done up to the playhead, marks set in a replay last."""

    @property
    def is_marked(self) -> bool:
        here = ("mark", self.sample.run, self.sample.step)
        return any((event.kind, event.run, event.step) == here for event in self.events)


def doubled(speed: float, times: int) -> float:
    """The speed doubled so many times, halved if negative; from 2^-10 to 2^20, its sign stays."""
    return math.copysign(min(max(abs(speed) * 2.0**times, 2.0**-10), 2.0**20), speed)
