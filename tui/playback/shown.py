"""Shown: which methods and quantities are on screen, and how.  Nothing in it changes a number."""

from typing import Any, NamedTuple

from engine.methods import Cast
from engine.scenes import Scene

Quantity = str
"""The name of what a chart shows: one of QUANTITIES, or a variable of the model that is not a part of its state."""
QUANTITIES: tuple[Quantity, ...] = ("energy_error", "theta_error", "shadow_error", "energy")

WINDOWS: tuple[float | None, ...] = (None, 20.0, 60.0, 300.0, 1800.0, 5.0)
"""How much of the past the chart shows [s]; None: the whole run."""


def quantities(scene: Scene) -> tuple[Quantity, ...]:
    """Return what a chart can show of a scene: only some models and methods have a modified energy."""
    model = scene.equations
    has_shadow = model.has_force and any(method.modified_energy for method in scene.cast)
    common = (quantity for quantity in QUANTITIES if has_shadow or quantity != "shadow_error")
    return *common, *(each.name for each in model.variables if not each.is_state)


class Stretch(NamedTuple):
    """A part of a run that the chart was zoomed to."""

    run: int
    begin: float  # s, simulated time run through
    end: float
    log_time: bool  # on a logarithmic axis of time


LARGEST = 1e6
"""Larger errors are drawn here, so that a method that fails leaves room for the others."""


class Shown(NamedTuple):
    """What is shown of a source, and how."""

    hidden: frozenset[str] = frozenset()  # keys of methods
    exact: bool = False  # the exact motion as a ghost
    overlay: bool = False  # all pendulums on one pivot, even where there is room for a pane each
    trails: bool = True
    quantity: Quantity = "energy_error"  # of the chart
    log: bool = True
    seconds: float | None = None  # of the chart, one of WINDOWS
    stretch: Stretch | None = None  # in place of that
    turn: int = 0  # place of the method that is to be alone next

    def places(self, cast: Cast) -> list[int]:
        """The places in the cast of the methods that are shown."""
        return [place for place, method in enumerate(cast) if method.key not in self.hidden]

    def toggled(self, place: int, cast: Cast) -> "Shown":
        """With one method of the cast shown or hidden; places after the last one are the exact motion's."""
        if place >= len(cast):
            return self._replace(exact=not self.exact)
        return self._replace(hidden=self.hidden ^ {cast[place].key})

    def switched(self, name: str) -> "Shown":
        """With one of the settings that are on or off the other way."""
        changes: dict[str, Any] = {name: not getattr(self, name)}
        return self._replace(**changes)

    def alone(self, place: int, cast: Cast) -> "Shown":
        """With this method alone; with all of them, if it is alone already."""
        others = frozenset(method.key for at, method in enumerate(cast) if at != place)
        return self._replace(hidden=frozenset() if self.places(cast) == [place] else others)

    def next_alone(self, cast: Cast) -> "Shown":
        """With all methods if one is alone, else with one alone: the first, the next time the second, and so on."""
        if len(alone := self.places(cast)) == 1 < len(cast):
            return self.alone(alone[0], cast)._replace(turn=alone[0] + 1)
        return self.alone(self.turn % len(cast), cast)

    def quantity_ahead(self, ahead: int, scene: Scene) -> Quantity:
        """The quantity `ahead` places after the chosen one, among those that the scene has."""
        known = quantities(scene)
        at = known.index(self.quantity) if self.quantity in known else 0
        return known[(at + ahead) % len(known)]

    def next_quantity(self, scene: Scene) -> "Shown":
        return self._replace(quantity=self.quantity_ahead(1, scene))

    def next_window(self, direction: int) -> "Shown":
        """With the window before the chart was zoomed; else with the next (1), the one before (-1), round and round."""
        if self.stretch is not None:
            return self._replace(stretch=None)
        return self._replace(seconds=WINDOWS[(WINDOWS.index(self.seconds) + direction) % len(WINDOWS)])

    def zoomed(self, stretch: Stretch | None) -> "Shown":
        """With this part of the run in the chart, or all of it."""
        return self._replace(stretch=stretch, seconds=self.seconds if stretch else None)

    def of(self, run: int) -> "Shown":
        """As it is for this run: another run's stretch says nothing about it."""
        return self if self.stretch is None or self.stretch.run == run else self._replace(stretch=None)
