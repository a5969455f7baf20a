"""Row: a sample of a history; without NumPy, which the first paint does not wait for."""

from collections.abc import Sequence
from typing import NamedTuple


class Row(NamedTuple):
    """A sample as charts and trails need it; the fields of the records that keep it."""

    step: int
    x: float  # s, simulated time covered
    t: float  # s, simulated
    states: Sequence[Sequence[float]]  # of the methods and the exact motion: theta, omega
    low: list[list[float]]  # of each quantity and method, since the row before
    high: list[list[float]]
