"""Pendulum: one method's pendulum, or all on one pivot, in braille.

Dots are square in a cell twice as high as wide, so x and y have the same physical scale.  The pivot is exactly in
the middle, since explicit Euler goes over the top; where no method can, it is at the top and the rods are longer.
"""

from collections.abc import Sequence
from math import cos, isfinite, pi, sin
from typing import NamedTuple

from engine.run.lockstep import Sample
from tui.drawing.canvas import Canvas
from tui.drawing.palette import EXACT, FRAME, faint, inks, mark
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.lab.reach import Reach
from tui.views.messages import MethodChosen
from tui.views.view import Pane

TOP = 4  # dots between the edge and a pivot at the top
STRETCHED, LONGEST = (
    1.1,
    4.0,
)  # rods of a spring, over that at rest: what there is room for, and what is drawn
TRAIL = 15  # samples, half a second at 30 frames a second


class Bob(NamedTuple):
    """One pendulum to draw."""

    theta: float  # rad from the downward vertical
    ink: int
    trail: Sequence[float] = ()  # rad; where it was, drawn faintly
    letter: str = ""  # written next to it, so that colour is not alone
    ghost: bool = False  # the exact swing: dotted and hollow
    length: float = 1.0  # of the rod, over that at rest
    diverged: bool = False  # its numbers ended here: crossed out


def pendulum_picture(columns: int, rows: int, bobs: Sequence[Bob], reach: float = pi) -> Picture:
    """Pendulums on one pivot in `columns` × `rows` cells; later ones in front.

    The pivot is in the middle, or at the top if they stay within a `reach` [rad] of a quarter turn.
    """
    canvas = Canvas(columns, rows)
    x0, y0 = canvas.width / 2, canvas.height / 2
    room = min(x0, y0)
    if reach <= pi / 2:
        y0 = float(TOP)
        room = min(canvas.height - y0, x0 / sin(reach))
    bob_radius = min(max(room / 9, 1.5), 3.0)
    room_for_letters = 4 if any(bob.letter for bob in bobs) else 0
    length = max(room - bob_radius - room_for_letters, 1.0)  # of the rod, in dots

    if any(bob.length != 1 for bob in bobs):
        length /= STRETCHED
    for bob in bobs:
        canvas.points(
            [(x0 + length * sin(theta), y0 + length * cos(theta)) for theta in bob.trail],
            faint(bob.ink),
        )
    for bob in bobs:
        right, down = sin(bob.theta), cos(bob.theta)
        rod = length * min(bob.length, LONGEST)
        x, y = x0 + rod * right, y0 + rod * down
        canvas.line(x0, y0, x, y, bob.ink, dotted=bob.ghost or bob.diverged)
        if bob.diverged:
            size = bob_radius + 1
            canvas.line(x - size, y - size, x + size, y + size, bob.ink)
            canvas.line(x - size, y + size, x + size, y - size, bob.ink)
        else:
            canvas.disc(x, y, bob_radius, bob.ink, hollow=bob.ghost)
        column, row = int(x + (bob_radius + 2) * right) // 2, int(y + (bob_radius + 3) * down) // 4
        beside = (*range(column, column + len(bobs)), *range(column - 1, column - len(bobs), -1))
        canvas.label(
            next((at for at in beside if canvas.is_free(at, row)), column), row, bob.letter, bob.ink
        )
    canvas.points([(x0 - 1, y0 - 1), (x0, y0 - 1), (x0 - 1, y0), (x0, y0)], FRAME)
    return canvas.picture()


class Pendulum(Pane):
    """The pendulum of one method, or those of all that are shown, with their letters."""

    def __init__(self, reach: Reach, place: int | None = None, id: str | None = None) -> None:
        """`place` in the cast; None: all.  Panes that share a `reach` show the same samples."""
        super().__init__(id)
        self._reach = reach
        self._place = place

    def on_click(self) -> None:
        """Show this method alone, or all again."""
        if self._place is not None:
            self.post_message(MethodChosen(self._place))

    def picture(self, source: Source, sample: Sample) -> Picture:
        place = self._place
        if place is None:
            places = self.places
            self.write_titles("Pendulums", self._below(source, "dotted: exact"))
        elif place < len(self.cast):
            places = [place]
            self.write_titles(
                f"{mark(place, self.cast[place])} {self.cast[place].label}", self._below(source, "")
            )
        else:
            return Picture()
        bobs = _exact(source, sample.t) if self.shown.exact or place is None else []
        bobs += _ghosts(source, sample.t, places)
        bobs += [self._bob(source, sample, each) for each in places]
        widest = self._reach.of(source, sample, self.places)
        if source.ghost is not None:
            widest = max(widest, source.ghost.widest)
        return pendulum_picture(*self.room, bobs, widest)

    def _below(self, source: Source, exact: str) -> str:
        """Return what is beside the methods: the exact motion, and a ghost, which comes first if room is short."""
        room = self.room.width - 4
        if source.ghost is None:
            return exact
        dim = source.ghost.label(room - len(exact) - 2)
        both = f"{exact}, {dim}" if exact and dim else exact or dim
        return both if len(both) <= room else dim

    def _bob(self, source: Source, sample: Sample, place: int) -> Bob:
        model = source.scene.equations
        reading = sample.readings[place]
        has_trail = self.shown.trails and model.rigid  # other rods have had many lengths
        return Bob(
            reading.theta,
            inks(self.cast)[place],
            trail=source.history.thetas(place, TRAIL) if has_trail else (),
            length=model.length(reading.extra),
            letter=self.cast[place].letter if self._place is None else "",
            diverged=reading.diverged_at is not None,
        )


def _ghosts(source: Source, t: float, places: Sequence[int]) -> list[Bob]:
    """Return the same methods of a ghost, fainter."""
    rods = {} if source.ghost is None else source.ghost.rods(t)
    cast = source.scene.cast
    shown = [
        (inks(cast)[place], rods[cast[place].key]) for place in places if cast[place].key in rods
    ]
    return [Bob(rod.theta, faint(ink), length=rod.length) for ink, rod in shown]


def _exact(source: Source, t: float) -> list[Bob]:
    """The exact motion at a time [s], where it is known."""
    scene, model = source.scene, source.scene.equations
    length = model.exact_length(scene.theta, scene.omega, t)
    theta = source.exact.at(t).theta
    return [Bob(theta, EXACT, ghost=True, length=length)] if isfinite(theta) else []
