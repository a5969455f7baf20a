"""Replay: a recording that follows the clock, forwards and backwards."""

import time
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import replace
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, Literal

from engine.models.exact_pendulum import ExactMotion
from engine.run.lockstep import Sample
from engine.run.observer import Milestone
from engine.run.rewindable import Pitch
from engine.run.verdict import Judgement
from engine.scenes import Scene
from recordings.events import Event
from tui.playback.highlights import Highlights
from tui.playback.history import ErrorHistory
from tui.playback.live import Live
from tui.playback.marks import Mark, Marks, mark_events
from tui.playback.playhead import Pace, Playhead
from tui.playback.reel import ReplayCursor
from tui.playback.source import RecordingStatus, is_marked

if TYPE_CHECKING:
    from recordings.recording import Recording
    from recordings.timeline import Run

EVENTS_SHOWN = 2000
FILL_BUDGET = 0.006  # s of each frame for reading the past


class Replay:
    """A recording on screen.  The playhead is on the recording clock."""

    kind: Literal["REPLAY"] = "REPLAY"
    pace = Pace()

    def __init__(self, recording: "Recording", marks: Marks, clock: Callable[[], float] = time.perf_counter) -> None:
        self.recording = recording
        self.marks = marks
        self.playhead = Playhead()
        self.ends: tuple[float | None, float | None] = (None, None)
        """Of the loop, on the recording clock [s]; None: the recording's own."""
        self.looping = self._closed = False
        self._clock = clock
        self._reel = ReplayCursor(recording)
        self._highlights = Highlights(recording)
        self._done: list[Event] = []  # what was computed last, and for what:
        self._done_known = -1  # events
        self._mark_events: list[Event] = []
        self._changes: list[tuple[int, Pitch]] = []
        self._change_places: list[int] = []  # among the events
        self._changes_known = -1  # run
        self._ticks: list[float] = []
        self._ticks_known: tuple[int, int] | None = None  # marks, highlights

    @property
    def sample(self) -> Sample:
        """All methods at the playhead."""
        return self._reel.sample

    @property
    def run(self) -> "Run":
        """The run on screen."""
        return self._reel.run

    @property
    def loop(self) -> tuple[float, float] | None:
        """From where to where to play again and again [s]."""
        return self.stretch(*self.ends) if self.looping else None

    def stretch(self, start: float | None, end: float | None) -> tuple[float, float] | None:
        """What a loop with these ends would play [s]; None if that has no length."""
        start, end = 0.0 if start is None else start, self.length if end is None else end
        return (min(start, end), max(start, end)) if start != end else None

    @property
    def length(self) -> float:
        """Of the recording [s]."""
        return self.recording.length

    @property
    def scene(self) -> Scene:
        """The scene of the run on screen."""
        return self.run.scene

    @property
    def exact(self) -> ExactMotion:
        """The exact motion of that scene."""
        return self._reel.past.exact

    @property
    def history(self) -> ErrorHistory:
        """The past of the run, up to the sample; after a jump it grows for some frames."""
        return self._reel.past.history

    @property
    def judgements(self) -> Sequence[Judgement]:
        """The verdicts on the run up to the sample."""
        return self._reel.past.observer.judgements

    @property
    def milestones(self) -> Sequence[Milestone]:
        """What the methods did up to the sample."""
        return self._reel.past.observer.milestones(self.sample.step)

    @property
    def events(self) -> Sequence[Event]:
        """What was done up to the playhead; of very much, the last."""
        done = self.events_done
        if self._done_known != done:
            recent = self.recording.events[max(0, done - EVENTS_SHOWN) : done]
            self._done_known, self._done = done, [event for _, event in recent]
        return self._done

    @property
    def later_marks(self) -> Sequence[Event]:
        """The marks beside the recording, up to the playhead."""
        marks = list(self.marks)
        if len(self._mark_events) != len(marks):
            self._mark_events = list(mark_events(marks, self.recording.events))
        done = bisect_right(marks, self.playhead.position, key=attrgetter("clock"))
        return self._mark_events[max(0, done - EVENTS_SHOWN) : done]

    @property
    def events_done(self) -> int:
        """How many events lie behind the playhead."""
        return bisect_right(self.recording.events.clocks, self.playhead.position)

    @property
    def changes(self) -> list[tuple[int, Pitch]]:
        """(step, pitch) of the changes of how this run steps, so far."""
        changed = self._changed
        return self._changes[:changed]

    @property
    def _changed(self) -> int:
        """How many of the run's changes there were so far."""
        run = self.run.number
        if self._changes_known != run:
            events = self.recording.events
            self._changes_known = run
            found = [(at, event) for at in events.places(run) if (event := events[at][1]).h is not None]
            self._change_places = [at for at, _ in found]
            self._changes = [(event.step, Pitch(event.h or 0.0, event.equal_cost)) for _, event in found]
        done = bisect_left(self._change_places, self.events_done)
        return min(done, bisect_right(self._changes, self.sample.step, key=itemgetter(0)))

    @property
    def h(self) -> float:
        """The step size in force [s]."""
        changed = self._changed
        return self._changes[changed - 1][1].h if changed else self.scene.h

    @property
    def equal_cost(self) -> bool:
        """Whether all methods spend the same number of force evaluations."""
        changed = self._changed
        return bool(changed) and self._changes[changed - 1][1].equal_cost

    @property
    def recording_status(self) -> RecordingStatus:
        """The recording."""
        return RecordingStatus(self.recording.path.name, self.length, self.recording.bytes)

    def tick(self, now: float) -> Sample:
        """Follow the clock to `now`: stop at the ends, or go round in the loop."""
        if self._closed:  # by another screen, and this one's last frame was already due
            return self.sample
        self.playhead = self.playhead.at(now)
        if not self.playhead.paused:
            self._stay_inside()
            self._reel.go_to(self.playhead.position)
        self.fill()
        return self.sample

    def fill(self) -> bool:
        """Read more of the past, and look further ahead; whether the past of the sample is known by now."""
        if self._closed:
            return True
        until = self._clock() + FILL_BUDGET
        for read in (self._reel.fill, self._highlights.find):
            read(lambda: self._clock() < until)
        return self._reel.filled

    def pause(self, paused: bool) -> None:
        """Stop or go on; from the end, go on from the start."""
        self.playhead = replace(self.playhead, paused=paused)
        position, backwards = self.playhead.position, self.playhead.speed < 0
        if not paused and position == (0.0 if backwards else self.length):
            self.seek(self.length if backwards else 0.0)

    def set_speed(self, speed: float) -> None:
        """Play `speed` seconds of the recording for each second of the clock; a negative one plays backwards."""
        self.playhead = replace(self.playhead, speed=speed)

    def step(self, n: int) -> Sample:
        """Pause and go n samples on, or back where n is negative."""
        self.pause(True)
        if not self._closed:
            self._reel.step(n)
        self.playhead = self.playhead.moved_to(self._reel.clock)
        return self.sample

    def seek(self, position: float) -> None:
        """Go to a moment of the recording clock [s], or to the nearer end."""
        if self._closed:
            return
        self.playhead = self.playhead.moved_to(min(max(position, 0.0), self.length))
        self._reel.go_to(self.playhead.position)

    def seek_event(self, direction: int) -> None:
        """Go to the next event, mark or highlight, or to the one before."""
        position = self.playhead.position
        if direction > 0:
            self.seek(min((tick for tick in self.ticks if tick > position + 1e-6), default=self.length))
        else:
            self.seek(max((tick for tick in self.ticks if tick < position - 0.3), default=0.0))

    @property
    def ticks(self) -> list[float]:
        """Where on the recording clock something was done, marked, or happened as far as that is known by now [s]."""
        marks, found = [mark.clock for mark in self.marks], self._highlights.clocks
        if self._ticks_known != (len(marks), len(found)):
            self._ticks_known = len(marks), len(found)
            self._ticks = sorted({*self.recording.events.done(), *marks, *found})
        return self._ticks

    def mark(self, text: str | None = None) -> None:
        """Leave a mark at the sample, unless it has one; it is kept beside the recording, which is not touched."""
        if not is_marked(self):
            self.marks.add(Mark(self.playhead.position, self.sample.run, self.sample.step, text))

    def live(self) -> Live:
        """A lab that goes on from here with the same bits, and with what is known of the past."""
        return Live(self.scene, changes=self.changes, step=self.sample.step, past=self._reel.past)

    def close(self) -> None:
        """Let go of the file, and stand still."""
        self._closed = True
        self.recording.close()

    def _stay_inside(self) -> None:
        position, backwards = self.playhead.position, self.playhead.speed < 0
        start, end = self.loop or (0.0, self.length)
        if start <= position <= end:
            return
        if self.loop is not None:
            self.playhead = self.playhead.moved_to(end if backwards else start)
        elif backwards == (position < start):
            self.playhead = replace(self.playhead, paused=True).moved_to(start if backwards else end)
