"""Shown: the settings of the screen, which change no number."""

from dataclasses import replace
from typing import Any, NamedTuple

from pendu_tui.engine.methods import Cast
from pendu_tui.engine.quantities import ENERGY_ERROR, SHADOW_ERROR
from pendu_tui.engine.scenes import SCENES, Line, Scene, Shot

WINDOWS: tuple[float | None, ...] = (None, 20.0, 60.0, 300.0, 1800.0, 5.0)
"""The lengths of the chart [s]; None is the whole run."""

FAST = 4.0
"""Scenes that run at this multiple of real time or faster are charted over logarithmic time."""


def quantities(scene: Scene) -> tuple[str, ...]:
    model = scene.equations
    has_shadow = not model.without_force and any(m.modified_energy for m in scene.cast)
    known = (each.name for each in model.charted())
    return tuple(name for name in known if has_shadow or name != SHADOW_ERROR.name)


SEEN = ("theta", "quantity", "log", "seconds", "line", "ring")
"""The settings that are fields of a shot, too."""


class Stretch(NamedTuple):
    run: int
    begin: float  # s, simulated time covered
    end: float
    log_time: bool  # whether the time axis is logarithmic


class Shown(NamedTuple):
    hidden: frozenset[str] = frozenset()  # keys of methods
    exact: bool = False  # the exact motion, dotted
    quantity: str = ENERGY_ERROR.name  # of the chart
    log: bool = True
    log_time: bool = False  # on a logarithmic chart of the whole run
    seconds: float | None = None  # the length of the chart
    stretch: Stretch | None = None  # a zoom, in place of `seconds`
    theta: float | None = None  # rad, half the width of phase space; None fits the motion
    overview: bool = False  # all angles, pendulums not enlarged
    ring: bool = False
    section: bool = False  # one method's own map, in place of phase space
    line: Line | None = None
    held: float | None = None  # rad, where the user holds the pendulums; then there is no run

    def through(self, scene: Scene, shot: Shot | None = None) -> "Shown":
        """Return these settings with a shot, by default the scene's."""
        if shot is None:
            shot = scene.shot
            known = SCENES.get(scene.name)
            if known == scene and shot == Shot():  # as in a recording
                shot = known.shot
        cast = {method.key for method in scene.cast}
        front = cast.intersection(shot.front) or cast
        seen: dict[str, Any] = {name: getattr(shot, name) for name in SEEN}
        return self._replace(
            hidden=frozenset(cast - front),
            stretch=None,
            overview=False,
            section=False,
            log_time=scene.speed >= FAST,
            **seen,
        )

    def shot(self, scene: Scene, view: str, equal_cost: bool) -> Shot:
        """Return the shot that shows the scene like this, with moment, sentence and question."""
        front: tuple[str, ...] = ()
        if self.hidden:
            front = tuple(scene.cast[place].key for place in self.places(scene.cast))
        own: dict[str, Any] = {name: getattr(self, name) for name in SEEN}
        return replace(scene.shot, view=view, front=front, equal_cost=equal_cost, **own)

    def places(self, cast: Cast) -> list[int]:
        return [place for place, method in enumerate(cast) if method.key not in self.hidden]

    def toggled(self, place: int, cast: Cast) -> "Shown":
        """Show or hide a method of the cast, or the exact motion, which comes after the last."""
        if place >= len(cast):
            return self._replace(exact=not self.exact)
        return self._replace(hidden=self.hidden ^ {cast[place].key})

    def alone(self, place: int, cast: Cast) -> "Shown":
        others = frozenset(method.key for method in cast) - {cast[place].key}
        return self._replace(hidden=frozenset() if self.hidden == others else others)

    def quantity_ahead(self, ahead: int, scene: Scene) -> str:
        known = quantities(scene)
        index = known.index(self.quantity) if self.quantity in known else 0
        return known[(index + ahead) % len(known)]

    @property
    def has_log_time(self) -> bool:
        log_time = self.log_time and self.seconds is None
        if self.stretch is not None:
            log_time = self.stretch.log_time
        return self.log and log_time

    def next_axes(self) -> "Shown":
        """Return logarithmic axes, those with logarithmic time, or linear ones, in turn."""
        if self.log and not self.log_time:
            return self._replace(log_time=True)
        return self._replace(log=not self.log, log_time=False)

    def next_window(self) -> "Shown":
        if self.stretch is not None:
            return self._replace(stretch=None)
        known = [*WINDOWS, *({self.seconds} - {*WINDOWS})]  # a shot may have any length
        return self._replace(seconds=known[(known.index(self.seconds) + 1) % len(known)])

    def zoomed(self, stretch: Stretch | None) -> "Shown":
        return self._replace(stretch=stretch, seconds=self.seconds if stretch else None)

    def of(self, run: int) -> "Shown":
        if self.stretch and self.stretch.run == run:
            return self
        return self._replace(stretch=None)
