"""Pictures of phase space: the methods on the portrait, sections, and text about both."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models.model import Model, State
from pendu_tui.engine.phase_space.area import Neighbourhood, Neighbours
from pendu_tui.engine.phase_space.section import Points, spread
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import change_before
from pendu_tui.engine.scenes import Line
from pendu_tui.tui.drawing.axes import in_pi
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import EXACT, FRAME, QUIET, TEXT, faint, inks, mark
from pendu_tui.tui.drawing.picture import Picture, Row
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.phase.portrait import Portrait, axes, write_words
from pendu_tui.tui.views.phase.viewport import Viewport
from pendu_tui.tui.words.numbers import energy_share, motion_text, regime, scientific

SPARSE = 60  # shorter trails are drawn thick, or they would be lost among the curves
BLOCK = (0, 0), (1, 0), (0, 1), (1, 1)  # dots to the right and down
GAP = 2  # dots between orbits of a section
NAME, CELL = 22, 14  # characters across in the table
# where to write a letter, in columns and rows from its point
BESIDE: Sequence[tuple[int, int]] = (2, 0), (-2, 0), (0, -1), (0, 1), (2, -1), (-2, 1)
Floats = NDArray[np.float64]


class PhasePoint(NamedTuple):
    theta: float  # rad
    omega: float  # rad/s
    ink: int
    letter: str
    trail: Points | None = None
    ring: Points | None = None


def method_points(
    source: Source, sample: Sample, shown: Shown, ring: Neighbourhood | None
) -> list[PhasePoint]:
    """Return the points to draw, the exact one first."""
    points = []
    exact = source.exact.at(sample.t)
    if shown.exact and math.isfinite(exact.theta):
        points.append(PhasePoint(*exact, EXACT, "x"))
    trails = source.history.trails
    cast = source.scene.cast
    for place in shown.places(cast):
        reading = sample.readings[place]
        point = PhasePoint(
            reading.theta,
            reading.omega,
            inks(cast)[place],
            cast[place].letter,
            trail=(trails[:, place, 0], trails[:, place, 1]),
        )
        if ring:
            point = point._replace(ring=ring.rings[place])
        points.append(point)
    return points


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
    for point in points:
        if point.trail is not None:
            thick = BLOCK if len(point.trail[0]) <= SPARSE else BLOCK[:1]
            _scatter(canvas, viewport, point.trail, faint(point.ink), thick)
    if line is not None and line.quantity == "omega":
        for omega, name in ((line.value, line.name), (-line.value, f"-{line.name}")):
            y = float(viewport.y(omega))
            canvas.line(0, y, canvas.width, y, EXACT, dotted=True)
            canvas.label(1, int(y) // 4, name, EXACT)
    if crosshair is not None:
        _draw_crosshair(canvas, viewport, crosshair)
    if orbit is not None:
        canvas.scatter(*portrait.orbit(*orbit), EXACT)
    for point in points:
        if point.ring is not None:
            closed = [np.append(each, each[0]) for each in point.ring]
            canvas.path(*_on_screen(viewport, *closed), point.ink)
    if points:
        x = viewport.x(np.array([point.theta for point in points]))
        y = viewport.y(np.array([point.omega for point in points]))
        for point, right, down in zip(points, x.tolist(), y.tolist(), strict=True):
            _draw_point(canvas, right, down, point)
    write_words(canvas, portrait.words)
    return canvas.picture()


def _scatter(
    canvas: Canvas,
    viewport: Viewport,
    points: Points,
    ink: int,
    dots: Sequence[tuple[int, int]],
) -> None:
    x = viewport.x(points[0])
    y = viewport.y(points[1])
    for right, down in dots:
        canvas.scatter(x + right, y + down, ink)


def _draw_crosshair(canvas: Canvas, viewport: Viewport, state: State) -> None:
    x = float(viewport.x(state.theta))
    y = float(viewport.y(state.omega))
    canvas.line(0, y, canvas.width, y, TEXT, dotted=True)
    canvas.line(x, 0, x, canvas.height, TEXT, dotted=True)


def _on_screen(viewport: Viewport, theta: Floats, omega: Floats) -> Points:
    """Return a line in dots, broken where it wraps around the edge."""
    x = viewport.x(theta)
    y = viewport.y(omega)
    if viewport.wrap:
        across = np.flatnonzero(np.abs(np.diff(x)) > np.pi / viewport.theta_per_dot) + 1
        x = np.insert(x, across, np.nan)
        y = np.insert(y, across, np.nan)
    return x, y


def _draw_point(canvas: Canvas, x: float, y: float, point: PhasePoint) -> None:
    """Draw a disc with its letter beside it, at the nearest edge if it is outside."""
    canvas.disc(x, y, 1.6, point.ink, hollow=point.ink == EXACT)
    if not (math.isfinite(x) and math.isfinite(y)):
        return
    places = BESIDE
    if not (0 <= x < canvas.width and 0 <= y < canvas.height):
        places = (0, 0), *BESIDE
    column = int(min(max(x, 0), canvas.width - 1)) // 2
    row = int(min(max(y, 0), canvas.height - 1)) // 4
    for right, down in places:
        if canvas.is_free(column + right, row + down):
            canvas.label(column + right, row + down, point.letter, point.ink)
            return


def starts(viewport: Viewport, count: int) -> Points:
    across = viewport.theta_at(0.0), viewport.theta_at(2.0 * viewport.columns)
    return spread(count, across, (viewport.omega_at(4.0 * viewport.rows), viewport.omega_at(0.0)))


class Section:
    """Orbits of one method, over the separatrix of the true pendulum."""

    def __init__(self, viewport: Viewport, model: Model, method: Method, ink: int) -> None:
        self._viewport = viewport
        self._method = method
        self._ink = ink
        self._ground = Canvas(viewport.columns, viewport.rows)
        self._ground.scatter(*Portrait.of(viewport, model).separatrix, FRAME)
        size = self._ground.height + 2 * GAP, self._ground.width + 2 * GAP
        self._near = np.zeros(size, np.bool_)

    @np.errstate(all="ignore")  # a diverging method may be too far out to count in dots
    def add(self, points: Points) -> None:
        x = np.floor(self._viewport.x(points[0]))
        y = np.floor(self._viewport.y(points[1]))
        inside = (x >= 0) & (x < self._ground.width) & (y >= 0) & (y < self._ground.height)
        most = 0.3  # the share of its dots that may lie close to other orbits
        if self._method.symplectic:
            most = 0.6
        for each in range(x.shape[1]):
            at = inside[:, each]
            i, j = np.unique(np.stack([x[at, each], y[at, each]]).astype(np.intp), axis=1)
            if len(i) and self._near[j + GAP, i + GAP].mean() <= most:
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
            _scatter(canvas, viewport, orbit, self._ink, BLOCK[:3])
        else:  # a spiral of 300 steps
            canvas.path(*_on_screen(viewport, orbit[0][:300], orbit[1][:300]), self._ink)
        if crosshair is not None:
            _draw_crosshair(canvas, viewport, crosshair)
        x = float(viewport.x(start[0]))
        y = float(viewport.y(start[1]))
        _draw_point(canvas, x, y, PhasePoint(*start, self._ink, self._method.letter))
        write_words(canvas, axes(viewport))
        return canvas.picture()


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


def fact_rows(source: Source, shown: Shown, neighbours: Neighbours | None, width: int) -> list[Row]:
    """Return a line about the ring and a table of the methods, as wide as fits."""
    scene = source.scene
    model = scene.equations
    exact = source.exact.at(source.sample.t)
    ring = None
    if neighbours is not None and not scene.why_no_ring:
        ring = neighbours.ring_of(scene, source.sample.run)
    fit = max((width - NAME) // CELL, 0)

    def cells(*texts: str) -> str:
        return "".join(text.rjust(CELL) for text in texts[:fit])

    heads = cells("ln area ratio", "area/area0", "theta error", model.error.head.narrow)
    rows: list[Row] = [
        [(_ring_text(source, neighbours)[:width], TEXT)],
        [(" " * NAME + heads, QUIET)],
    ]
    for place in shown.places(scene.cast):
        method = scene.cast[place]
        reading = source.sample.readings[place]
        area = ("-", "-")
        if ring:
            area = area_text(ring.area_ratios[place])
        off = scientific(model.theta_error(reading.theta, exact.theta), CELL, 3)
        numbers = cells(*area, off, scientific(reading.energy_error, CELL, 3))
        name = f" {mark(place, method)} {method.label}".ljust(NAME)
        rows.append([(name, inks(scene.cast)[place]), (numbers, TEXT)])
    return rows


def _ring_text(source: Source, neighbours: Neighbours | None) -> str:
    if why := source.scene.why_no_ring:
        return f" {why}"
    if neighbours is None:
        return " Press g to draw a ring of neighbouring starts and measure its area."
    step = 0
    if neighbours.ring_of(source.scene, source.sample.run):
        step = neighbours.step
    change = change_before(source.changes, step)
    left = source.scene.equations.area_share(change.t + (step - change.step) * change.stepping.h)
    radius = f"radius {neighbours.radius:g} rad"
    if left != 1:
        return f" Ring, {radius}: the true motion leaves {left:.9f} of its area"
    text = f" Ring of neighbouring starts, {radius}"
    if behind := source.sample.step - step:
        text += f": {behind} steps behind"
    return text


def area_text(ratio: float) -> tuple[str, str]:
    """Return ln of an area ratio, and the ratio as a text that differs from 1: "1 + 2.2e-16"."""
    if not 0 < ratio < math.inf:
        return "-", "> 1e308" if ratio else "< 1e-308"
    if ratio == 1:
        text = "1"
    elif abs(ratio - 1) < 1e-6:
        text = f"1 {'+' if ratio > 1 else '-'} {abs(ratio - 1):.1e}"
    else:
        text = f"{ratio:.9f}" if 1e-3 <= ratio < 1e3 else f"{ratio:.3e}"
    return scientific(math.log(ratio), 10, 3), text
