"""Reel: where in a recording a replay stands, and what is known of the past of that moment."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from engine.run.lockstep import Sample
from tui.playback.past import RunSoFar, pieces

if TYPE_CHECKING:
    from recordings.recording import Recording, SamplePlace
    from recordings.timeline import Run

FOLLOWED = 100  # samples: what lies closer ahead is played through, what lies further is jumped to
TAIL = 1.0  # s of the past that are there at once after a jump, for the trails,
RECENT = 20.0  # and some frames later, for the chart
NANOSECOND = 1e-9  # s; clocks in a file are rounded to it, and a frame must not miss its sample by half of it


class ReplayCursor:
    """A place in a recording: the sample there, its run, and the past, which after a jump is read bit by bit."""

    sample: Sample
    run: "Run"
    past: RunSoFar

    def __init__(self, recording: "Recording") -> None:
        self.recording = recording
        self.clock = 0.0  # s, on the recording clock: where the sample is
        self._filling: Iterator[object] | None = None
        self._stale = False  # the sample lies before what the past knows of
        first = recording.at(0.0)
        assert first is not None, "a recording without samples is refused before it gets here"
        self._jump(first)

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

    def step(self, n: int) -> None:
        """Go n samples on, or back where n is negative."""
        for _ in range(abs(n)):
            place = self.recording.next(self._place) if n > 0 else self.recording.previous(self._place)
            if place is None:
                break
            self._move(place)
        self._stale |= n < 0

    def fill(self, is_time_left: Callable[[], bool]) -> None:
        """Read more of the past."""
        if self._stale and self._filling is None:
            self._filling, self._stale = self._fill(), False
        while self._filling is not None and is_time_left():
            if next(self._filling, self) is self:
                self._filling = None

    @property
    def filled(self) -> bool:
        """Whether the past is known as far as it can be."""
        return self._filling is None and not self._stale

    def _move(self, place: "SamplePlace") -> None:
        """Show the sample at a place that is close to the last one."""
        clock, value = self.recording.sample(place)
        assert isinstance(value, Sample)
        if value.run != self.sample.run:
            self._jump(place)
            return
        self._place, self.clock, self.sample = place, clock, value
        self.past.add(value)

    def _jump(self, place: "SamplePlace") -> None:
        """Show the sample at any place: the trails' past at once, the rest during the next frames."""
        self._place = place
        self.clock, value = self.recording.sample(place)
        assert isinstance(value, Sample)
        self.sample = value
        self.run = self.recording.runs[self.recording.runs.place(value.run)]
        self.past = self._nothing_known()
        tail = [(max(self.run.begin, self.clock - TAIL), self.clock)]
        for _ in self.past.read(self.recording, value.run, tail, value.step):
            pass
        self.past.add(value)
        self._filling = self._fill()

    def _nothing_known(self) -> RunSoFar:
        """The past before any of it has been read."""
        return RunSoFar(self.run.scene, (event for _, event in self.recording.events.of(self.run.number)))

    def _fill(self) -> Iterator[object]:
        """Read the past of the sample, and then that of the samples that have come since: the recent past, then all."""
        run = self.run
        for begin in sorted({max(run.begin, self.clock - RECENT), run.begin}, reverse=True):
            past, start = self._nothing_known(), begin
            while start < self.clock and self.run is run:
                end = self.clock
                yield from past.read(self.recording, run.number, pieces(start, end), self.sample.step)
                start = end
            if self.run is not run:
                return
            past.add(self.sample)
            self.past = past
