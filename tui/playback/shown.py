"""Shown: which methods and quantities are on screen, and how.  Nothing in it changes a number."""

from dataclasses import dataclass, replace
from typing import Literal, get_args

from engine.methods import Cast

Quantity = Literal["energy_error", "theta_error", "shadow_error", "energy"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)

WINDOWS: tuple[float | None, ...] = (5.0, 20.0, 60.0, 300.0, 1800.0, None)
"""How much of the past the chart shows [s]; None: the whole run."""


@dataclass(frozen=True, slots=True)
class Shown:
    """What is shown of a source, and how."""

    hidden: frozenset[str] = frozenset()  # keys of methods
    exact: bool = False  # the exact motion as a ghost
    trails: bool = True
    quantity: Quantity = "energy_error"  # of the chart
    log: bool = True
    seconds: float | None = 20.0  # of the chart, one of WINDOWS

    def places(self, cast: Cast) -> list[int]:
        """The places in the cast of the methods that are shown."""
        return [place for place, method in enumerate(cast) if method.key not in self.hidden]

    def toggled(self, place: int, cast: Cast) -> "Shown":
        """With one method of the cast shown or hidden; places after the last one are the exact motion's."""
        if place >= len(cast):
            return replace(self, exact=not self.exact)
        return replace(self, hidden=self.hidden ^ {cast[place].key})

    def next_quantity(self) -> "Shown":
        return replace(self, quantity=QUANTITIES[(QUANTITIES.index(self.quantity) + 1) % len(QUANTITIES)])

    def next_window(self, forward: bool = True) -> "Shown":
        """With the chart's next longer window, or the next shorter one, round and round."""
        at = WINDOWS.index(self.seconds) + (1 if forward else -1)
        return replace(self, seconds=WINDOWS[at % len(WINDOWS)])
