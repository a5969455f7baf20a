"""Pendulum: one method's pendulum, or all on one pivot, in braille, whose dots are square."""

from collections.abc import Sequence
from math import atan2, cos, isfinite, pi, remainder, sin, tau
from operator import attrgetter
from typing import NamedTuple

from textual import events
from textual.geometry import Offset

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import EXACT, FRAME, faint, inks
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.reach import reach
from pendu_tui.tui.views.view import Held, Pane

TOP = 4  # dots between the edge and a pivot at the top
MAGNIFIED = 0.8  # rad, to which small swings are enlarged


class _Letter(NamedTuple):
    row: int
    column: int
    text: str
    ink: int


class Bob(NamedTuple):
    theta: float  # rad from the downward vertical
    ink: int
    trail: Sequence[float] = ()  # rad, earlier angles, drawn faintly
    letter: str = ""  # written beside it, for those who cannot tell colours
    ghost: bool = False  # the exact swing: dotted and hollow
    length: float = 1.0  # of the rod, relative to that at rest
    diverged: bool = False  # crossed out: its numbers ended here

    def enlarged(self, scale: int) -> "Bob":
        trail = [scale * theta for theta in self.trail]
        return self._replace(theta=scale * self.theta, trail=trail)


def pendulum_picture(columns: int, rows: int, bobs: Sequence[Bob], reach: float = pi) -> Picture:
    """Draw pendulums on one pivot, later ones in front.

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
            column = int(x + (radius + 2) * right) // 2
            letters.append(_Letter(row, column, bob.letter, bob.ink))
    _write(canvas, sorted(letters, key=attrgetter("row", "column")))
    canvas.points([(x0 - 1, y0 - 1), (x0, y0 - 1), (x0 - 1, y0), (x0, y0)], FRAME)
    return canvas.picture()


def _write(canvas: Canvas, letters: Sequence[_Letter]) -> None:
    """Write letters with a blank between those that would touch."""
    groups: list[list[_Letter]] = []
    previous: _Letter | None = None
    for letter in letters:
        if previous and previous.row == letter.row and letter.column - previous.column < 2:
            groups[-1].append(letter)
        else:
            groups.append([letter])
        previous = letter
    for group in groups:
        middle = (group[0].column + group[-1].column) // 2
        first = min(middle - len(group) + 1, canvas.columns - 2 * len(group) + 1)
        for place, letter in enumerate(group):
            canvas.label(max(first, 0) + 2 * place, letter.row, letter.text, letter.ink)


class Pendulum(Pane):
    """The pendulum of one method, or those of all that are shown; its bob can be dragged."""

    MOVES = True

    def __init__(self, drag: list[tuple[float, float]], place: int | None = None) -> None:
        """`place` in the cast, or None for all; `drag` [s, rad] is shared by all panes."""
        super().__init__()
        self._drag = drag
        self._place = place
        self._down: Offset | None = None  # where the button went down

    def on_mouse_down(self, event: events.MouseDown) -> None:
        if event.button == 1:
            self.capture_mouse()
            self._down = event.screen_offset

    async def on_mouse_move(self, event: events.MouseMove) -> None:
        """Hold the bob at the pointer once this is clearly a drag, not a click."""
        if self._down is None:
            return
        across, down = event.screen_offset - self._down
        if not self._drag and max(abs(across), 2 * abs(down)) < 3:
            return
        if not self.is_live:
            self._let_go()
            await self.run_action("screen.change")
            return
        x, y = event.get_content_offset_capture(self)
        right = 2 * x + 1 - self.room.width  # from a pivot in the middle
        down = 4 * y + 2 - 2 * self.room.height
        theta = round(atan2(right, down), 3)
        self._drag.append((event.time, theta))
        self.post_message(Held(theta))

    async def on_mouse_up(self, event: events.MouseUp) -> None:
        if self._down is None:
            return
        drag = [*self._drag]
        self._let_go()
        if drag:
            self.post_message(Held(None))
            self._throw(drag, event.time)
        elif self._place is not None:
            await self.run_action(f"screen.show_alone({self._place})")

    def _throw(self, drag: Sequence[tuple[float, float]], now: float) -> None:
        """Start a run from the last angle, at the pointer's speed over the last 0.1 s."""
        recent = [(time, theta) for time, theta in drag if now - time < 0.1] or drag[-1:]
        first_time, first_theta = recent[0]
        last_time, last_theta = recent[-1]
        seconds = (last_time - first_time) * abs(self.source.playhead.speed)
        omega = 0.0
        if seconds > 0:
            omega = round(remainder(last_theta - first_theta, tau) / seconds, 2)
        self.start_at(last_theta, omega)

    def _let_go(self) -> None:
        self.release_mouse()
        self._down = None
        self._drag.clear()

    def picture(self, source: Source, sample: Sample) -> Picture:
        shown = places = self.places
        title = "Pendulums"
        exact = "dotted: exact"
        if self._place is not None:
            if self._place >= len(self.cast):
                return Picture()
            places = [self._place]
            title = self.cast[self._place].label
            exact = ""
        frame, widest = reach(source.scene, source.stepping, sample, shown)
        if source.ghost is not None:
            widest = max(widest, source.ghost.widest)
        bobs = self._bobs(source, sample, places)
        if self._drag:
            widest = pi  # the pointer needs the room above the pivot, too
        elif not self.shown.overview:
            half = self.shown.theta or frame
            largest = max((abs(sample.readings[each].theta) for each in places), default=pi)
            scale = int(MAGNIFIED / half)
            if scale > 1 and largest <= half:  # too small to be seen
                widest = MAGNIFIED
                title += f", angles ×{scale}"
                bobs = [bob.enlarged(scale) for bob in bobs]
        self.write_titles(title, exact)
        return pendulum_picture(*self.room, bobs, widest)

    def _bobs(self, source: Source, sample: Sample, places: Sequence[int]) -> list[Bob]:
        scene = source.scene
        model = scene.equations
        colours = inks(scene.cast)
        bobs: list[Bob] = []
        if source.ghost is not None:
            thetas = source.ghost.rods(sample.t)
            for place in places:
                if (key := scene.cast[place].key) in thetas:
                    bobs.append(Bob(thetas[key], faint(colours[place])))
        for place in places:
            reading = sample.readings[place]
            bob = Bob(
                reading.theta,
                colours[place],
                length=model.length(reading.extra),
                diverged=reading.diverged_at is not None,
            )
            if model.rigid:
                bob = bob._replace(trail=source.history.thetas(place, 15))  # half a second
            if self._place is None:
                bob = bob._replace(letter=scene.cast[place].letter)
            bobs.append(bob)
        if self.shown.exact or self._place is None:
            theta = source.exact.at(sample.t).theta
            if isfinite(theta):
                length = model.exact_length(scene.theta, scene.omega, sample.t)
                bobs.append(Bob(theta, EXACT, ghost=True, length=length))
        return bobs
