"""One pendulum with a lane for each method, in braille, whose dots are square.

All bobs swing about one pivot, each on a circle of its own.  Equal angles lie on one ray, so a
method that lags is seen off the ray of the others.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from math import asin, atan2, ceil, copysign, cos, hypot, isfinite, nan, pi, remainder, sin, tau
from typing import NamedTuple, TypeVar

from textual import events
from textual.geometry import Offset

from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.picture import EXACT, FRAME, Picture, faint, inks
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.view import Held, Pane
from pendu_tui.tui.views.viewport import amplitude, reach

Dot = tuple[float, float]
"""A place on the canvas, in dots to the right and down."""

Each = TypeVar("Each")

TRAIL = 15  # samples: half a second
RECENT = 4  # of them, drawn twice as wide
GAP = 1.0  # rad between samples, beyond which nothing is known of the way
STRETCH = 1.1  # over its rest length, of a spring that holds
LETTERED = 2.5  # dots: a bob of this radius has its letter inside


class Bob(NamedTuple):
    """A method's bob."""

    theta: float  # rad from the downward vertical
    ink: int
    letter: str
    ahead: float = 1.0  # in the direction of its angular velocity
    trail: Sequence[float] = ()  # rad, angles up to the present one
    length: float = 1.0  # of the rod, over that at rest
    diverged: bool = False  # crossed out: its numbers ended here
    ghost: float = nan  # rad, of the same method in an earlier run


class Look(NamedTuple):
    """What the bobs have in common."""

    widest: float = pi  # rad: they swing no further
    exact: float = nan  # rad, of the exact pendulum
    exact_length: float = 1.0
    amplitude: float = 0.0  # rad, of the exact pendulum
    rigid: bool = True  # no springs
    joins: bool = True  # whether the way from sample to sample is known


class Lanes(NamedTuple):
    """The pivot, the radius of a bob, and those of the lanes, in dots."""

    x: float
    y: float
    bob: float
    radii: tuple[float, ...]  # the first method's is outermost

    def point(self, radius: float, theta: float) -> Dot:
        return self.x + radius * sin(theta), self.y + radius * cos(theta)

    def place(self, bob: Bob, radius: float) -> Dot:
        """Return where a bob is on its lane, or on its spring."""
        return self.point(radius * min(bob.length, 4.0), bob.theta)

    def ring(self, radius: float) -> list[Dot]:
        """Return the dots of a circle twice over, counter-clockwise from the bottom."""
        count = max(ceil(1.2 * tau * radius), 1)
        return 2 * [self.point(radius, tau * nth / count) for nth in range(count)]


@lru_cache(maxsize=32)
def _ring(columns: int, rows: int, places: Lanes, radius: float) -> list[tuple[int, int]]:
    """Return the dots of a circle on a canvas of this size, as `Lanes.ring` does."""
    return Canvas(columns, rows).dots_of(places.ring(radius))


def arc(ring: list[Each], begin: float, end: float) -> list[Each]:
    """Return the part of a ring from one angle to a larger one [rad]."""
    count = len(ring) // 2
    first = round(begin % tau / tau * count) % count
    return ring[first : first + 1 + round(min((end - begin) / tau, 1.0) * (count - 1))]


def lanes(columns: int, rows: int, count: int, widest: float, rigid: bool) -> Lanes:
    """Return the largest lanes on which so many bobs swing up to `widest` [rad].

    They are at least a bob apart.  Bobs on springs share one.
    """
    width = 2.0 * columns
    height = 4.0 * rows
    across = sin(min(widest, pi / 2))
    above = max(-cos(widest), 0.0)  # over the pivot, in radii

    def outermost(bob: float) -> float:
        return max(min((width / 2 - bob) / across, (height - 2 * bob) / (1 + above)), 1.0)

    bob = min(max(outermost(3.0) / 10, 1.0), 3.5)
    apart = 0.0
    if count > 1 and rigid:
        apart = min(0.65 * outermost(bob) / (count - 1), 3 * bob)
        bob = min(bob, max((apart - 0.5) / 2, 1.0))
    outer = outermost(bob)
    y = (height - outer * (1 + above)) / 2 + outer * above
    if not rigid:
        outer /= STRETCH
    return Lanes(width / 2, y, bob, tuple([outer - place * apart for place in range(count)]))


@lru_cache(maxsize=8)
def _backdrop(columns: int, rows: int, places: Lanes, angle: float) -> Canvas:
    """Draw each lane, dotted as far as the exact pendulum swings [rad]."""
    canvas = Canvas(columns, rows)
    for radius in places.radii:
        right = arc(places.ring(radius), 0.0, angle)[2::4]
        left = [(2 * places.x - x, y) for x, y in right]
        canvas.points([*left, *right], FRAME)
    return canvas


def stage_picture(columns: int, rows: int, bobs: Sequence[Bob], look: Look) -> Picture:
    """Draw bobs on one pivot, each on its lane or on its spring."""
    places = lanes(columns, rows, len(bobs), look.widest, look.rigid)
    pivot = places.point(0.0, 0.0)
    canvas = Canvas(columns, rows)
    if look.rigid:
        canvas = _backdrop(columns, rows, places, look.amplitude).copy()
    if isfinite(look.exact):
        rod = max(places.radii, default=places.y) * look.exact_length
        canvas.line(*pivot, *places.point(rod, look.exact), EXACT, dotted=True)
    for bob, radius in zip(bobs, places.radii, strict=True):
        _draw(canvas, places, radius, bob, look)
    for bob, radius in zip(bobs, places.radii, strict=True):
        canvas.label_near(_wanted(canvas, places, bob, radius), bob.letter, bob.ink)
    canvas.disc(*pivot, places.bob / 2, FRAME)
    return canvas.picture()


def _draw(canvas: Canvas, places: Lanes, radius: float, bob: Bob, look: Look) -> None:
    ring = _ring(canvas.columns, canvas.rows, places, radius)
    inside = _ring(canvas.columns, canvas.rows, places, radius - 1)
    for begin, end in _stretches(bob.trail[: 1 - RECENT], look.joins):
        canvas.dots(arc(ring, begin, end), faint(bob.ink))
    for begin, end in _stretches(bob.trail[-RECENT:], look.joins):
        canvas.dots(arc(ring, begin, end), bob.ink)
        canvas.dots(arc(inside, begin, end), bob.ink)
    size = places.bob
    if isfinite(bob.ghost):
        canvas.disc(*places.point(radius, bob.ghost), size, faint(bob.ink), hollow=True)
    x, y = places.place(bob, radius)
    rod = bob.ink
    if look.rigid:
        rod = faint(rod)
    canvas.line(places.x, places.y, x, y, rod, dotted=bob.diverged)
    if bob.diverged:
        canvas.line(x - size, y - size, x + size, y + size, bob.ink)
        canvas.line(x - size, y + size, x + size, y - size, bob.ink)
    else:
        canvas.disc(x, y, size, bob.ink)


def _stretches(trail: Sequence[float], joins: bool) -> Iterator[tuple[float, float]]:
    """Yield the stretches of angles [rad] that a trail covers without a gap."""
    begin = 0
    for end, (before, after) in enumerate(pairwise(trail), 1):
        if not joins or abs(after - before) > GAP:
            yield min(trail[begin:end]), max(trail[begin:end])
            begin = end
    if trail:
        yield min(trail[begin:]), max(trail[begin:])


_AROUND = sorted(
    ((column, row) for column in range(-20, 21) for row in range(-10, 11)),
    key=lambda cell: hypot(2 * cell[0], 4 * cell[1]),
)
"""Cells around one, the nearest first."""


def _wanted(canvas: Canvas, places: Lanes, bob: Bob, radius: float) -> Iterator[tuple[int, int]]:
    """Yield cells for a letter: in a large bob, else ahead of it, behind, and all around."""
    right, down = places.place(bob, radius)
    x = min(max(right, 0.0), canvas.width - 1.0)
    y = min(max(down, 0.0), canvas.height - 1.0)
    column = int(x) // 2
    row = int(y) // 4
    size = places.bob
    if size >= LETTERED:
        yield column, row
    for far in (size + 2, -size - 2):
        ahead = far * bob.ahead
        yield int(x + ahead * cos(bob.theta)) // 2, int(y - ahead * sin(bob.theta)) // 4
    yield from ((column + across, row + down) for across, down in _AROUND)


TITLES = ("One pivot, a lane for each method", "Pendulum, in lanes", "In lanes")
SPRINGS = ("A bob on a spring for each method", "Bobs on springs")
HARDEST = 5.0  # w0 of a throw: 6 times the energy that takes a pendulum over the top
MAGNIFIED = (0.4, 0.8)  # rad, between which the widest of small swings is enlarged


class Lens(NamedTuple):
    """A scale of angles: up to `half` [rad] they are enlarged, and the rest fits the circle."""

    half: float = pi
    times: int = 1

    def __call__(self, theta: float) -> float:
        if self.times == 1 or not isfinite(theta):
            return theta
        rest = remainder(theta, tau)
        edge = self.times * self.half
        seen = self.times * abs(rest)
        if seen > edge:
            seen = edge + (abs(rest) - self.half) * (pi - edge) / (pi - self.half)
        return theta - rest + copysign(seen, rest)


class Stage(Pane):
    EVERY = 1

    def __init__(self) -> None:
        super().__init__()
        self._drag: list[tuple[float, float]] = []  # s of the event, rad
        self._down: Offset | None = None  # where the button went down
        self._drawn: tuple[Sequence[Bob], Look] = (), Look()

    def picture(self, source: Source, sample: Sample) -> Picture:
        held = self.shown.held is not None
        scene = source.scene
        model = scene.equations
        swing = reach(scene, source.stepping, sample, self.places)
        lens = self._lens(swing.frame)
        widest = swing.widest
        if source.ghost is not None:
            widest = min(max(widest, source.ghost.widest), pi)
        if held:
            widest = pi
        look = Look(
            widest=lens(widest),
            exact=nan if held else lens(source.exact.at(sample.t).theta),
            exact_length=model.exact_length(scene.theta, scene.omega, sample.t),
            amplitude=lens(amplitude(model, scene.theta, scene.omega)),
            rigid=model.rigid,
            joins=abs(source.stepping.h) * model.fastest <= 1,
        )
        self._drawn = self._bobs(source, sample, lens), look
        self._write_titles(lens, held)
        return stage_picture(*self.room, *self._drawn)

    def _lens(self, frame: float) -> Lens:
        """Return the scale that enlarges small swings to fill the stage."""
        half = self.shown.theta or frame
        columns, rows = self.room
        narrow, wide = MAGNIFIED
        widest = min(max(asin(min(columns / (4 * rows), 1.0)), narrow), wide)
        times = int(widest / half)
        if times < 2 or self.shown.overview or self.shown.held is not None:
            return Lens()
        return Lens(half, times)

    def _bobs(self, source: Source, sample: Sample, lens: Lens) -> list[Bob]:
        scene = source.scene
        model = scene.equations
        held = self.shown.held is not None
        ghosts = {}
        if source.ghost is not None:
            ghosts = source.ghost.rods(sample.t)
        trails = source.history.thetas(TRAIL - 1)
        bobs = []
        for place in self.places:
            method = scene.cast[place]
            reading = sample.readings[place]
            bob = Bob(lens(reading.theta), inks(scene.cast)[place], method.letter)
            if not held:
                trail = []
                if model.rigid:
                    trail = [*trails[place], reading.theta]
                bob = bob._replace(
                    ahead=copysign(1.0, reading.omega),
                    trail=[lens(theta) for theta in trail],
                    length=model.length(reading.extra),
                    diverged=reading.diverged_at is not None,
                    ghost=lens(ghosts.get(method.key, nan)),
                )
            bobs.append(bob)
        return bobs

    def _write_titles(self, lens: Lens, held: bool) -> None:
        room = self.room.width - 4
        titles: Sequence[str] = TITLES
        if not self.source.scene.equations.rigid:
            titles = SPRINGS
        if len(self.places) == 1:
            titles = [self.cast[self.places[0]].label]
        if lens.times > 1:
            note = f", small angles ×{lens.times}"
            titles = [*(f"{title}{note}" for title in titles), note.removeprefix(", ")]
        below = "drag: throw it"
        if held:
            below = "let go or throw"
        elif room >= 32:
            below += " · dotted: exact"
        self.write_titles(next((each for each in titles if len(each) <= room), titles[-1]), below)

    # The mouse

    def on_mouse_down(self, event: events.MouseDown) -> None:
        if event.button == 1:
            self.capture_mouse()
            self._down = event.screen_offset

    async def on_mouse_move(self, event: events.MouseMove) -> None:
        """Hold the bobs at the pointer once this is clearly a drag, not a click."""
        if self._down is None:
            return
        across, down = event.screen_offset - self._down
        if not self._drag and max(abs(across), 2 * abs(down)) < 3:
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
        drag = self._drag
        self.release_mouse()
        self.on_mouse_release()
        if drag:
            self._throw(drag, event.time)
        elif (place := self._place_at(event)) is not None:
            await self.run_action(f"screen.show_alone({place})")

    def on_mouse_release(self) -> None:
        """Let go, also when a dialog or another view has taken the mouse away."""
        if self.app.mouse_captured is not self:
            self._down = None
            self._drag = []
            self.post_message(Held(None))

    def _throw(self, drag: Sequence[tuple[float, float]], now: float) -> None:
        """Start a run from the last angle, at the pointer's speed over the last 0.1 s."""
        recent = [each for each in drag if now - each[0] < 0.1]
        if len(recent) == 1:
            recent = [*drag[-2:]]  # a slow pointer passes a cell at a time
        last_time, last_theta = drag[-1]
        first_time, first_theta = (*recent, drag[-1])[0]
        seconds = (last_time - first_time) * abs(self.source.playhead.speed)
        omega = 0.0
        if seconds > 0:
            omega = remainder(last_theta - first_theta, tau) / seconds
        # moves that came late come at once, as if the pointer had been fast
        fastest = HARDEST * self.source.scene.w0
        omega = round(min(max(omega, -fastest), fastest), 2)
        self.start_at(last_theta, omega)

    def _place_at(self, event: events.MouseUp) -> int | None:
        """Return the place in the cast whose lane, or bob on a spring, was clicked."""
        bobs, look = self._drawn
        found = lanes(*self.room, len(bobs), look.widest, look.rigid)
        column, row = event.get_content_offset_capture(self)
        x = 2 * column + 1.0
        y = 4 * row + 2.0
        far = [hypot(x - right, y - down) for right, down in map(found.place, bobs, found.radii)]
        if look.rigid:
            out = hypot(x - found.x, y - found.y)
            far = [abs(out - radius) for radius in found.radii]
        reach = 2 * found.bob + 2
        near = [each for each in zip(far, self.places, strict=True) if each[0] <= reach]
        return min(near)[1] if near else None
