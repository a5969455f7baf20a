"""Source: what a screen shows, a live run or a replay, on one interface."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

from pendu_tui.engine.models.model import ExactMotion
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.rewindable import RewindableRun
from pendu_tui.engine.run.stepping import Stepping, SteppingChange
from pendu_tui.engine.run.verdicts import Judgement, Milestone
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.events import Event
from pendu_tui.tui.playback.history import History

if TYPE_CHECKING:
    from pendu_tui.tui.playback.rows import Ghost


@dataclass(slots=True)
class Playhead:
    """The position of playback, in seconds of what is played."""

    position: float = 0.0  # s
    speed: float = 1.0  # seconds played per second of clock
    paused: bool = False
    seen: float | None = None  # s, the last clock reading

    def follow(self, now: float) -> float:
        """Follow a clock to `now` [s]; return the time [s] played, 0 if the clock went back."""
        played = 0.0
        if self.seen is not None and not self.paused:
            played = max(0.0, now - self.seen)
        self.seen = now
        self.position += played * self.speed
        return played


class RecordingStatus(NamedTuple):
    name: str
    seconds: float  # of the recording clock
    failed: str | None = None  # why nothing is being recorded, in a sentence


class RunState(NamedTuple):
    """What leads back to an earlier state of a source."""

    speed: float
    stepping: Stepping
    history: History
    ghost: "Ghost | None"  # the previous run, if it is laid under this one
    run: RewindableRun | None = None  # of a lab


class Source(ABC):
    """One Sample a frame, and its run so far.  The caller passes the clock's times [s].

    Positions are in seconds of what is played: simulated time covered, or a recording's clock.
    """

    kind: Literal["LIVE", "REPLAY"]
    playhead: Playhead
    history: History
    """The run up to the sample; after a jump, a replay reads it over some frames."""
    pace: float = 1.0
    """The share of the chosen speed that the processor reaches."""
    looping = False
    """Whether a replay begins again at its end."""
    knows_past = True
    """Whether the past of the sample has been read."""
    failure: str | None = None
    """Why the run stands still: the error of a user's method, in a sentence."""
    ghost: "Ghost | None" = None
    """The run before a restart with another step."""
    stepping: Stepping
    judgements: Sequence[Judgement] = ()
    """The judgements at the sample, in the order of the cast."""
    milestones: Sequence[Milestone] = ()
    """The milestones of the run up to the sample."""

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
    def is_back(self) -> bool:
        """Whether reversed time is at 0 again, but for rounding."""
        sample = self.sample
        return sample.step > 0 and abs(sample.t) < 1e-6 * abs(self.stepping.h)

    @property
    def changes(self) -> Sequence[SteppingChange]:
        """The run's changes of step, in order; a recording's include later ones."""
        return self.history.changes

    @property
    def run_state(self) -> RunState:
        return RunState(self.playhead.speed, self.stepping, self.history, self.ghost)

    def return_to(self, state: RunState) -> None:
        self.set_speed(state.speed)

    @property
    @abstractmethod
    def events(self) -> Sequence[Event]:
        """The user's changes and marks up to the playhead."""

    @property
    @abstractmethod
    def recording_status(self) -> RecordingStatus | None: ...

    @property
    @abstractmethod
    def length(self) -> float:
        """The position of the end [s]: of the recording, or of what has been simulated."""

    @property
    @abstractmethod
    def places(self) -> Sequence[tuple[float, Event]]:
        """The events that one can go to, each after its position [s]."""

    @property
    def ticks(self) -> list[float]:
        """The positions of what the user or a method did [s], in order."""
        kinds = ("start", "set_h", "mark", "noticed")
        return sorted({position for position, event in self.places if event.kind in kinds})

    @property
    @abstractmethod
    def counts(self) -> dict[str, tuple[int, int]]:
        """Which one of how many: runs and steps."""

    @abstractmethod
    def tick(self, now: float) -> Sample:
        """Follow the clock to `now` [s]."""

    @abstractmethod
    def pause(self, paused: bool) -> None: ...

    @abstractmethod
    def set_speed(self, speed: float) -> None: ...

    @abstractmethod
    def step(self, n: int) -> Sample:
        """Pause and go so many steps, or samples of a recording, forward."""

    @abstractmethod
    def seek(self, position: float) -> None:
        """Go to a position [s], or to the nearest end."""

    def go_to(self, run: int, step: int) -> bool:
        """Pause and go to the event at a step; return False if there is none."""
        for position, event in self.places:
            if (event.run, event.step) == (run, step):
                self.pause(True)
                self.seek(position)
                return True
        return False

    def seek_event(self, direction: int) -> None:
        """Pause at the next event, or at the previous one; at an end, if there is none."""
        self.pause(True)
        position = self.playhead.position
        if direction > 0:
            self.seek(min((at for at in self.ticks if at > position), default=self.length))
        else:
            self.seek(max((at for at in self.ticks if at < position), default=0.0))

    @abstractmethod
    def close(self) -> None: ...


def doubled(speed: float, times: int) -> float:
    """Return the speed doubled (or halved) so many times, from 2^-10 to 2^20; the sign stays."""
    return math.copysign(min(max(abs(speed) * 2.0**times, 2.0**-10), 2.0**20), speed)
