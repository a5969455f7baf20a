"""What is known of the run on screen so far, alike for a lab and a replay."""

from collections.abc import Sequence

from engine.run.lockstep import Sample
from engine.run.observer import Milestone, RunObserver
from engine.run.stepping import SteppingChange, change_before
from engine.scenes import Scene
from tui.playback.history import ErrorHistory


class RunSoFar:
    """A run up to a sample: its history for the chart, and the verdicts and milestones that follow from it."""

    sample: Sample

    def __init__(self, scene: Scene, changes: Sequence[SteppingChange]) -> None:
        """`changes` are those of the run, its start's first; a live run adds to them."""
        self.changes = changes
        self.observer = RunObserver(scene)
        self.history = ErrorHistory(self.observer)
        self._latest: Sample | None = None

    def add(self, sample: Sample) -> list[Milestone]:
        """Add a sample; an earlier one takes back what came after it, except from the verdicts.

        Returns the milestones on the way to it.
        """
        change = change_before(self.changes, sample.step)
        news = self.observer.add(sample, change)
        modified = self.observer.modified_energy_errors(self._latest, sample, change)
        self.history.add(sample, self.observer.exact.at(sample.t), modified)
        self.sample = self._latest = sample
        return news
