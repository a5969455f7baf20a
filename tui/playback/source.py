"""What a screen shows: a lab running live, or a recording.  One protocol, so that one screen serves both."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol

from engine.run.lockstep import Sample
from engine.scenes import Scene
from recordings.events import Event
from tui.playback.playhead import Pace, Playhead

if TYPE_CHECKING:
    from engine.models.exact_pendulum import ExactMotion
    from engine.run.observer import Milestone
    from engine.run.stepping import Stepping, SteppingChange
    from engine.run.verdict import Judgement
    from tui.playback.history import ErrorHistory


@dataclass(frozen=True, slots=True)
class RecordingStatus:
    """What becomes of a recording, or what is replayed."""

    name: str
    seconds: float  # of the recording clock
    bytes: int
    failed: str | None = None  # why nothing is recorded right now, in a sentence


class Source(Protocol):
    """One Sample a frame, and what is known around it.  Times of the clock are passed in, in s."""

    @property
    def kind(self) -> Literal["LIVE", "REPLAY"]:
        """What the status line calls it."""

    @property
    def sample(self) -> Sample:
        """All methods at the playhead."""

    @property
    def scene(self) -> Scene:
        """The scene of the run on screen."""

    @property
    def stepping(self) -> "Stepping":
        """How the run steps from the sample on."""

    @property
    def changes(self) -> "Sequence[SteppingChange]":
        """How the run steps, and has stepped since its start."""

    @property
    def exact(self) -> "ExactMotion":
        """The exact motion of the scene: at(t), period, regime."""

    @property
    def history(self) -> "ErrorHistory":
        """The past of the run on screen, up to the sample."""

    @property
    def judgements(self) -> "Sequence[Judgement]":
        """What is known of each method's energy error so far: verdict and drift per second."""

    @property
    def milestones(self) -> "Sequence[Milestone]":
        """What the methods did in this run up to the sample, in its order."""

    @property
    def events(self) -> Sequence[Event]:
        """What was done up to the playhead."""

    @property
    def later_marks(self) -> Sequence[Event]:
        """Marks up to the playhead that were made while replaying, and are no part of the recording."""

    @property
    def playhead(self) -> Playhead:
        """Position, speed, paused or not."""

    @property
    def pace(self) -> Pace:
        """Whether it can follow the clock."""

    @property
    def recording_status(self) -> RecordingStatus | None:
        """The recording; None where nothing is recorded."""

    def tick(self, now: float) -> Sample:
        """Follow the clock to `now`; called once a frame."""

    def pause(self, paused: bool) -> None:
        """Stop or go on."""

    def set_speed(self, speed: float) -> None:
        """Play `speed` seconds for each second of the clock."""

    def step(self, n: int) -> Sample:
        """Pause and go n steps (live) or samples (replay) on, or back where n is negative."""

    def mark(self, text: str | None = None) -> None:
        """Leave a mark at the sample."""

    def close(self) -> None:
        """Finish what is open; a live source finishes its recording."""


def is_marked(source: Source) -> bool:
    """Whether the sample on screen has a mark."""
    here = source.sample.run, source.sample.step
    events = (*source.events, *source.later_marks)
    return any(event.kind == "mark" and (event.run, event.step) == here for event in events)
