"""The order of a simulation, from the energies of runs that differ in their step size alone.

A symplectic method of order p makes the energy fluctuate by an amount that goes as h^p; a force
that is one step old, a forgotten half kick or a thermostat does not.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

BATCHES = 16
MIN_SAMPLES = 4 * BATCHES  # each batch has a mean of its own


class Fluctuation(NamedTuple):
    """The standard deviation of energies about a line, with its standard error, in their unit."""

    size: float
    uncertainty: float


class Order(NamedTuple):
    """The power of the step size with which a fluctuation goes, with its standard error."""

    power: float
    uncertainty: float

    @property
    def highest(self) -> float | None:
        """The highest power that the runs allow; None: they do not tell one order from the next."""
        if 2 * self.uncertainty >= 1:
            return None
        return self.power + 2 * self.uncertainty

    @property
    def advice(self) -> str:
        """How long runs tell one order from the next, a clause."""
        longer = math.ceil((2 * self.uncertainty) ** 2 + 1)
        return f"runs about {longer} times as long would tell one order from the next"

    def __str__(self) -> str:
        return f"h^{self.power:.2f} ± {self.uncertainty:.2f}"


def fluctuation(times: "Floats", energies: "Floats") -> Fluctuation:
    """Return how far energies fluctuate about the line through them.

    The uncertainty is that of batch means: Flegal & Jones, Annals of Statistics 38 (2010) 1034.
    It is right if a batch, a sixteenth of the record, is longer than the energy remembers.  Raises
    ValueError for fewer than MIN_SAMPLES samples.
    """
    import numpy as np

    if len(energies) < MIN_SAMPLES:
        raise ValueError(f"{len(energies)} energies are too few; give {MIN_SAMPLES} or more.")
    t = (times - times.mean()) / (times[-1] - times[0])
    largest = float(np.abs(energies).max()) or 1.0
    e = energies / largest
    e = e - e.mean()
    e = e - t * (t @ e) / (t @ t)
    squares = np.array([batch.mean() for batch in np.array_split(e * e, BATCHES)])
    variance = float(squares.mean())
    error = float(squares.std(ddof=1)) / math.sqrt(BATCHES)
    size = math.sqrt(variance)
    return Fluctuation(largest * size, largest * error / (2 * size) if size else 0.0)


def order_of(steps: Sequence[float], fluctuations: Sequence[Fluctuation]) -> Order:
    """Return the slope of log fluctuation over log step, weighted by the uncertainties.

    Raises ValueError unless two step sizes differ and all fluctuations are above zero.
    """
    if len(set(steps)) < 2 or min(steps) <= 0:
        raise ValueError("give two step sizes or more, all above zero and not all the same.")
    if not all(each.size > 0 for each in fluctuations):
        raise ValueError("an energy that never changes has no order.")
    logs = [math.log(step) for step in steps]
    errors = [max(each.uncertainty / each.size, 1e-12) for each in fluctuations]
    weights = [error**-2 for error in errors]
    middle = sum(w * x for w, x in zip(weights, logs, strict=True)) / sum(weights)
    spread = sum(w * (x - middle) ** 2 for w, x in zip(weights, logs, strict=True))
    power = sum(
        w * (x - middle) * math.log(each.size)
        for w, x, each in zip(weights, logs, fluctuations, strict=True)
    )
    return Order(power / spread, spread**-0.5)
