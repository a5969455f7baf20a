"""Points in phase space, with trails and rings -> a picture on the theoretical portrait."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.models.model import State
from engine.phase_space.area import Neighbourhood
from engine.run.lockstep import Sample
from tui.drawing.canvas import Canvas
from tui.drawing.palette import EXACT, TEXT, faint, inks
from tui.drawing.picture import Picture
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.phase.portrait import Portrait
from tui.views.phase.viewport import Viewport

TRAIL = 300  # samples, ten seconds at 30 frames a second
_BESIDE = ((2, 0), (-2, 0), (0, -1), (0, 1), (2, -1), (-2, 1))  # columns, rows from a point to its letter
Floats = NDArray[np.float64]
Track = tuple[Floats, Floats]  # theta [rad], omega [rad/s]


class PhasePoint(NamedTuple):
    """Where a method is, and its ring of neighbouring starts."""

    theta: float  # rad
    omega: float  # rad/s
    ink: int
    letter: str
    ring: Track | None = None


def source_picture(
    viewport: Viewport,
    source: Source,
    sample: Sample,
    shown: Shown,
    ring: Neighbourhood | None,
    *aims: State | None,
) -> Picture:
    """What is to be shown of a sample, with the crosshair and the state whose orbit is shown, if any."""
    portrait = Portrait.of(viewport, source.scene.w0, source.scene.model)
    around = None if source.scene.why_no_ring else ring
    trails = trails_of(source, shown) if shown.trails else []
    return phase_picture(portrait, method_points(source, sample, shown, around), trails, *aims)


def trails_of(source: Source, shown: Shown) -> list[tuple[int, Track]]:
    """Return where each method has been lately, and its ink."""
    states = source.history.levels.trails(TRAIL)
    return [
        (faint(inks(source.scene.cast)[place]), (states[:, place, 0], states[:, place, 1]))
        for place in shown.places(source.scene.cast)
    ]


def method_points(source: Source, sample: Sample, shown: Shown, ring: Neighbourhood | None) -> list[PhasePoint]:
    """The points that are to be shown of a sample, the exact one first."""
    exact = source.exact.at(sample.t)
    points = [PhasePoint(*exact, EXACT, "x")] if shown.exact and math.isfinite(exact.theta) else []
    for index in shown.places(source.scene.cast):
        method = source.scene.cast[index]
        reading = sample.readings[index]
        around = None if ring is None else ring.rings[index]
        ink = inks(source.scene.cast)[index]
        points.append(PhasePoint(reading.theta, reading.omega, ink, method.letter, around))
    return points


@np.errstate(over="ignore", invalid="ignore")  # a method may be farther out than dots can be counted
def phase_picture(
    portrait: Portrait,
    points: Sequence[PhasePoint],
    trails: Sequence[tuple[int, Track]] = (),
    crosshair: tuple[float, float] | None = None,
    orbit: tuple[float, float] | None = None,
) -> Picture:
    """Draw trails and points on the portrait, later ones in front; perhaps a crosshair, perhaps a state's exact orbit.

    Dots of several inks in one cell all stay.
    """
    viewport = portrait.viewport
    canvas = portrait.ground.copy()
    for ink, (theta, omega) in trails:
        canvas.scatter(viewport.x(theta), viewport.y(omega), ink)
    if crosshair is not None:
        draw_crosshair(canvas, float(viewport.x(crosshair[0])), float(viewport.y(crosshair[1])))
    if orbit is not None:
        canvas.scatter(*portrait.orbit(*orbit), EXACT)
    for point in points:
        if point.ring is not None:
            theta, omega = point.ring
            canvas.path(on_screen(viewport, np.append(theta, theta[0]), np.append(omega, omega[0])), point.ink)
    for point in points:
        x, y = float(viewport.x(point.theta)), float(viewport.y(point.omega))
        canvas.disc(x, y, 1.6, point.ink, hollow=point.ink == EXACT)
        letter(canvas, x, y, point)
    portrait.write_words(canvas)
    return canvas.picture()


def draw_crosshair(canvas: Canvas, x: float, y: float) -> None:
    """Draw dotted lines through a point, from edge to edge."""
    canvas.line(0, y, canvas.width, y, TEXT, dotted=True)
    canvas.line(x, 0, x, canvas.height, TEXT, dotted=True)


def on_screen(viewport: Viewport, theta: Floats, omega: Floats) -> list[tuple[float, float]]:
    """Return points of a line in dots, with a break where it leaves one edge for the other."""
    x, y = viewport.x(theta), viewport.y(omega)
    if viewport.wrap:
        across = np.flatnonzero(np.abs(np.diff(x)) > np.pi / viewport.theta_per_dot) + 1
        x, y = np.insert(x, across, np.nan), np.insert(y, across, np.nan)
    return list(zip(x.tolist(), y.tolist(), strict=True))


def letter(canvas: Canvas, x: float, y: float, point: PhasePoint) -> None:
    """Write the point's letter into the first free cell around it, or at the edge nearest to it."""
    if not (math.isfinite(x) and math.isfinite(y)):
        return
    inside = 0 <= x < canvas.width and 0 <= y < canvas.height
    column = int(min(max(x, 0), canvas.width - 1)) // 2
    row = int(min(max(y, 0), canvas.height - 1)) // 4
    for right, down in _BESIDE if inside else ((0, 0), *_BESIDE):
        if canvas.is_free(column + right, row + down):
            canvas.label(column + right, row + down, point.letter, point.ink)
            return
