"""Past: what is known of a recorded run up to a moment, and how it is read."""

import math
from bisect import bisect_left
from collections.abc import Iterable, Iterator
from itertools import pairwise
from operator import itemgetter
from typing import TYPE_CHECKING

from engine.models.exact_pendulum import ExactMotion
from engine.run.lockstep import Sample
from engine.run.observer import RunObserver
from engine.scenes import Scene
from recordings.events import Event
from tui.playback.history import ErrorHistory

if TYPE_CHECKING:
    from recordings.recording import Recording

DENSE = 60.0  # s of the past that are read completely; what lies before,
PIECES = 300  # in at most so many pieces of a second, evenly spread
_step = itemgetter(0)


class RunSoFar:
    """A run up to a moment: its history, and what is known of it.  `events` are all of a recorded run's."""

    def __init__(self, scene: Scene, events: Iterable[Event] = ()) -> None:
        self._changes = [(event.step, event.equal_cost) for event in events if event.kind == "set_h"]
        self.exact = ExactMotion(scene)
        self.history = ErrorHistory(scene)
        self.observer = RunObserver(scene, self.exact)

    def add(self, sample: Sample) -> None:
        """Add a sample; an earlier one takes back what came after it, except from the verdicts."""
        first, last = (bisect_left(self._changes, step, key=_step) for step in (self.observer.seen, sample.step))
        for step, _ in self._changes[first:last]:
            self.observer.judge_anew(step)
        self.history.add(sample, self.exact.at(sample.t), last > 0 and self._changes[last - 1][1])
        self.observer.add(sample)

    def read(self, recording: "Recording", run: int, pieces: list[tuple[float, float]], last: int) -> Iterator[float]:
        """Add what pieces of the recording clock hold of a run before step `last`; yields each sample's clock."""
        for start, end in pieces:
            for clock, value in recording.entries(start, end, run):
                if value.run > run:
                    return
                if isinstance(value, Sample) and self.observer.seen < value.step < last:
                    self.add(value)
                    yield clock


def pieces(start: float, end: float) -> list[tuple[float, float]]:
    """What to read of [start, end]: all of the last DENSE seconds, and of what lies before at most PIECES seconds."""
    middle = max(start, end - DENSE)
    count = min(PIECES, math.ceil(middle - start))
    edges = [start + (middle - start) * n / count for n in range(count + 1)] if count else [middle]
    return [(begin, min(begin + 1.0, until)) for begin, until in pairwise(edges)] + [(middle, end)]
