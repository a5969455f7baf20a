"""The phase portrait: energy contours, separatrix, regimes, axes, and the methods on it."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models.model import Model, State
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import change_before
from pendu_tui.engine.scenes import Line
from pendu_tui.engine.studies.ring import Neighbourhood
from pendu_tui.engine.studies.section import OrbitKind, Points, kind_of, orbit
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.frame import Axis, Frame, in_pi, nice, number_ticks, theta_ticks
from pendu_tui.tui.drawing.picture import (
    EXACT,
    FAINT,
    FRAME,
    QUIET,
    TEXT,
    Picture,
    Row,
    faint,
    inks,
)
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.terminal.options import FPS
from pendu_tui.tui.views.viewport import LEFT, Viewport
from pendu_tui.tui.words.numbers import energy_share, motion_text, regime

Dots = tuple[NDArray[np.intp], NDArray[np.intp]]  # x, y
Mask = NDArray[np.bool_]  # (dots down, dots right)
Word = tuple[int, int, str]  # column, row, text
Floats = NDArray[np.float64]
SPARSE = 60  # shorter trails are drawn thick, or they would be lost among the curves
BLOCK = (0, 0), (1, 0), (0, 1), (1, 1)  # dots to the right and down
CHORDS = 24  # points of a trail that are joined
DISC = 2.2  # dots: discs on each other have a cell for each of four methods
# where to write a letter, in columns and rows from its point
BESIDE: Sequence[tuple[int, int]] = (2, 0), (-2, 0), (0, -1), (0, 1), (2, -1), (-2, 1)


class Portrait:
    """The static part of the picture, for one viewport."""

    def __init__(self, viewport: Viewport, model: Model) -> None:
        self.viewport = viewport
        self.model = model
        theta = viewport.theta_at(np.arange(2 * viewport.columns) + 0.5)
        omega = viewport.omega_at(np.arange(4 * viewport.rows) + 0.5)[:, None]
        # (dots down, dots right), at the dots' centres
        self.levels: Floats = model.level(theta, omega, np.cos)
        self.separatrix = _dots(_border((self.levels < 0) & model.has_separatrix))
        self.words = _names(viewport, model.w0) if model.has_separatrix else []
        self.ground = Canvas(viewport.columns, viewport.rows)
        self.ground.scatter(*_dots(_border(_bands(self.levels))), FRAME)
        self.ground.scatter(*self.separatrix, QUIET)

    def orbit(self, theta: float, omega: float) -> Dots:
        """Return the exact orbit through a state, where orbits are curves of equal energy."""
        if self.model.caption:
            return _dots(np.zeros((0, 0), np.bool_))
        level = self.model.level(theta, omega)
        curve = _border(self.levels < level)
        # two orbits have this energy, one for each direction of rotation
        if self.model.has_separatrix and level < 0:
            rows = self.viewport.omega_at(np.arange(len(curve)) + 0.5)
            curve &= (rows * omega > 0)[:, None]
        return _dots(curve)


portrait_of = lru_cache(maxsize=2)(Portrait)
"""One is kept for the lab's pane, and one for F3."""


class PhasePoint(NamedTuple):
    theta: float  # rad
    omega: float  # rad/s
    ink: int
    letter: str
    trail: Points = (np.zeros(0), np.zeros(0))
    joined: bool = False  # the last points of the trail
    ring: Points | None = None


# a diverging method may be too far out to count in dots
@np.errstate(over="ignore", invalid="ignore")
def phase_picture(
    portrait: Portrait,
    points: Sequence[PhasePoint],
    crosshair: State | None = None,
    orbit: State | None = None,
    line: Line | None = None,
) -> Picture:
    """Draw trails, rings and points, and a crosshair, an orbit or a line if given."""
    viewport = portrait.viewport
    canvas = portrait.ground.copy()
    if line is not None and line.quantity == "omega":
        for omega, name in ((line.value, line.name), (-line.value, f"-{line.name}")):
            y = float(viewport.y(omega))
            canvas.line(0, y, canvas.width, y, EXACT, dotted=True)
            canvas.label(0, int(y) // 4, f" {name} ", EXACT)
    if crosshair is not None:
        draw_crosshair(canvas, viewport, crosshair)
    if orbit is not None:
        canvas.scatter(*portrait.orbit(*orbit), EXACT)
    for point in points:
        thick = BLOCK if len(point.trail[0]) <= SPARSE else BLOCK[:1]
        draw_dots(canvas, viewport, point.trail, thick, faint(point.ink))
        if point.joined:
            last = [each[-CHORDS:] for each in point.trail]
            canvas.path(*on_screen(viewport, *last), faint(point.ink))
        if point.ring is not None:
            closed = [np.append(each, each[0]) for each in point.ring]
            canvas.path(*on_screen(viewport, *closed), point.ink)
    draw_points(canvas, viewport, points)
    _write_words(canvas, portrait.words)
    return canvas.picture()


def draw_dots(
    canvas: Canvas, viewport: Viewport, points: Points, dots: Sequence[tuple[int, int]], ink: int
) -> None:
    x = viewport.x(points[0])
    y = viewport.y(points[1])
    for right, down in dots:
        canvas.scatter(x + right, y + down, ink)


def draw_crosshair(canvas: Canvas, viewport: Viewport, state: State) -> None:
    x = float(viewport.x(state.theta))
    y = float(viewport.y(state.omega))
    canvas.line(0, y, canvas.width, y, TEXT, dotted=True)
    canvas.line(x, 0, x, canvas.height, TEXT, dotted=True)


def on_screen(viewport: Viewport, theta: Floats, omega: Floats) -> Points:
    """Return a line in dots, broken where it wraps around the edge."""
    x = viewport.x(theta)
    y = viewport.y(omega)
    if viewport.wrap:
        across = np.flatnonzero(np.abs(np.diff(x)) > np.pi / viewport.theta_per_dot) + 1
        x = np.insert(x, across, np.nan)
        y = np.insert(y, across, np.nan)
    return x, y


def draw_points(canvas: Canvas, viewport: Viewport, points: Sequence[PhasePoint]) -> None:
    """Draw discs, and their letters beside all discs where there is room.

    Those outside are at the nearest edge.
    """
    places = [(point, viewport.x(point.theta), viewport.y(point.omega)) for point in points]
    for point, right, down in places:
        canvas.disc(right, down, DISC, point.ink, hollow=point.ink == EXACT)
    for point, x, y in places:
        if math.isfinite(x + y):
            column = int(min(max(x, 0), canvas.width - 1)) // 2
            row = int(min(max(y, 0), canvas.height - 1)) // 4
            near = [(column + right, row + down) for right, down in BESIDE]
            if not (0 <= x < canvas.width and 0 <= y < canvas.height):
                near.insert(0, (column, row))
            canvas.label_near(near, point.letter, point.ink)


def method_points(
    source: Source, sample: Sample, shown: Shown, ring: Neighbourhood | None
) -> list[PhasePoint]:
    """Return the points to draw, the exact one first.

    Steps that are neither close nor far apart are joined: a spiral is seen at once.
    """
    points = []
    exact = source.exact.at(sample.t)
    if shown.exact:
        points.append(PhasePoint(*exact, EXACT, "x"))
    trails = source.history.trails()
    cast = source.scene.cast
    own = source.stepping.own
    colours = inks(cast)
    for place in shown.places(cast):
        reading = sample.readings[place]
        h = abs(own[place])
        is_each_step_seen = h * FPS >= abs(source.playhead.speed)
        points.append(
            PhasePoint(
                reading.theta,
                reading.omega,
                colours[place],
                cast[place].letter,
                trail=(trails[:, place, 0], trails[:, place, 1]),
                joined=is_each_step_seen and 0.3 <= h * source.scene.w0 <= 1,
                ring=ring.rings[place] if ring else None,
            )
        )
    return points


def ring_text(source: Source, ring: Neighbourhood | None) -> str:
    """Return what there is to say about the ring, or why there is none."""
    if ring is None:
        return source.scene.why_no_ring
    change = change_before(source.changes, ring.step)
    t = change.t + (ring.step - change.step) * change.stepping.h
    left = source.scene.equations.area_share(t)
    text = f"ring, radius {ring.radius:g} rad"
    if left != 1:
        text += f": the exact motion shrinks its area to {left:.9f}"
    if behind := source.sample.step - ring.step:
        text += f", {behind} steps behind"
    return text


def caption(source: Source, aim: State | None, width: int) -> Row:
    """Return the line below the portrait: the state at the cursor, and the motion."""
    model = source.scene.equations
    motion = model.caption or motion_text(source.scene, source.exact)
    if aim is None:
        return ((motion, QUIET),)
    room = width - len(motion) - 2
    if room < 60:
        return ((place_text(model, aim, width), TEXT),)
    return (place_text(model, aim, room).ljust(room + 2), TEXT), (motion, QUIET)


def place_text(model: Model, state: State, width: int) -> str:
    """Return a state in words, with E/Es and regime where the model has a separatrix."""
    theta, omega = state
    half_turns = round(theta / math.pi)
    angle = f"{theta:.15g}"
    if theta == half_turns * math.pi:
        angle = in_pi(half_turns)
    text = f"theta {angle}  omega {omega:.15g}"
    if model.has_separatrix:
        text += f"  E/Es {energy_share(model, theta, omega)}  {regime(model, theta, omega)}"
    return text[:width]


def _write_words(canvas: Canvas, words: Sequence[Word]) -> None:
    """Write words where they cover no point, letter, ring or orbit; trails show between them."""
    for column, row, text in words:
        where = column, row, len(text)
        is_free = canvas.is_free(*where)
        if not is_free or any(EXACT <= each < FAINT for each in canvas.inks_at(*where)):
            continue
        for at, character in enumerate(text, column):
            if character != " " or all(each < EXACT for each in canvas.inks_at(at, row)):
                canvas.label(at, row, character, QUIET)


def framed(viewport: Viewport, field: Picture) -> list[Row]:
    """Put axes around a picture of phase space."""
    columns, rows = viewport[:2]
    x_axis = Axis(*viewport.across, theta_ticks(*viewport.across, min(columns // 9 + 1, 8)))
    labels = number_ticks(*viewport.up, max(rows // 2, 1))
    y_axis = Axis(
        *viewport.up, {at: text.rjust(LEFT - 1) for at, text in labels.items() if len(text) < LEFT}
    )
    return Frame(x_axis, y_axis, columns, rows).around(field.rows)


def _names(viewport: Viewport, w0: float) -> list[Word]:
    """Return the names of the regimes in their middle, and of the separatrix beside it."""
    crest = 2 * w0  # rad/s
    spin = (crest + max(viewport.omega_at(0.0), crest)) / 2
    slope = math.pi / 2  # rad
    places = (
        (" libration ", 0.0, 0.0),
        (" rotation ", 0.0, spin),
        (" rotation ", 0.0, -spin),
        (" separatrix ", slope, crest * math.cos(slope / 2)),
    )
    words: list[Word] = []
    for text, theta, omega in places:
        column = int(viewport.x(theta)) // 2 + 1
        row = int(viewport.y(omega)) // 4
        if theta == 0:
            column -= len(text) // 2 + 1
        room = viewport.columns - column
        if len(text.rstrip()) <= room:
            words.append((column, row, text[:room]))
    return words


def _bands(levels: Floats) -> NDArray[np.int64]:
    """Return each dot's energy band: even steps of amplitude, above the separatrix of omega."""
    inside = np.arcsin(np.sqrt(np.clip(levels, 0, 1)))
    spacing = np.where(levels > 0, inside, -np.sqrt(np.maximum(-levels, 0)))
    step = nice(float(np.ptp(spacing)) / 8)  # about eight curves
    return np.floor(spacing / step).astype(np.int64)


def _border(values: NDArray[Any]) -> Mask:
    """Return dots that differ from the one to the right or below."""
    border = np.zeros(values.shape, np.bool_)
    border[:, :-1] |= values[:, 1:] != values[:, :-1]
    border[:-1] |= values[1:] != values[:-1]
    return border


def _dots(mask: Mask) -> Dots:
    y, x = np.nonzero(mask)
    return x, y


ORBIT_STEPS = 2000  # they take a few ms
GAP = 2  # dots between orbits of a section


class Section:
    """Orbits of one method, over the separatrix of the true pendulum."""

    def __init__(self, viewport: Viewport, model: Model, method: Method, ink: int) -> None:
        self._viewport = viewport
        self._method = method
        self._ink = ink
        self._ground = Canvas(viewport.columns, viewport.rows)
        self._ground.scatter(*portrait_of(viewport, model).separatrix, FRAME)
        size = self._ground.height + 2 * GAP, self._ground.width + 2 * GAP
        self._near = np.zeros(size, np.bool_)
        self.orbits = 0  # so far

    @np.errstate(all="ignore")  # a diverging method may be too far out to count in dots
    def add(self, points: Points) -> None:
        self.orbits += points[0].shape[1]
        x = np.floor(self._viewport.x(points[0]))
        y = np.floor(self._viewport.y(points[1]))
        inside = (x >= 0) & (x < self._ground.width) & (y >= 0) & (y < self._ground.height)
        most = 0.3  # the share of its dots that may lie close to other orbits
        if self._method.symplectic:
            most = 0.6
        for each in range(x.shape[1]):
            at = inside[:, each]
            i, j = np.unique(np.stack([x[at, each], y[at, each]]).astype(np.intp), axis=1)
            if self._near[j + GAP, i + GAP].sum() <= most * len(i):
                self._ground.scatter(i, j, faint(self._ink))
                for right in range(2 * GAP + 1):
                    for down in range(2 * GAP + 1):
                        self._near[j + down, i + right] = True

    @np.errstate(all="ignore")
    def picture(self, orbit: Points, start: State, crosshair: State | None = None) -> Picture:
        """Draw one orbit over the others, in thick dots or as a spiral, and its start."""
        canvas = self._ground.copy()
        viewport = self._viewport
        if self._method.symplectic:
            draw_dots(canvas, viewport, orbit, BLOCK[:3], self._ink)
        else:  # a spiral of 300 steps
            canvas.path(*on_screen(viewport, orbit[0][:300], orbit[1][:300]), self._ink)
        if crosshair is not None:
            draw_crosshair(canvas, viewport, crosshair)
        draw_points(canvas, viewport, [PhasePoint(*start, self._ink, self._method.letter)])
        return canvas.picture()


@lru_cache(maxsize=64)
def orbit_of(method: Method, model: Model, h: float, start: State) -> tuple[Points, OrbitKind]:
    points = orbit(method, model, h, start, ORBIT_STEPS)
    return points, kind_of(method, model, h, points)
