"""How far the shadow energies are from where they were, along the samples of a run."""

import math
from collections.abc import Sequence

from engine.methods import METHODS
from engine.models.state import State
from engine.run.stepping import Stepping


class ModifiedEnergyErrors:
    """Shadow energy errors in the order of METHODS, relative like energy errors; nan for a method without one.

    Another step size has another shadow energy, so errors count from where the step size last changed.
    """

    def __init__(self, w0_squared: float, scale: float) -> None:
        self._w0_squared, self._scale = w0_squared, scale
        self._h, self._equal_cost = math.nan, False
        self._starts: list[float] = []

    def between(self, before: Sequence[State], now: Sequence[State], h: float, equal_cost: bool = False) -> list[float]:
        """The errors now, some steps of size h [s] after the states before, at equal cost or not (see Lockstep)."""
        # h is a quotient of differences, and no setting is so fine
        if not (math.isclose(h, self._h, rel_tol=1e-6) and equal_cost == self._equal_cost):
            self._h, self._equal_cost = h, equal_cost
            self._starts = self._energies(before)
        energies = self._energies(now)
        return [(energy - start) / self._scale for energy, start in zip(energies, self._starts, strict=True)]

    def _energies(self, states: Sequence[State]) -> list[float]:
        cuts = Stepping(self._h, self._equal_cost).parts()
        energies = [
            math.nan
            if method.modified_energy is None
            else method.modified_energy(self._w0_squared, *state, self._h / cut)
            for method, state, cut in zip(METHODS, states, cuts, strict=True)
        ]
        return [
            energy if math.isfinite(energy) else math.nan for energy in energies
        ]  # it may overflow where H does not
