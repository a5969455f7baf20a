"""Points in phase space, with trails and rings, on the theoretical portrait."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.models.model import State
from engine.phase_space.area import Neighbourhood
from engine.run.lockstep import Sample
from engine.scenes import Line
from tui.drawing.canvas import Canvas
from tui.drawing.palette import EXACT, TEXT, faint, inks
from tui.drawing.picture import Picture
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.phase.portrait import Portrait, write_words
from tui.views.phase.viewport import Viewport

TRAIL = 300  # samples, ten seconds at 30 frames a second
SPARSE = 60  # samples
# columns, rows from a point to its letter
BESIDE = (2, 0), (-2, 0), (0, -1), (0, 1), (2, -1), (-2, 1)
Floats = NDArray[np.float64]
Track = tuple[Floats, Floats]  # theta [rad], omega [rad/s]


class PhasePoint(NamedTuple):
    """Where a method is, with its trail and its ring of neighbouring starts."""

    theta: float  # rad
    omega: float  # rad/s
    ink: int
    letter: str
    trail: Track | None = None
    ring: Track | None = None


def method_points(
    source: Source, sample: Sample, shown: Shown, ring: Neighbourhood | None
) -> list[PhasePoint]:
    """Return the points that are shown of a sample, the exact one first."""
    exact = source.exact.at(sample.t)
    points = [PhasePoint(*exact, EXACT, "x")] if shown.exact and math.isfinite(exact.theta) else []
    trails = source.history.trails(TRAIL)
    cast = source.scene.cast
    for place in shown.places(cast):
        reading = sample.readings[place]
        trail = trails[:, place, 0], trails[:, place, 1]
        around = None if ring is None else ring.rings[place]
        points.append(
            PhasePoint(
                reading.theta, reading.omega, inks(cast)[place], cast[place].letter, trail, around
            )
        )
    return points


# a method may be farther out than dots can be counted
@np.errstate(over="ignore", invalid="ignore")
def phase_picture(
    portrait: Portrait,
    points: Sequence[PhasePoint],
    crosshair: State | None = None,
    orbit: State | None = None,
    line: Line | None = None,
) -> Picture:
    """Draw trails, rings and points, later ones in front; perhaps a crosshair, an orbit, a line."""
    viewport = portrait.viewport
    canvas = portrait.ground.copy()
    for point in points:
        if point.trail is not None:
            theta, omega = point.trail
            x = viewport.x(theta)
            y = viewport.y(omega)
            canvas.scatter(x, y, faint(point.ink))
            if len(x) <= SPARSE:  # and single dots would be lost among the curves
                for down, right in ((0, 1), (1, 0), (1, 1)):
                    canvas.scatter(x + right, y + down, faint(point.ink))
    if line is not None and line.quantity == "omega":
        draw_fence(canvas, viewport, line)
    if crosshair is not None:
        draw_crosshair(canvas, viewport, crosshair)
    if orbit is not None:
        canvas.scatter(*portrait.orbit(*orbit), EXACT)
    for point in points:
        if point.ring is not None:
            theta, omega = point.ring
            canvas.path(
                on_screen(viewport, np.append(theta, theta[0]), np.append(omega, omega[0])),
                point.ink,
            )
    for point in points:
        draw_point(canvas, viewport, point)
    write_words(canvas, portrait.words)
    return canvas.picture()


def draw_fence(canvas: Canvas, viewport: Viewport, line: Line) -> None:
    """Draw dotted lines at an omega to both sides of zero, with their name."""
    for omega, name in ((line.value, line.name), (-line.value, f"-{line.name}")):
        y = float(viewport.y(omega))
        canvas.line(0, y, canvas.width, y, EXACT, dotted=True)
        canvas.label(1, int(y) // 4, name, EXACT)


def draw_crosshair(canvas: Canvas, viewport: Viewport, state: State) -> None:
    """Draw dotted lines through a state, from edge to edge."""
    x = float(viewport.x(state.theta))
    y = float(viewport.y(state.omega))
    canvas.line(0, y, canvas.width, y, TEXT, dotted=True)
    canvas.line(x, 0, x, canvas.height, TEXT, dotted=True)


def on_screen(viewport: Viewport, theta: Floats, omega: Floats) -> list[tuple[float, float]]:
    """Return points of a line in dots, with a break where it leaves one edge for the other."""
    x = viewport.x(theta)
    y = viewport.y(omega)
    if viewport.wrap:
        across = np.flatnonzero(np.abs(np.diff(x)) > np.pi / viewport.theta_per_dot) + 1
        x = np.insert(x, across, np.nan)
        y = np.insert(y, across, np.nan)
    return list(zip(x.tolist(), y.tolist(), strict=True))


def draw_point(canvas: Canvas, viewport: Viewport, point: PhasePoint) -> None:
    """Draw a disc, and its letter in the first free cell around it or at the edge nearest to it."""
    x = float(viewport.x(point.theta))
    y = float(viewport.y(point.omega))
    canvas.disc(x, y, 1.6, point.ink, hollow=point.ink == EXACT)
    if not (math.isfinite(x) and math.isfinite(y)):
        return
    inside = 0 <= x < canvas.width and 0 <= y < canvas.height
    column = int(min(max(x, 0), canvas.width - 1)) // 2
    row = int(min(max(y, 0), canvas.height - 1)) // 4
    for right, down in BESIDE if inside else ((0, 0), *BESIDE):
        if canvas.is_free(column + right, row + down):
            canvas.label(column + right, row + down, point.letter, point.ink)
            return
