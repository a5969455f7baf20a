"""Pendulum: one method's pendulum, or all on one pivot, in braille.

Dots are square in a cell twice as high as wide, so x and y have the same physical scale.  The pivot
is exactly in the middle, since explicit Euler goes over the top; where no method can, it is at the
top and the rods are longer.
"""

from collections.abc import Iterator, Sequence
from math import atan2, cos, isfinite, pi, remainder, sin, tau
from operator import itemgetter
from typing import NamedTuple

from textual import events
from textual.geometry import Offset

from engine.run.lockstep import Sample
from tui.drawing.canvas import Canvas
from tui.drawing.palette import EXACT, FRAME, faint, inks
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.reach import frame, reach
from tui.views.view import Held, Pane

TOP = 4  # dots between the edge and a pivot at the top
MAGNIFIED = 0.8  # rad, to which small swings are enlarged

_Letter = tuple[int, int, str, int]  # row, column, letter, ink


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
    """Draw pendulums on one pivot in `columns` × `rows` cells; later ones in front.

    The pivot is in the middle, or at the top if they stay within a `reach` [rad] of a quarter turn.
    """
    canvas = Canvas(columns, rows)
    x0 = canvas.width / 2
    y0 = canvas.height / 2
    room = min(x0, y0)
    if reach <= pi / 2:
        y0 = float(TOP)
        room = min(canvas.height - y0, x0 / sin(reach))
    radius = min(max(room / 9, 1.5), 3.0)
    if any(bob.letter for bob in bobs):
        room -= 4
    length = max(room - radius, 1.0)  # of the rod, in dots
    if any(bob.length != 1 for bob in bobs):
        length /= 1.1  # a spring stretches
    for bob in bobs:
        trail = [(x0 + length * sin(theta), y0 + length * cos(theta)) for theta in bob.trail]
        canvas.points(trail, faint(bob.ink))
    letters: list[_Letter] = []
    for bob in bobs:
        right = sin(bob.theta)
        down = cos(bob.theta)
        rod = length * min(bob.length, 4.0)
        x = x0 + rod * right
        y = y0 + rod * down
        canvas.line(x0, y0, x, y, bob.ink, dotted=bob.ghost or bob.diverged)
        if bob.diverged:
            size = radius + 1
            canvas.line(x - size, y - size, x + size, y + size, bob.ink)
            canvas.line(x - size, y + size, x + size, y - size, bob.ink)
        else:
            canvas.disc(x, y, radius, bob.ink, hollow=bob.ghost)
        if bob.letter:
            row = int(y + (radius + 3) * down) // 4
            letters.append((row, int(x + (radius + 2) * right) // 2, bob.letter, bob.ink))
    for row, column, letter, ink in _fanned(letters, columns):
        canvas.label(column, row, letter, ink)
    canvas.points([(x0 - 1, y0 - 1), (x0, y0 - 1), (x0 - 1, y0), (x0, y0)], FRAME)
    return canvas.picture()


def _fanned(letters: Sequence[_Letter], columns: int) -> Iterator[_Letter]:
    """Yield letters with a blank between those that would touch."""
    groups: list[list[_Letter]] = []
    for each in sorted(letters, key=itemgetter(0, 1)):
        if groups and groups[-1][-1][0] == each[0] and each[1] - groups[-1][-1][1] < 2:
            groups[-1].append(each)
        else:
            groups.append([each])
    for group in groups:
        first = (group[0][1] + group[-1][1]) // 2 - len(group) + 1
        first = max(min(first, columns - 2 * len(group) + 1), 0)
        for place, (row, _, letter, ink) in enumerate(group):
            yield row, first + 2 * place, letter, ink


class Pendulum(Pane):
    """The pendulum of one method, or those of all that are shown; its bob can be dragged."""

    MOVES = True

    def __init__(self, drag: list[tuple[float, float]], place: int | None = None) -> None:
        """`place` in the cast; None: all.  `drag`: s and rad of the pointer, for all panes."""
        super().__init__()
        self._drag = drag
        self._place = place
        self._down: Offset | None = None  # where the button went down

    def on_mouse_down(self, event: events.MouseDown) -> None:
        if event.button == 1:
            self.capture_mouse()
            self._down = event.screen_offset

    async def on_mouse_move(self, event: events.MouseMove) -> None:
        """Hold the bob at the pointer, once that has moved far enough to be no click."""
        if self._down is None:
            return
        across, down = event.screen_offset - self._down
        if not self._drag and max(abs(across), 2 * abs(down)) < 3:
            return
        if self.is_live:
            self._drag.append((event.time, self._theta(event)))
            self.post_message(Held(self._drag[-1][1]))
        else:
            self._let_go()
            await self.run_action("screen.change")

    async def on_mouse_up(self, event: events.MouseUp) -> None:
        """Start where the bob is let go; a click shows this method alone, or all again."""
        if self._down is None:
            return
        drag = [*self._drag]
        self._let_go()
        if drag:
            self.post_message(Held(None))
            self.throw(drag, event.time)
        elif self._place is not None:
            await self.run_action(f"screen.show_alone({self._place})")

    def _let_go(self) -> None:
        self.release_mouse()
        self._down = None
        self._drag.clear()

    def _theta(self, event: events.MouseEvent) -> float:
        """Return the angle of the pointer [rad] about a pivot in the middle."""
        x, y = event.get_content_offset_capture(self)
        right = 2 * x + 1 - self.room.width
        down = 4 * y + 2 - 2 * self.room.height
        return round(atan2(right, down), 3)

    def throw(self, drag: Sequence[tuple[float, float]], now: float) -> None:
        """Ask for a run from the last angle, at the speed of the pointer's last 0.1 s."""
        recent = [each for each in drag if now - each[0] < 0.1]
        omega = 0.0
        if len(recent) > 1 and recent[-1][0] > recent[0][0]:
            moved = remainder(recent[-1][1] - recent[0][1], tau)
            seconds = (recent[-1][0] - recent[0][0]) * abs(self.source.playhead.speed)
            omega = round(moved / seconds, 2)
        self.start_at(drag[-1][1], omega)

    def picture(self, source: Source, sample: Sample) -> Picture:
        place = self._place
        is_overlay = place is None
        places = self.places
        title = "Pendulums"
        if place is not None:
            if place >= len(self.cast):
                return Picture()
            places = [place]
            title = self.cast[place].label
        scale = self._scale(source, sample, places)
        if scale > 1:
            title += f", angles ×{scale}"
        self.write_titles(title, self._below(source, "dotted: exact" if is_overlay else ""))
        bobs = self._ghosts(source, sample.t, places)
        bobs += [self._bob(source, sample, each) for each in places]
        if self.shown.exact or is_overlay:
            bobs += _exact(source, sample.t)
        if scale > 1:
            widest = MAGNIFIED
        elif self._drag:
            widest = pi  # the pointer needs the room above the pivot, too
        else:
            widest = reach(source.scene, source.stepping, sample, self.places)
            if source.ghost is not None:
                widest = max(widest, source.ghost.widest)
        bobs = [
            bob._replace(theta=scale * bob.theta, trail=[scale * each for each in bob.trail])
            for bob in bobs
        ]
        return pendulum_picture(*self.room, bobs, widest)

    def _scale(self, source: Source, sample: Sample, places: Sequence[int]) -> int:
        """Return by how much to enlarge angles that are too small to be seen; 1 once one is not."""
        if self.shown.overview or self._drag:
            return 1
        half = self.shown.theta or frame(source.scene, source.stepping, sample, self.places)
        largest = max((abs(sample.readings[each].theta) for each in places), default=pi)
        return max(1, int(MAGNIFIED / half)) if largest <= half else 1

    def _below(self, source: Source, exact: str) -> str:
        """Return the extra pendulums: a ghost, which comes first, and the exact motion."""
        room = self.room.width - 4
        if source.ghost is None:
            return exact
        dim = source.ghost.label(room - len(exact) - 2)
        both = ", ".join(filter(None, (exact, dim)))
        return both if len(both) <= room else dim

    def _bob(self, source: Source, sample: Sample, place: int) -> Bob:
        model = source.scene.equations
        reading = sample.readings[place]
        return Bob(
            reading.theta,
            inks(self.cast)[place],
            trail=source.history.thetas(place, 15) if model.rigid else (),  # half a second
            length=model.length(reading.extra),
            letter=self.cast[place].letter if self._place is None else "",
            diverged=reading.diverged_at is not None,
        )

    def _ghosts(self, source: Source, t: float, places: Sequence[int]) -> list[Bob]:
        """Return the same methods of a ghost, fainter."""
        if source.ghost is None:
            return []
        thetas = source.ghost.rods(t)
        keys = [(inks(self.cast)[place], self.cast[place].key) for place in places]
        return [Bob(thetas[key], faint(ink)) for ink, key in keys if key in thetas]


def _exact(source: Source, t: float) -> list[Bob]:
    """Return the exact motion at a time [s], where it is known."""
    scene = source.scene
    length = scene.equations.exact_length(scene.theta, scene.omega, t)
    theta = source.exact.at(t).theta
    return [Bob(theta, EXACT, ghost=True, length=length)] if isfinite(theta) else []
