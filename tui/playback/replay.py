"""Replay: a recording that follows the clock, forwards and backwards."""

import math
import time
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from pendu_tui.engine.run.lockstep import Lockstep, Sample
from pendu_tui.engine.run.stepping import SteppingChange
from pendu_tui.engine.run.verdicts import FAILED, Judgement, Milestone
from pendu_tui.recordings.events import Event, check_present, is_present
from pendu_tui.recordings.files import printable
from pendu_tui.tui.playback.history import History
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.source import Playhead, RecordingStatus, Source

if TYPE_CHECKING:
    from pendu_tui.recordings.recording import Recording, Run, SamplePlace

MAX_FOLLOWED = 100  # samples; over longer distances it jumps
MAX_STRETCHES = 300  # of the time before the last minute, of which a second each is read


class Replay(Source):
    """A recording on screen.  The playhead is on the recording clock."""

    kind = "REPLAY"
    length = 0.0
    run: "Run"
    _reading: Iterator[None]  # reads more of the past at each step

    def __init__(
        self, recording: "Recording", clock: Callable[[], float] = time.perf_counter
    ) -> None:
        self.recording = recording
        self.length = recording.length  # s
        self.playhead = Playhead()
        self._clock = clock
        first = recording.at(0.0)
        assert first is not None  # or it is not opened
        self._show(first, jump=True)
        self._judging = Lockstep(self.scene, judged=True)  # knows what a verdict needs
        self._know()

    # The state at the playhead

    @property
    def events(self) -> Sequence[Event]:
        here = self.playhead.position
        return [event for clock, event in self.recording.events if clock <= here]

    @property
    def _past_changes(self) -> list[SteppingChange]:
        """The run's changes of step up to the sample and the playhead."""
        clocks = [clock for clock, event in self.run.events if event.h is not None]
        count = 1 + bisect_right(clocks, self.playhead.position)
        return [each for each in self.changes[:count] if each.step <= self.sample.step]

    def _know(self) -> None:
        """Read what was known at the playhead off the events."""
        step = self.sample.step
        since, _, self.stepping, _ = self._past_changes[-1]
        if (self.scene, self.stepping) != (self._judging.scene, self._judging.stepping):
            self._judging = Lockstep(self.scene, judged=True)
            self._judging.set_stepping(self.stepping)
        self.milestones = [each for each in self.run.milestones if each.step <= step]
        verdicts = {
            each.method: each
            for each in self.milestones
            if each.kind == "verdict" and each.step > since
        }
        self.judgements = [
            self._judgement(index, step - since, verdicts.get(method))
            for index, method in enumerate(self.scene.cast)
        ]

    def _judgement(self, index: int, steps: int, last: Milestone | None) -> Judgement:
        """Return what is known of a method, so many steps after a change, by its last verdict."""
        if self.sample.readings[index].diverged_at is not None:
            return Judgement(FAILED)
        found = Judgement()
        if last is not None:
            found = found._replace(verdict=last.verdict, lyapunov=last.lyapunov)
            return found._replace(slope=last.trend, is_evident=last.trend is not None)
        if is_present(self.scene.cast[index]):
            found = found._replace(progress=self._judging.progress(index, steps))
        return found

    @property
    def recording_status(self) -> RecordingStatus:
        return RecordingStatus(printable(self.recording.path.name), self.length)

    @property
    def places(self) -> Sequence[tuple[float, Event]]:
        return self.recording.events

    @property
    def counts(self) -> dict[str, tuple[int, int]]:
        runs = self.recording.runs
        return {
            "run": (runs.index(self.run) + 1, len(runs)),
            "step": (self.sample.step, self.run.steps),
        }

    # The user's actions

    def tick(self, now: float) -> Sample:
        self.playhead.follow(now)
        if not self.playhead.paused:
            position = self.playhead.position
            end = min(max(position, 0.0), self.length)
            if self.looping and position != end:
                self.playhead.position = self.length - end
            elif position != end:
                self.playhead.position = end
                self.playhead.paused = True
            self._follow()
        self.fill()
        return self.sample

    def pause(self, paused: bool) -> None:
        """Pause or go on; at the end, go on from the start."""
        self.playhead.paused = paused
        end = self.length if self.playhead.speed > 0 else 0.0
        if not paused and self.playhead.position == end:
            self.seek(self.length - end)

    def set_speed(self, speed: float) -> None:
        self.playhead.speed = speed

    def step(self, n: int) -> Sample:
        self.pause(True)
        direction = int(math.copysign(1, n))
        for _ in range(abs(n)):
            if place := self.recording.beside(self._place, direction):
                self._show(place)
        self.playhead.position = self.recording.sample(self._place).clock
        self._know()
        return self.sample

    def seek(self, position: float) -> None:
        self.playhead.position = min(max(position, 0.0), self.length)
        self._follow()

    def live(self) -> Live:
        """Return a lab that continues from here with the same bits.

        Raises RecordingError if the run has a user's own method that was not given.
        """
        check_present(self.scene)
        history = self.history.continued(self._past_changes)
        return Live(self.scene, abs(self.playhead.speed), history=history)

    def close(self) -> None:
        """Close the file; a frame that is still due shows the last sample."""
        self.playhead.paused = True
        self._reading = iter(())
        self.recording.close()

    # Samples of the file

    def _follow(self) -> None:
        """Show the last sample before the playhead, adding those in between if they are few."""
        target = self.recording.at(self.playhead.position) or self._place
        for _ in range(MAX_FOLLOWED):
            if self._place < target and (following := self.recording.beside(self._place, 1)):
                self._show(following)
        if target != self._place:
            self._show(target, jump=self._place < target)
        self._know()

    def _show(self, place: "SamplePlace", jump: bool = False) -> None:
        """Show the sample at a place.

        After a jump the trails are read at once, the rest of the past over the next frames.
        """
        self._place = place
        clock, sample = self.recording.sample(place)
        assert isinstance(sample, Sample)
        if jump or sample.run != self.run.number:
            run = self.run = self.recording.run_of(sample.run)
            self.history = History(run.scene, run.changes)
            for _ in self._read(self.history, max(run.begin, clock - 1.0), clock, sample.step):
                pass
            self.knows_past = False
            self._reading = self._past()
        self.history.add(sample)

    def fill(self) -> bool:
        """Read more of the past for some milliseconds; return whether all has been read."""
        until = self._clock() + 0.006  # s a frame
        for _ in self._reading:
            if self._clock() >= until:
                return False
        self.knows_past = True
        return True

    def _past(self) -> Iterator[None]:
        """Read the last minute, and of longer runs the first seconds of equal stretches before."""
        history = History(self.run.scene, self.run.changes)
        second = self.run.begin
        last_minute = max(second, self.recording.sample(self._place).clock - 60.0)
        stretch = max(1.0, (last_minute - second) / MAX_STRETCHES)
        while second < self.recording.sample(self._place).clock:
            yield from self._read(history, second, second + 1.0, self.sample.step)
            second += 1.0
            if stretch > 1.0 and second < last_minute:
                history.gap = history.step
                second = min(second + stretch - 1.0, last_minute)
        history.add(self.sample)
        self.history = history

    def _read(self, history: History, start: float, end: float, last: int) -> Iterator[None]:
        """Add the run's samples before step `last` from a piece of the recording clock."""
        for _, sample in self.recording.samples_between(start, end):
            if sample.run == self.run.number and sample.step < last:
                history.add(sample)
                yield
