"""ReplayCursor: where in a recording a replay stands, and how the past of that moment is read."""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator
from itertools import pairwise
from operator import attrgetter
from typing import TYPE_CHECKING

from engine.run.lockstep import Sample
from engine.run.stepping import Stepping, SteppingChange
from tui.playback.so_far import RunSoFar

if TYPE_CHECKING:
    from recordings.recording import Recording, Run, SamplePlace

MAX_FOLLOWED = 100  # samples; what lies further ahead is jumped to
TAIL = 1.0  # s of the past that are there at once after a jump, for the trails,
RECENT = 20.0  # and some frames later, for the chart
DENSE = 60.0  # s of the past that are read completely; what lies before,
MAX_PIECES = 300  # in pieces of a second, evenly spread
NANOSECOND = 1e-9  # s; clocks in a file are rounded to it


class ReplayCursor:
    """A place in a recording: its run and past; after a jump the past is read piecemeal."""

    run: "Run"
    so_far: RunSoFar

    def __init__(self, recording: "Recording") -> None:
        self.recording = recording
        self.clock = 0.0  # s, on the recording clock: where the sample is
        self._filling: Iterator[None] | None = None
        first = recording.at(0.0)
        assert first is not None, "a recording without samples is refused before it gets here"
        self._jump(first)

    def changes(self, position: float) -> list[SteppingChange]:
        """Return how the run steps, up to the sample and to a moment of the recording clock [s]."""
        by_step = bisect_right(self._changes, self.so_far.sample.step, key=attrgetter("step"))
        return self._changes[: max(1, min(by_step, bisect_right(self._clocks, position)))]

    def go_to(self, position: float) -> None:
        """Go to the last sample before a moment [s], through those between where they are few."""
        target = self.recording.at(position + NANOSECOND) or self._place
        ahead = [target] if target < self._place else []
        at = self._place
        while at < target and len(ahead) < MAX_FOLLOWED and (following := self.recording.next(at)):
            at = following
            ahead.append(at)
        if at < target:
            self._jump(target)
            return
        for place in ahead:
            self._move(place)

    def place(self, number: int, step: int) -> float | None:
        """Return when a run came to a step [s of the recording clock]; None if it never did."""
        run = self.recording.run_of(number)
        if run is None:
            return None

        def step_at(nanosecond: int) -> int:
            at = self.recording.at(nanosecond * NANOSECOND)
            sample = self.recording.sample(at).value if at else None
            return sample.step if isinstance(sample, Sample) and sample.run == number else -1

        begin = round(run.begin / NANOSECOND)
        end = round(run.end / NANOSECOND)
        return (begin + bisect_left(range(begin, end), step, key=step_at)) * NANOSECOND

    def step(self, n: int) -> None:
        """Go n samples forward, or back where n is negative."""
        move = self.recording.next if n > 0 else self.recording.previous
        for _ in range(abs(n)):
            if place := move(self._place):
                self._move(place)

    def fill(self, is_time_left: Callable[[], bool]) -> bool:
        """Read more of the past; return whether all of it that will be read has been."""
        while self._filling is not None and is_time_left():
            if next(self._filling, self) is self:
                self._filling = None
        return self._filling is None

    def _move(self, place: "SamplePlace") -> None:
        """Show the sample at a place that is close to the last one."""
        clock, sample = self.recording.sample(place)
        assert isinstance(sample, Sample)
        if sample.run != self.run.number:
            self._jump(place)
            return
        self._place = place
        self.clock = clock
        self.so_far.add(sample)

    def _jump(self, place: "SamplePlace") -> None:
        """Show the sample at a place: the trails at once, the rest over the next frames."""
        self._place = place
        self.clock, sample = self.recording.sample(place)
        assert isinstance(sample, Sample)
        run = self.recording.run_of(sample.run)
        assert run is not None
        self.run = run
        set_h = [(clock, event) for clock, event in run.events if event.h is not None]
        self._clocks = [-math.inf, *(clock for clock, _ in set_h)]  # s, of these changes:
        self._changes = [SteppingChange(0, 0.0, Stepping(run.scene.h, cast=run.scene.cast))]
        for _, event in set_h:
            stepping = Stepping(event.h or 0.0, event.equal_cost, run.scene.cast)
            self._changes.append(SteppingChange(event.step, event.t, stepping))
        self.so_far = RunSoFar(run.scene, self._changes)
        for _ in self._read(
            self.so_far, max(run.begin, self.clock - TAIL), self.clock, sample.step
        ):
            pass
        self.so_far.add(sample)
        self._filling = self._fill()

    def _fill(self) -> Iterator[None]:
        """Read the recent past, then all, and then the samples that have come since."""
        run = self.run
        for start in sorted({max(run.begin, self.clock - RECENT), run.begin}, reverse=True):
            so_far = RunSoFar(run.scene, self._changes)
            while start < self.clock:
                end = self.clock
                for piece in pieces(start, end):
                    yield from self._read(so_far, *piece, self.so_far.sample.step)
                start = end
            so_far.add(self.so_far.sample)
            self.so_far = so_far

    def _read(self, so_far: RunSoFar, start: float, end: float, last: int) -> Iterator[None]:
        """Add the run's samples from a piece of the recording clock before step `last`."""
        for _, sample in self.recording.samples_between(start, end):
            before = getattr(so_far, "sample", None)
            is_new = before is None or sample.step > before.step
            if sample.run == self.run.number and is_new and sample.step < last:
                so_far.add(sample)
                yield


def pieces(start: float, end: float) -> list[tuple[float, float]]:
    """Return what to read of [start, end]: the last DENSE seconds, and short pieces before."""
    middle = max(start, end - DENSE)
    count = min(MAX_PIECES, math.ceil(middle - start))
    edges = [start + (middle - start) * n / count for n in range(count + 1)] if count else []
    return [(begin, min(begin + 1.0, until)) for begin, until in pairwise(edges)] + [(middle, end)]
