"""ReplayCursor: where in a recording a replay stands, and how the past of that moment is read."""

import math
from bisect import bisect_right
from collections.abc import Callable, Iterator
from itertools import pairwise
from operator import attrgetter
from typing import TYPE_CHECKING

from engine.run.lockstep import Sample
from engine.run.stepping import Stepping, SteppingChange
from tui.playback.so_far import RunSoFar

if TYPE_CHECKING:
    from recordings.recording import Recording, SamplePlace
    from recordings.timeline import Run

FOLLOWED = 100  # samples: what lies closer ahead is played through, what lies further is jumped to
TAIL = 1.0  # s of the past that are there at once after a jump, for the trails,
RECENT = 20.0  # and some frames later, for the chart
DENSE = 60.0  # s of the past that are read completely; what lies before,
PIECES = 300  # in at most so many pieces of a second, evenly spread
NANOSECOND = 1e-9  # s; clocks in a file are rounded to it, and a frame must not miss its sample by half of it


class ReplayCursor:
    """A place in a recording: the run there and what is known of it, which after a jump is read bit by bit."""

    run: "Run"
    so_far: RunSoFar

    def __init__(self, recording: "Recording") -> None:
        self.recording = recording
        self.clock = 0.0  # s, on the recording clock: where the sample is
        self._changes = {
            run.number: [SteppingChange(0, 0.0, Stepping(run.scene.h, cast=run.scene.cast))] for run in recording.runs
        }
        self._clocks = {run.number: [-math.inf] for run in recording.runs}  # s, of those changes
        for clock, event in recording.events:
            if event.h is not None and event.run in self._changes:
                cast = self._changes[event.run][0].stepping.cast
                change = SteppingChange(event.step, event.t, Stepping(event.h, event.equal_cost, cast))
                self._changes[event.run].append(change)
                self._clocks[event.run].append(clock)
        self._filling: Iterator[float] | None = None
        self._stale = False  # the sample lies before what the verdicts know of
        first = recording.at(0.0)
        assert first is not None, "a recording without samples is refused before it gets here"
        self._jump(first)

    def changes(self, position: float) -> list[SteppingChange]:
        """How the run steps, up to the sample and to a moment of the recording clock [s]."""
        changes, clocks = self._changes[self.run.number], self._clocks[self.run.number]
        by_step = bisect_right(changes, self.so_far.sample.step, key=attrgetter("step"))
        return changes[: min(by_step, bisect_right(clocks, position))]

    def go_to(self, position: float) -> None:
        """Go to the last sample before a moment [s]: through those between where they are few, else by a jump."""
        recording, at = self.recording, self._place
        target = recording.at(position + NANOSECOND) or at
        ahead: list[SamplePlace] = []
        while at < target and len(ahead) < FOLLOWED and (following := recording.next(at)):
            ahead.append(at := following)
        if at < target:
            self._jump(target)
            return
        if target < self._place:
            ahead, self._stale = [target], True
        for place in ahead:
            self._move(place)

    def place(self, number: int, step: int) -> float | None:
        """When a run came to a step, on the recording clock [s]; None where there is no such run."""
        run = next((run for run in self.recording.runs if run.number == number), None)
        if run is None:
            return None
        early, late = run.begin, run.end
        while late - early > NANOSECOND:
            middle = (early + late) / 2
            at = self.recording.at(middle)
            sample = None if at is None else self.recording.sample(at)[1]
            if isinstance(sample, Sample) and (sample.run, sample.step) < (number, step):
                early = middle
            else:
                late = middle
        return late

    def step(self, n: int) -> None:
        """Go n samples forward, or back where n is negative."""
        for _ in range(abs(n)):
            place = self.recording.next(self._place) if n > 0 else self.recording.previous(self._place)
            if place is None:
                break
            self._move(place)
        self._stale |= n < 0

    def fill(self, is_time_left: Callable[[], bool]) -> bool:
        """Read more of the past; whether it is known by now as far as it can be."""
        if self._stale and self._filling is None:
            self._filling, self._stale = self._fill(), False
        while self._filling is not None and is_time_left():
            if next(self._filling, None) is None:
                self._filling = None
        return self.knows_past

    @property
    def knows_past(self) -> bool:
        """Whether the past of the sample is known as far as it can be."""
        return self._filling is None and not self._stale

    def milestone_times(self) -> Iterator[list[float]]:
        """When the methods did something, run by run, as times [s] of the recording clock; in many small steps."""
        for run in self.recording.runs:
            if run.steps == 0:
                continue
            so_far, known, before, then = self._nothing_known(run), 0, 0, run.begin
            for clock in self._read(so_far, run, pieces(run.begin, run.end), run.steps + 1):
                step = so_far.sample.step
                milestones = so_far.observer.milestones(step)
                shares = [  # of a long run not every sample is read
                    (each.step - before) / (step - before) if step > before else 1.0 for each in milestones[known:]
                ]
                yield [then + share * (clock - then) for share in shares]
                known, before, then = len(milestones), step, clock

    def _move(self, place: "SamplePlace") -> None:
        """Show the sample at a place that is close to the last one."""
        clock, sample = self.recording.sample(place)
        assert isinstance(sample, Sample)
        if sample.run != self.run.number:
            self._jump(place)
            return
        self._place, self.clock = place, clock
        self.so_far.add(sample)

    def _jump(self, place: "SamplePlace") -> None:
        """Show the sample at any place: the trails' past at once, the rest during the next frames."""
        self._place = place
        self.clock, sample = self.recording.sample(place)
        assert isinstance(sample, Sample)
        self.run = self.recording.runs[self.recording.runs.place(sample.run)]
        so_far = self._nothing_known(self.run)
        tail = [(max(self.run.begin, self.clock - TAIL), self.clock)]
        for _ in self._read(so_far, self.run, tail, sample.step):
            pass
        so_far.add(sample)
        self.so_far, self._filling = so_far, self._fill()

    def _fill(self) -> Iterator[float]:
        """Read the past of the sample, and then that of the samples that have come since: the recent past, then all."""
        run = self.run
        for begin in sorted({max(run.begin, self.clock - RECENT), run.begin}, reverse=True):
            so_far, start = self._nothing_known(run), begin
            while start < self.clock:
                end = self.clock
                yield from self._read(so_far, run, pieces(start, end), self.so_far.sample.step)
                start = end
            so_far.add(self.so_far.sample)
            self.so_far = so_far

    def _nothing_known(self, run: "Run") -> RunSoFar:
        """A run before any of its samples has been read."""
        return RunSoFar(run.scene, self._changes[run.number])

    def _read(self, so_far: RunSoFar, run: "Run", pieces: list[tuple[float, float]], last: int) -> Iterator[float]:
        """Add what pieces of the recording clock hold of a run before step `last`; yields each sample's clock."""
        for start, end in pieces:
            for clock, value in self.recording.entries(start, end, run.number):
                if value.run > run.number:
                    return
                if isinstance(value, Sample) and so_far.observer.seen < value.step < last:
                    so_far.add(value)
                    yield clock


def pieces(start: float, end: float) -> list[tuple[float, float]]:
    """What to read of [start, end]: all of the last DENSE seconds, and of what lies before at most PIECES seconds."""
    middle = max(start, end - DENSE)
    count = min(PIECES, math.ceil(middle - start))
    edges = [start + (middle - start) * n / count for n in range(count + 1)] if count else [middle]
    return [(begin, min(begin + 1.0, until)) for begin, until in pairwise(edges)] + [(middle, end)]
