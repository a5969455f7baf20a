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
from engine.scenes import SceneError
from tui.drawing.canvas import Canvas
from tui.drawing.palette import EXACT, FRAME, faint, inks
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.messages import Asked, Held, MethodChosen, SceneChosen
from tui.views.reach import Reach, frame
from tui.views.view import Pane

TOP = 4  # dots between the edge and a pivot at the top
# rods of a spring, over that at rest: what there is room for, and what is drawn
STRETCHED = 1.1
LONGEST = 4.0
GRAB = 3  # columns that the pointer moves before it is no click
THROW = 0.1  # s of the pointer's way that decide its speed
MAGNIFIED = 0.8  # rad, to which small swings are enlarged
TRAIL = 15  # samples, half a second at 30 frames a second


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
    letters: list[_Letter] = []
    for bob in bobs:
        right = sin(bob.theta)
        down = cos(bob.theta)
        rod = length * min(bob.length, LONGEST)
        x = x0 + rod * right
        y = y0 + rod * down
        canvas.line(x0, y0, x, y, bob.ink, dotted=bob.ghost or bob.diverged)
        if bob.diverged:
            size = bob_radius + 1
            canvas.line(x - size, y - size, x + size, y + size, bob.ink)
            canvas.line(x - size, y + size, x + size, y - size, bob.ink)
        else:
            canvas.disc(x, y, bob_radius, bob.ink, hollow=bob.ghost)
        if bob.letter:
            column = int(x + (bob_radius + 2) * right) // 2
            letters.append((int(y + (bob_radius + 3) * down) // 4, column, bob.letter, bob.ink))
    for row, column, letter, ink in _fanned(letters, columns):
        canvas.label(column, row, letter, ink)
    canvas.points([(x0 - 1, y0 - 1), (x0, y0 - 1), (x0 - 1, y0), (x0, y0)], FRAME)
    return canvas.picture()


def _fanned(letters: Sequence[_Letter], columns: int) -> Iterator[_Letter]:
    """Yield letters with a blank between those that would touch."""
    groups: list[list[_Letter]] = []
    for each in sorted(letters, key=itemgetter(0, 1)):
        row, column = each[:2]
        if groups and groups[-1][-1][0] == row and column - groups[-1][-1][1] < 2:
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

    def __init__(self, reach: Reach, place: int | None = None, id: str | None = None) -> None:
        """`place` in the cast; None: all.  Panes that share a `reach` show the same samples."""
        super().__init__(id)
        self._reach = reach
        self._place = place
        self._down: Offset | None = None  # where the button went down
        self._held: list[tuple[float, float]] = []  # s and rad, of the pointer since

    # The mouse

    def on_mouse_down(self, event: events.MouseDown) -> None:
        if event.button == 1:
            self.capture_mouse()
            self._down = event.screen_offset
            self._held.clear()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Hold the bob at the pointer, once that has moved far enough to be no click."""
        if self._down is None or not (self._held or self._is_far(event)):
            return
        if not self.is_live:
            self._let_go()
            self.post_message(Asked("change"))
            return
        self._held.append((event.time, self._theta(event)))
        self._reach.is_held = True
        self.post_message(Held(self._held[-1][1]))

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Start where the bob is let go; a click shows this method alone, or all again."""
        if self._down is None:
            return
        held = [*self._held]
        self._let_go()
        if held:
            self.post_message(Held(None))
            self._start(held, event.time)
        elif self._place is not None:
            self.post_message(MethodChosen(self._place))

    def _is_far(self, event: events.MouseMove) -> bool:
        assert self._down is not None
        across, down = event.screen_offset - self._down
        return max(abs(across), 2 * abs(down)) >= GRAB  # a cell is twice as high as wide

    def _let_go(self) -> None:
        self.release_mouse()
        self._down = None
        self._held.clear()
        self._reach.is_held = False

    def _theta(self, event: events.MouseEvent) -> float:
        """Return the angle of the pointer [rad] about a pivot in the middle."""
        x, y = event.get_content_offset_capture(self)
        right = 2 * x + 1 - self.room.width
        down = 4 * y + 2 - 2 * self.room.height
        return round(atan2(right, down), 3)

    def _start(self, held: Sequence[tuple[float, float]], now: float) -> None:
        """Ask for a run from the angle at which the bob is let go, at the pointer's speed."""
        source = self.source
        if source is None:
            return
        theta = held[-1][1]
        recent = [each for each in held if now - each[0] < THROW]
        omega = 0.0
        if len(recent) > 1 and recent[-1][0] > recent[0][0]:
            moved = remainder(recent[-1][1] - recent[0][1], tau)
            seconds = (recent[-1][0] - recent[0][0]) * abs(source.playhead.speed)
            omega = round(moved / seconds, 2)
        h = source.stepping.smallest
        try:
            scene = source.scene.altered(theta=theta, omega=omega, h=h)
        except SceneError as error:
            self.notify(str(error), severity="warning")
        else:
            self.post_message(SceneChosen(scene))

    def picture(self, source: Source, sample: Sample) -> Picture:
        place = self._place
        if place is not None and place >= len(self.cast):
            return Picture()
        places = self.places if place is None else [place]
        title = "Pendulums"
        if place is not None:
            title = self.cast[place].label
        scale = self._scale(source, sample, places)
        if scale > 1:
            title += f", angles ×{scale}"
        self.write_titles(title, self._below(source, "dotted: exact" if place is None else ""))
        bobs = _ghosts(source, sample.t, places)
        bobs += [self._bob(source, sample, each) for each in places]
        bobs += _exact(source, sample.t) if self.shown.exact or place is None else []
        if scale > 1:
            bobs = [_magnified(bob, scale) for bob in bobs]
            return pendulum_picture(*self.room, bobs, MAGNIFIED)
        widest = self._reach.of(source, sample, self.places)
        if source.ghost is not None:
            widest = max(widest, source.ghost.widest)
        return pendulum_picture(*self.room, bobs, widest)

    def _scale(self, source: Source, sample: Sample, places: Sequence[int]) -> int:
        """Return by how much to enlarge angles that are too small to be seen; 1 once one is not."""
        if self.shown.overview or self._reach.is_held:
            return 1
        half = self.shown.theta or frame(source.scene, source.stepping, sample, self.places)
        thetas = [abs(sample.readings[each].theta) for each in places]
        return max(1, int(MAGNIFIED / half)) if max(thetas, default=pi) <= half else 1

    def _below(self, source: Source, exact: str) -> str:
        """Return the extra pendulums: a ghost, which comes first, and the exact motion."""
        room = self.room.width - 4
        if source.ghost is None:
            return exact
        dim = source.ghost.label(room - len(exact) - 2)
        both = f"{exact}, {dim}" if exact and dim else exact or dim
        return both if len(both) <= room else dim

    def _bob(self, source: Source, sample: Sample, place: int) -> Bob:
        model = source.scene.equations
        reading = sample.readings[place]
        return Bob(
            reading.theta,
            inks(self.cast)[place],
            trail=source.history.thetas(place, TRAIL) if model.rigid else (),
            length=model.length(reading.extra),
            letter=self.cast[place].letter if self._place is None else "",
            diverged=reading.diverged_at is not None,
        )


def _magnified(bob: Bob, scale: float) -> Bob:
    return bob._replace(theta=scale * bob.theta, trail=[scale * theta for theta in bob.trail])


def _ghosts(source: Source, t: float, places: Sequence[int]) -> list[Bob]:
    """Return the same methods of a ghost, fainter."""
    thetas = {} if source.ghost is None else source.ghost.rods(t)
    cast = source.scene.cast
    keys = [(inks(cast)[place], cast[place].key) for place in places]
    return [Bob(thetas[key], faint(ink)) for ink, key in keys if key in thetas]


def _exact(source: Source, t: float) -> list[Bob]:
    """The exact motion at a time [s], where it is known."""
    scene = source.scene
    model = source.scene.equations
    length = model.exact_length(scene.theta, scene.omega, t)
    theta = source.exact.at(t).theta
    return [Bob(theta, EXACT, ghost=True, length=length)] if isfinite(theta) else []
