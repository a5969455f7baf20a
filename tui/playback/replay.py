"""Replay: a recording that follows the clock, forwards and backwards."""

import time
from bisect import bisect_right
from collections.abc import Callable, Sequence
from operator import attrgetter
from typing import TYPE_CHECKING

from engine.run.lockstep import Sample
from engine.run.observer import Milestone
from engine.run.stepping import Stepping, change_before
from engine.run.verdict import Judgement
from recordings.events import Event
from tui.playback.cursor import ReplayCursor
from tui.playback.live import Live
from tui.playback.marks import Mark, Marks, mark_events
from tui.playback.playhead import Pace, Playhead
from tui.playback.so_far import RunSoFar
from tui.playback.source import RecordingStatus, Source

if TYPE_CHECKING:
    from recordings.recording import Recording
    from recordings.timeline import Run

EVENTS_SHOWN = 2000  # the last ones; a hostile file may have a million
FILL_BUDGET = 0.006  # s of each frame for reading the past


class Replay(Source):
    """A recording on screen.  The playhead is on the recording clock."""

    kind = "REPLAY"

    def __init__(self, recording: "Recording", marks: Marks, clock: Callable[[], float] = time.perf_counter) -> None:
        self.recording = recording
        self.length = recording.length  # s
        self.marks = marks
        self.playhead = Playhead()
        self.pace = Pace()
        self.ends: tuple[float | None, float | None] = (None, None)
        """Of the loop, on the recording clock [s]; None: the recording's own."""
        self.looping = self._closed = False
        self._clock = clock
        self._cursor = ReplayCursor(recording)
        self._filled = False  # all of the past read, and all milestones found
        self._said = recording.version > 1  # it holds what the lab noticed
        self._search = iter(()) if self._said else self._cursor.milestone_times()
        self._milestone_times: list[float] = []  # s, on the recording clock, as far as known by now
        self._milestones: tuple[int, list[Milestone]] = 0, []  # of the run of this number, in its order
        self._events: list[Event] = []  # as many as there were behind the playhead:
        self._events_done = 0
        self._mark_events: list[Event] = []
        self._ticks: list[float] = []  # for so many marks and milestones:
        self._ticks_known = -1, -1

    @property
    def so_far(self) -> RunSoFar:
        return self._cursor.so_far

    @property
    def run(self) -> "Run":
        return self._cursor.run

    @property
    def loop(self) -> tuple[float, float] | None:
        """From where to where to play again and again [s]."""
        return self.stretch(*self.ends) if self.looping else None

    def stretch(self, start: float | None, end: float | None) -> tuple[float, float] | None:
        """What a loop with these ends would play [s]; None if that has no length."""
        start, end = 0.0 if start is None else start, self.length if end is None else end
        return (min(start, end), max(start, end)) if start != end else None

    @property
    def events(self) -> Sequence[Event]:
        """What was done up to the playhead; of very many events, the last."""
        done = bisect_right(self.recording.events.clocks, self.playhead.position)
        if done != self._events_done:
            recent = self.recording.events[max(0, done - EVENTS_SHOWN) : done]
            self._events_done, self._events = done, [event for _, event in recent]
        return self._events

    @property
    def milestones(self) -> Sequence[Milestone]:
        """What the lab noticed; a recording of format 1 does not say, and it follows from the samples."""
        if not self._said:
            return super().milestones
        number = self.run.number
        if self._milestones[0] != number:
            found = (milestone for _, milestone in self.recording.events.milestones(number))
            self._milestones = number, sorted(found, key=attrgetter("step"))
        known = self._milestones[1]
        done = bisect_right(known, self.sample.step, key=attrgetter("step"))
        return known[max(0, done - EVENTS_SHOWN) : done]

    @property
    def judgements(self) -> Sequence[Judgement]:
        """The verdicts that the lab gave; the trends follow from the samples, once all those before have been read."""
        computed = super().judgements if self.knows_past else [Judgement()] * len(self.scene.cast)
        if not self._said:
            return computed
        since = change_before(self.changes, self.sample.step).step
        said = {each.method: each.verdict for each in self.milestones if each.kind == "verdict" and each.step > since}
        return [
            judgement if reading.diverged_at is not None else judgement._replace(verdict=said.get(method, "too early"))
            for method, judgement, reading in zip(self.scene.cast, computed, self.sample.readings, strict=True)
        ]

    @property
    def later_marks(self) -> Sequence[Event]:
        marks = list(self.marks)
        if len(self._mark_events) != len(marks):
            self._mark_events = list(mark_events(marks, self.recording.events))
        done = bisect_right(marks, self.playhead.position, key=attrgetter("clock"))
        return self._mark_events[max(0, done - EVENTS_SHOWN) : done]

    @property
    def stepping(self) -> Stepping:
        return self._cursor.changes(self.playhead.position)[-1].stepping

    @property
    def knows_past(self) -> bool:
        return self._cursor.knows_past

    @property
    def is_at_rest(self) -> bool:
        """Paused, with all of the past read and all milestones found."""
        return self.playhead.paused and self._filled

    @property
    def recording_status(self) -> RecordingStatus:
        return RecordingStatus(self.recording.path.name, self.length, self.recording.bytes)

    def tick(self, now: float) -> Sample:
        """Follow the clock to `now`: stop at the ends, or go round in the loop."""
        self.playhead = self.playhead.at(now)
        if not self.playhead.paused and not self._closed:
            self._stay_inside()
            self._cursor.go_to(self.playhead.position)
        self.fill()
        return self.sample

    def fill(self) -> bool:
        """Read more of the past, and then look for milestones; whether the past of the sample is known by now."""
        if self._closed:
            return True
        until = self._clock() + FILL_BUDGET
        filled = self._cursor.fill(lambda: self._clock() < until)
        times: list[float] | None = []
        while self._clock() < until and (times := next(self._search, None)) is not None:
            self._milestone_times += times
        self._filled = filled and times is None
        return filled

    def pause(self, paused: bool) -> None:
        """Pause or go on; from the end, go on from the start."""
        self.playhead = self.playhead._replace(paused=paused)
        position, backwards = self.playhead.position, self.playhead.speed < 0
        if not paused and position == (0.0 if backwards else self.length):
            self.seek(self.length if backwards else 0.0)

    def set_speed(self, speed: float) -> None:
        """Play `speed` seconds of the recording for each second of the clock; a negative one plays backwards."""
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
        self._filled = False
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
            self.seek(min((tick for tick in self.ticks if tick > position + 1e-6), default=self.length))
        else:
            self.seek(max((tick for tick in self.ticks if tick < position - 0.3), default=0.0))

    @property
    def ticks(self) -> list[float]:
        """The events, marks and milestones known by now, on the recording clock [s]."""
        known = len(list(self.marks)), len(self._milestone_times)
        if known != self._ticks_known:
            done = self.recording.events.done()
            marked = (mark.clock for mark in self.marks)
            self._ticks_known, self._ticks = known, sorted({*done, *marked, *self._milestone_times})
        return self._ticks

    def mark(self, text: str | None = None) -> None:
        """Leave a mark at the sample, unless it has one; it is kept next to the recording, which is not touched."""
        if not self.is_marked:
            self.marks.add(Mark(self.playhead.position, self.sample.run, self.sample.step, text))

    def live(self) -> Live:
        """A lab that goes on from here with the same bits, and with what is known of the past."""
        return Live(self.scene, changes=self._cursor.changes(self.playhead.position)[1:], so_far=self.so_far)

    def close(self) -> None:
        """Close the file; a frame that was due already shows what was there."""
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
            self.playhead = self.playhead._replace(paused=True).moved_to(start if backwards else end)
