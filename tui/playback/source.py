"""Source: what a screen shows, a lab or a recording."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

from engine.models.model import ExactMotion
from engine.run.judgement import Judgement, Milestone
from engine.run.lockstep import Sample
from engine.run.rewindable import RewindableRun
from engine.run.stepping import Stepping, SteppingChange
from engine.scenes import Scene
from recordings.events import Event
from tui.playback.history import History
from tui.playback.shown import Shown

if TYPE_CHECKING:
    from tui.playback.ghost import Ghost


class Playhead(NamedTuple):
    """How far playback has come, in seconds of what is played."""

    position: float = 0.0  # s
    speed: float = 1.0  # seconds played per second of clock
    paused: bool = False
    seen: float | None = None  # s, the last clock reading

    def at(self, now: float) -> "Playhead":
        """Return the playhead at `now` [s] of a clock, which moves nothing by going back."""
        elapsed = 0.0 if self.seen is None or self.paused else max(0.0, now - self.seen)
        return Playhead(self.position + elapsed * self.speed, self.speed, self.paused, now)

    def moved_to(self, position: float) -> "Playhead":
        return self._replace(position=position)


class Pace(NamedTuple):
    """How much of what was due has been done, over about the last second of clock."""

    due: float = 0.0
    done: float = 0.0

    def after(self, elapsed: float, due: float, done: float) -> "Pace":
        """The pace `elapsed` seconds later, when so much more was due and so much of it done."""
        kept = math.exp(-elapsed)
        return Pace(self.due * kept + due, self.done * kept + done)

    @property
    def share(self) -> float:
        """1: in real time; below, the processor cannot follow."""
        return self.done / self.due if self.due > 0 else 1.0


class RecordingStatus(NamedTuple):
    """The recording that is being written, or replayed."""

    name: str
    seconds: float  # of the recording clock
    failed: str | None = None  # why nothing is recorded right now, in a sentence


class RunState(NamedTuple):
    """A run of the lab where it was left, with its past."""

    run: RewindableRun
    history: History
    left: "Ghost | None"  # the run before it, if that is laid under


class State(NamedTuple):
    """All that an undo may change."""

    stepping: Stepping
    speed: float
    shown: Shown
    run: RunState | None  # None: a replay has no other


class Source(ABC):
    """One Sample a frame, and what is known around it.  Times of the clock are passed in, in s."""

    kind: ClassVar[Literal["LIVE", "REPLAY"]]
    playhead: Playhead
    history: History
    """The run on screen up to the sample; after a jump, a replay's past grows for some frames."""
    pace = Pace()
    """Whether it can follow the clock."""
    failure: str | None = None
    """Why the run stands still: what is wrong with a user's method, in a sentence."""

    @property
    def sample(self) -> Sample:
        """All methods at the playhead."""
        return self.history.sample

    @property
    def scene(self) -> Scene:
        return self.history.scene

    @property
    def exact(self) -> ExactMotion:
        """The exact motion of the scene: at(t), period, regime."""
        return self.history.exact

    @property
    def changes(self) -> Sequence[SteppingChange]:
        """How the run steps, in order; in a recording including what is still to come."""
        return self.history.changes

    @property
    def later_marks(self) -> Sequence[Event]:
        """Marks up to the playhead that were set in a replay and are not in the recording."""
        return ()

    @property
    def ghost(self) -> "Ghost | None":
        """The run that is laid under this one."""
        return None

    @property
    def run_state(self) -> RunState | None:
        """The run as an undo can bring it back; None in a replay, which cannot change it."""
        return None

    @property
    def next_step(self) -> float | None:
        """Seconds of the clock until the next step; None where that cannot be said."""
        return None

    @property
    def knows_past(self) -> bool:
        """Whether the whole past of the sample is at hand; a replay reads it piecemeal."""
        return True

    @property
    def is_marked(self) -> bool:
        """Whether the sample on screen has a mark."""
        here = self.sample.run, self.sample.step
        events = (*self.events, *self.later_marks)
        return any(event.kind == "mark" and (event.run, event.step) == here for event in events)

    @property
    @abstractmethod
    def judgements(self) -> Sequence[Judgement]:
        """The verdicts, and trends per second, since the last change of the stepping."""

    @property
    @abstractmethod
    def milestones(self) -> Sequence[Milestone]:
        """What the methods did in this run up to the sample, in its order."""

    @property
    @abstractmethod
    def stepping(self) -> Stepping:
        """How the run steps from the sample on."""

    @property
    @abstractmethod
    def events(self) -> Sequence[Event]:
        """What was done up to the playhead."""

    @property
    @abstractmethod
    def recording_status(self) -> RecordingStatus | None:
        """The recording; None where nothing is recorded."""

    @abstractmethod
    def tick(self, now: float) -> Sample:
        """Follow the clock to `now`; called once a frame."""

    @abstractmethod
    def pause(self, paused: bool) -> None:
        """Pause or go on."""

    @abstractmethod
    def set_speed(self, speed: float) -> None:
        """Play `speed` seconds for each second of the clock."""

    @abstractmethod
    def step(self, n: int) -> Sample:
        """Pause and go n steps (live) or samples (replay) forward, or back where n is negative."""

    @abstractmethod
    def go_to(self, run: int, step: int) -> bool:
        """Pause and go to a step of a run; False where it cannot be reached."""

    @abstractmethod
    def seek_event(self, direction: int) -> None:
        """Go to the next event, mark or milestone, or to the previous one."""

    @abstractmethod
    def mark(self, text: str | None = None) -> None:
        """Leave a mark at the sample, unless it has one."""

    @abstractmethod
    def close(self) -> None:
        """Finish what is open; a lab finishes its recording."""


def doubled(speed: float, times: int) -> float:
    """The speed doubled so many times, halved if negative; from 2^-10 to 2^20, its sign stays."""
    return math.copysign(min(max(abs(speed) * 2.0**times, 2.0**-10), 2.0**20), speed)
