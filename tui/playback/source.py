"""Source: what a screen shows, a lab or a recording."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

from engine.models.model import ExactMotion
from engine.run.judgement import Judgement, Milestone
from engine.run.lockstep import Sample
from engine.run.stepping import Stepping, SteppingChange
from engine.scenes import Scene
from recordings.events import Event
from tui.playback.history import ErrorHistory
from tui.playback.playhead import Pace, Playhead
from tui.playback.so_far import RunSoFar

if TYPE_CHECKING:
    from tui.playback.ghost import Ghost
    from tui.playback.state import RunState


class RecordingStatus(NamedTuple):
    """The recording that is being written, or replayed."""

    name: str
    seconds: float  # of the recording clock
    failed: str | None = None  # why nothing is recorded right now, in a sentence


class Source(ABC):
    """One Sample a frame, and what is known around it.  Times of the clock are passed in, in s."""

    kind: ClassVar[Literal["LIVE", "REPLAY"]]
    playhead: Playhead
    pace: Pace
    """Whether it can follow the clock."""
    failure: str | None = None
    """Why the run stands still: what is wrong with a user's method, in a sentence."""

    @property
    @abstractmethod
    def so_far(self) -> RunSoFar:
        """What is known of the run on screen, up to the sample."""

    @property
    def sample(self) -> Sample:
        """All methods at the playhead."""
        return self.so_far.sample

    @property
    def scene(self) -> Scene:
        return self.so_far.scene

    @property
    def exact(self) -> ExactMotion:
        """The exact motion of the scene: at(t), period, regime."""
        return self.so_far.exact

    @property
    def changes(self) -> Sequence[SteppingChange]:
        """How the run steps, in order; in a recording including what is still to come."""
        return self.so_far.changes

    @property
    def history(self) -> ErrorHistory:
        """The past of the run up to the sample; after a jump, a replay's grows for some frames."""
        return self.so_far.history

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
    def later_marks(self) -> Sequence[Event]:
        """Marks up to the playhead that were set in a replay and are not in the recording."""
        return ()

    @property
    @abstractmethod
    def recording_status(self) -> RecordingStatus | None:
        """The recording; None where nothing is recorded."""

    @property
    def ghost(self) -> "Ghost | None":
        """The recording that is laid under the run."""
        return None

    @property
    def run_state(self) -> "RunState | None":
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
