"""The run on screen so far, alike for a lab and a replay."""

import math
from collections.abc import Sequence

from engine.run.lockstep import Sample
from engine.run.stepping import Stepping, SteppingChange, change_before
from engine.scenes import Scene
from tui.playback.history import ErrorHistory


class RunSoFar:
    """A run up to a sample, with its history for the chart."""

    sample: Sample

    def __init__(self, scene: Scene, changes: Sequence[SteppingChange]) -> None:
        """`changes` are those of the run, its start's first; a live run adds to them."""
        self.scene = scene
        self.exact = scene.exact()
        self.changes = changes
        self.history = ErrorHistory(scene)
        self.step = -1  # of the last sample
        self._scale = scene.equations.reference(scene.theta, scene.omega).scale
        # by the step of the change that they begin at
        self._modified_starts: dict[int, list[float]] = {}

    def add(self, sample: Sample, is_row: bool = True) -> None:
        """Show a sample, and remember it if it is a row of the history."""
        change = change_before(self.changes, sample.step)
        modified = self._modified_energy_errors(sample, change)
        self.history.add(sample, self.exact.at(sample.t), modified, is_row)
        self.sample = sample
        self.step = sample.step

    def _modified_energy_errors(self, sample: Sample, change: SteppingChange) -> list[float]:
        """Return each modified energy's relative change since the stepping changed.

        Another step size has another modified energy.  nan for a method without one, and where no
        sample before this one has been added since the change.
        """
        starts = self._modified_starts.get(change.step)
        if starts is None:
            if not change.step <= self.step < sample.step:
                return [math.nan] * len(self.scene.cast)
            starts = self._modified_energies(self.sample, change.stepping)
            self._modified_starts = {
                at: each for at, each in self._modified_starts.items() if at < change.step
            }
            self._modified_starts[change.step] = starts
        energies = self._modified_energies(sample, change.stepping)
        return [(now - start) / self._scale for now, start in zip(energies, starts, strict=True)]

    def _modified_energies(self, sample: Sample, stepping: Stepping) -> list[float]:
        model = self.scene.equations
        energies = []
        for method, reading, h in zip(self.scene.cast, sample.readings, stepping.own, strict=True):
            energy = math.nan
            if method.modified_energy and model.has_force:
                energy = method.modified_energy(model, (reading.theta, reading.omega), h)
            # it overflows where H does not
            energies.append(energy if math.isfinite(energy) else math.nan)
        return energies
