"""Replay: a recording that follows the clock, forwards and backwards."""

import math
import time
from bisect import bisect_right
from collections.abc import Callable, Sequence
from functools import cache, partial
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING

from engine.run.judgement import Judgement, Milestone
from engine.run.lockstep import Sample
from engine.run.stepping import Stepping, change_before
from recordings.events import Event, check_present
from tui.playback.cursor import ReplayCursor
from tui.playback.live import Live
from tui.playback.marks import Mark, Marks, mark_event
from tui.playback.playhead import Pace, Playhead
from tui.playback.so_far import RunSoFar
from tui.playback.source import RecordingStatus, Source

if TYPE_CHECKING:
    from recordings.recording import Recording, Run

FILL_BUDGET = 0.006  # s of each frame for reading the past


class Replay(Source):
    """A recording on screen.  The playhead is on the recording clock."""

    kind = "REPLAY"

    def __init__(
        self, recording: "Recording", marks: Marks, clock: Callable[[], float] = time.perf_counter
    ) -> None:
        self.recording = recording
        self.length = recording.length  # s
        self.marks = marks
        self.playhead = Playhead()
        self.pace = Pace()
        self.looping = False  # plays the recording again and again
        self._closed = False
        self._clock = clock
        self._cursor = ReplayCursor(recording)
        self._events: list[Event] = []  # up to the playhead
        self._milestones: tuple[int, list[Milestone]] = 0, []  # of the run of this number
        self._ticks: list[float] = []  # s, for so many marks:
        self._ticked_marks = -1
        self._mark_event = cache(partial(mark_event, recording))

    @property
    def so_far(self) -> RunSoFar:
        return self._cursor.so_far

    @property
    def run(self) -> "Run":
        return self._cursor.run

    @property
    def events(self) -> Sequence[Event]:
        """What was done up to the playhead."""
        done = bisect_right(self.recording.events, self.playhead.position, key=itemgetter(0))
        if done != len(self._events):
            self._events = [event for _, event in self.recording.events[:done]]
        return self._events

    @property
    def milestones(self) -> Sequence[Milestone]:
        """What the lab noticed in this run up to the sample."""
        if self._milestones[0] != self.run.number:
            self._milestones = self.run.number, self.run.milestones
        known = self._milestones[1]
        return known[: bisect_right(known, self.sample.step, key=attrgetter("step"))]

    @property
    def judgements(self) -> Sequence[Judgement]:
        """The lab's verdicts since the stepping last changed, with their trends then."""
        since = change_before(self.changes, self.sample.step).step
        period = self.exact.period or math.tau / self.scene.w0
        swings = (self.sample.step - since) * abs(self.stepping.h) / period
        given = {
            each.method: Judgement(
                verdict=each.verdict,
                periods=swings,
                lyapunov=each.lyapunov,
                slope=each.trend,
            )
            for each in self.milestones
            if each.kind == "verdict" and each.step > since
        }
        judged = zip(self.scene.cast, self.sample.readings, strict=True)
        return [
            Judgement("failed")
            if reading.diverged_at is not None
            else given.get(method, Judgement())
            for method, reading in judged
        ]

    @property
    def later_marks(self) -> Sequence[Event]:
        marks = list(self.marks)
        done = bisect_right(marks, self.playhead.position, key=attrgetter("clock"))
        return [self._mark_event(mark) for mark in marks[:done]]

    @property
    def stepping(self) -> Stepping:
        return self._cursor.changes(self.playhead.position)[-1].stepping

    @property
    def knows_past(self) -> bool:
        return self._cursor.fill(lambda: False)

    @property
    def recording_status(self) -> RecordingStatus:
        return RecordingStatus(self.recording.path.name, self.length)

    def tick(self, now: float) -> Sample:
        """Follow the clock to `now`: stop at the ends, or go round in the loop."""
        self.playhead = self.playhead.at(now)
        if not self.playhead.paused and not self._closed:
            self._stay_inside()
            self._cursor.go_to(self.playhead.position)
        self.fill()
        return self.sample

    def fill(self) -> bool:
        """Read more of the past; return whether all of it has been read."""
        until = self._clock() + FILL_BUDGET
        return self._closed or self._cursor.fill(lambda: self._clock() < until)

    def pause(self, paused: bool) -> None:
        """Pause or go on; from the end, go on from the start."""
        self.playhead = self.playhead._replace(paused=paused)
        position = self.playhead.position
        backwards = self.playhead.speed < 0
        if not paused and position == (0.0 if backwards else self.length):
            self.seek(self.length if backwards else 0.0)

    def set_speed(self, speed: float) -> None:
        """Play `speed` seconds of the recording per second; negative plays backwards."""
        self.playhead = self.playhead._replace(speed=speed)

    def step(self, n: int) -> Sample:
        self.pause(True)
        if not self._closed:
            self._cursor.step(n)
        self.playhead = self.playhead.moved_to(self._cursor.clock)
        return self.sample

    def seek(self, position: float) -> None:
        """Go to a moment of the recording clock [s], or to the nearer end."""
        if self._closed:
            return
        self.playhead = self.playhead.moved_to(min(max(position, 0.0), self.length))
        self._cursor.go_to(self.playhead.position)

    def go_to(self, run: int, step: int) -> bool:
        self.pause(True)
        place = self._cursor.place(run, step)
        if place is not None:
            self.seek(place)
        return place is not None

    def seek_event(self, direction: int) -> None:
        position = self.playhead.position
        if direction > 0:
            self.seek(
                min((tick for tick in self.ticks if tick > position + 1e-6), default=self.length)
            )
        else:
            self.seek(max((tick for tick in self.ticks if tick < position - 0.3), default=0.0))

    @property
    def ticks(self) -> list[float]:
        """The clocks of events, milestones and marks [s]; not the stops."""
        marks = [mark.clock for mark in self.marks]
        if len(marks) != self._ticked_marks:
            self._ticked_marks = len(marks)
            done = {clock for clock, event in self.recording.events if event.kind != "stop"}
            self._ticks = sorted({*done, *marks})
        return self._ticks

    def mark(self, text: str | None = None) -> None:
        """Set a mark at the sample, unless it has one; it is saved beside the recording."""
        if not self.is_marked:
            self.marks.add(Mark(self.playhead.position, self.sample.run, self.sample.step, text))

    def live(self) -> Live:
        """Return a lab that goes on from here with the same bits.

        Raises RecordingError if the run has a user's own method that was not given.
        """
        check_present(self.scene)
        return Live(
            self.scene, changes=self._cursor.changes(self.playhead.position)[1:], so_far=self.so_far
        )

    def close(self) -> None:
        """Close the file; a frame that was due already shows what was there."""
        self._closed = True
        self.recording.close()

    def _stay_inside(self) -> None:
        position = self.playhead.position
        if 0.0 <= position <= self.length:
            return
        backwards = self.playhead.speed < 0
        if self.looping and self.length:
            self.playhead = self.playhead.moved_to(self.length if backwards else 0.0)
        elif backwards == (position < 0.0):
            end = 0.0 if backwards else self.length
            self.playhead = self.playhead._replace(paused=True).moved_to(end)
