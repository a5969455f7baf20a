"""Shown: which methods and quantities are on screen, and how.  Nothing in it changes a number."""

from dataclasses import dataclass, replace
from typing import Literal, get_args

from engine.methods import METHODS

Quantity = Literal["energy_error", "theta_error", "shadow_error", "energy"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)

WINDOWS: tuple[float | None, ...] = (5.0, 20.0, 60.0, 300.0, 1800.0, None)
"""How much of the past the chart shows [s]; None: the whole run."""


@dataclass(frozen=True, slots=True)
class Shown:
    """What is shown of a source, and how."""

    shown: tuple[bool, ...] = (True,) * len(METHODS)
    exact: bool = False  # the exact motion as a ghost
    trails: bool = True
    quantity: Quantity = "energy_error"  # of the chart
    log: bool = True
    seconds: float | None = 20.0  # of the chart, one of WINDOWS

    @property
    def indices(self) -> list[int]:
        """The shown methods as indices into METHODS."""
        return [index for index, shown in enumerate(self.shown) if shown]

    def toggled(self, number: int) -> "Shown":
        """With one method shown or hidden; the number after the last method's is the exact motion's."""
        if number == len(self.shown):
            return replace(self, exact=not self.exact)
        shown = tuple(was != (index == number) for index, was in enumerate(self.shown))
        return replace(self, shown=shown)

    def next_quantity(self) -> "Shown":
        return replace(self, quantity=QUANTITIES[(QUANTITIES.index(self.quantity) + 1) % len(QUANTITIES)])

    def next_window(self, forward: bool = True) -> "Shown":
        """With the chart's next longer window, or the next shorter one, round and round."""
        at = WINDOWS.index(self.seconds) + (1 if forward else -1)
        return replace(self, seconds=WINDOWS[at % len(WINDOWS)])
