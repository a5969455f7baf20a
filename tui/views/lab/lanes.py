"""One pendulum with a lane for each method, in braille, whose dots are square.

All bobs swing about one pivot, each on a circle of its own.  Equal angles lie on one ray, so a
method that lags is seen off the ray of the others.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import chain, islice, pairwise
from math import ceil, cos, hypot, isfinite, nan, pi, sin, tau
from typing import NamedTuple, TypeVar

from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import EXACT, FRAME, faint
from pendu_tui.tui.drawing.picture import Picture

Dot = tuple[float, float]
"""A place on the canvas, in dots to the right and down."""

Each = TypeVar("Each")

TRAIL = 15  # samples: half a second
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


@lru_cache(maxsize=8)
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
    return canvas.settled()


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
    ends = map(places.place, bobs, places.radii)
    _write(canvas, places.bob, [*zip(bobs, ends, strict=True)])
    canvas.disc(*pivot, places.bob / 2, FRAME)
    return canvas.picture()


def _draw(canvas: Canvas, places: Lanes, radius: float, bob: Bob, look: Look) -> None:
    recent = TRAIL // 3
    ring = _ring(canvas.columns, canvas.rows, places, radius)
    inside = _ring(canvas.columns, canvas.rows, places, radius - 1)
    for begin, end in _stretches(bob.trail[: 1 - recent], look.joins):
        canvas.dots(arc(ring, begin, end), faint(bob.ink))
    for begin, end in _stretches(bob.trail[-recent:], look.joins):
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


def _write(canvas: Canvas, size: float, bobs: Sequence[tuple[Bob, Dot]]) -> None:
    """Write the letters of bobs of this size, each in a cell of its own.

    The best cell touches no other letter and lies on no other bob.
    """

    def is_clear(cell: tuple[int, int], own: Bob) -> bool:
        column, row = cell
        beside = [at for at in (column - 1, column + 1) if 0 <= at < canvas.columns]
        if not all(canvas.is_free(at, row) for at in beside):
            return False
        others = (at for bob, at in bobs if bob is not own)
        return all(hypot(2 * column + 1 - x, 4 * row + 2 - y) > size + 1 for x, y in others)

    for bob, (right, down) in bobs:
        x = min(max(right, 0.0), canvas.width - 1.0)
        y = min(max(down, 0.0), canvas.height - 1.0)
        free = (cell for cell in _wanted(bob, x, y, size) if canvas.is_free(*cell))
        clear = (cell for cell in free if is_clear(cell, bob))
        any_free = (cell for cell in _wanted(bob, x, y, size) if canvas.is_free(*cell))
        for cell in islice(chain(clear, any_free), 1):
            canvas.label(*cell, bob.letter, bob.ink)


def _wanted(bob: Bob, x: float, y: float, size: float) -> Iterator[tuple[int, int]]:
    """Yield cells for a letter: in a large bob, else ahead of it, behind, and all around."""
    column = int(x) // 2
    row = int(y) // 4
    if size >= LETTERED:
        yield column, row
    for far in (size + 2, -size - 2):
        ahead = far * bob.ahead
        yield int(x + ahead * cos(bob.theta)) // 2, int(y - ahead * sin(bob.theta)) // 4
    yield from ((column + across, row + down) for across, down in _AROUND)
