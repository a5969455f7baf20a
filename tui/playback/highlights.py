"""Highlights: when in a recording its methods did something; found run by run, while the replay plays."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from tui.playback.past import RunSoFar, pieces

if TYPE_CHECKING:
    from recordings.recording import Recording


class Highlights:
    """What the diary would list of each run at its end, as times of the recording clock."""

    def __init__(self, recording: "Recording") -> None:
        self.clocks: list[float] = []  # s
        self._search = self._find(recording)

    def find(self, is_time_left: Callable[[], bool]) -> None:
        """Look further ahead."""
        while is_time_left() and next(self._search, self) is not self:
            pass

    def _find(self, recording: "Recording") -> Iterator[object]:
        for run in recording.runs:
            yield run
            if run.steps == 0:
                continue
            events = (event for _, event in recording.events.of(run.number))
            past, known, before, then = RunSoFar(run.scene, events), 0, 0, run.begin
            for clock in past.read(recording, run.number, pieces(run.begin, run.end), run.steps + 1):
                milestones, step = past.observer.milestones(past.observer.seen), past.observer.seen
                for each in milestones[known:]:  # of a long run not every sample is read
                    share = (each.step - before) / (step - before) if step > before else 1.0
                    self.clocks.append(then + share * (clock - then))
                known, before, then = len(milestones), step, clock
                yield clock
