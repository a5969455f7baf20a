"""Points in phase space, with trails and rings -> a picture on the theoretical portrait."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.methods import METHODS
from engine.phase_space.area import Neighbourhood
from engine.run.lockstep import Sample
from tui.drawing.canvas import Canvas, Picture
from tui.drawing.palette import EXACT, FAINT, FRAME, TEXT, faint
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.views.phase.portrait import Portrait
from tui.views.phase.viewport import Viewport

TRAIL = 300  # samples, ten seconds at 30 frames a second
_MOVING = (EXACT, *range(FAINT))
_BESIDE = ((2, 0), (-2, 0), (0, -1), (0, 1), (2, -1), (-2, 1))  # columns, rows from a point to its letter
Track = tuple[ArrayLike, ArrayLike]  # theta [rad], omega [rad/s]


@dataclass(frozen=True, slots=True)
class PhasePoint:
    """Where a method is, where it was, and its ring of neighbouring starts."""

    theta: float  # rad
    omega: float  # rad/s
    owner: int
    letter: str
    trail: Track = ((), ())
    ring: Track | None = None


def method_points(source: Source, sample: Sample, shown: Shown, ring: Neighbourhood | None) -> list[PhasePoint]:
    """The points that are to be shown of a sample, the exact one first."""
    length = TRAIL if shown.trails else 0
    points = [PhasePoint(*source.exact.at(sample.t), EXACT, "x")] if shown.exact else []
    for index in shown.indices:
        reading, trail = sample.readings[index], source.history.trail(index, length)
        around = None if ring is None else ring.rings[index]
        points.append(PhasePoint(reading.theta, reading.omega, index, METHODS[index].letter, trail, around))
    return points


@np.errstate(over="ignore", invalid="ignore")  # a method may be farther out than dots can be counted
def phase_picture(
    portrait: Portrait,
    points: Sequence[PhasePoint],
    crosshair: tuple[float, float] | None = None,
    orbit: tuple[float, float] | None = None,
) -> Picture:
    """The portrait with points on it, later ones in front; perhaps a crosshair, perhaps the exact orbit of a state.

    Dots of several owners in one cell all stay.
    """
    viewport = portrait.viewport
    canvas = Canvas(viewport.columns, viewport.rows)
    canvas.points(*portrait.curves, FRAME)
    canvas.points(*portrait.separatrix, TEXT)
    if crosshair is not None:
        x, y = viewport.x(crosshair[0]), viewport.y(crosshair[1])
        canvas.line([0, canvas.width], [y, y], TEXT, dotted=True)
        canvas.line([x, x], [0, canvas.height], TEXT, dotted=True)
    if orbit is not None:
        canvas.points(*portrait.orbit(*orbit), EXACT)
    for point in points:
        canvas.points(viewport.x(point.trail[0]), viewport.y(point.trail[1]), faint(point.owner))
    for point in points:
        if point.ring is not None:
            canvas.line(*_closed(viewport, point.ring), point.owner)
    for point in points:
        x, y = float(viewport.x(point.theta)), float(viewport.y(point.omega))
        canvas.disc(x, y, 1.6, point.owner, hollow=point.owner == EXACT)
        _letter(canvas, x, y, point)
    return _with_words(canvas.picture(), portrait)


def _closed(viewport: Viewport, ring: Track) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A ring as a line in dots that comes back to its beginning, broken where it leaves one edge for the other."""
    x = viewport.x(np.append(ring[0], np.atleast_1d(ring[0])[0]))
    y = viewport.y(np.append(ring[1], np.atleast_1d(ring[1])[0]))
    if not viewport.wrap:
        return x, y
    across = np.flatnonzero(np.abs(np.diff(x)) > np.pi / viewport.theta_per_dot) + 1
    return np.insert(x, across, np.nan), np.insert(y, across, np.nan)


def _letter(canvas: Canvas, x: float, y: float, point: PhasePoint) -> None:
    """Write the point's letter into the first free cell around it, or at the edge nearest to it."""
    if not (np.isfinite(x) and np.isfinite(y)):
        return
    inside = 0 <= x < canvas.width and 0 <= y < canvas.height
    column = int(min(max(x, 0), canvas.width - 1)) // 2
    row = int(min(max(y, 0), canvas.height - 1)) // 4
    for right, down in _BESIDE if inside else ((0, 0), *_BESIDE):
        if canvas.is_free(column + right, row + down):
            canvas.label(column + right, row + down, point.letter, point.owner)
            return


def _with_words(picture: Picture, portrait: Portrait) -> Picture:
    """The picture with the portrait's words, except those that would cover part of a point, a ring or an orbit."""
    for column, row, text, owner in portrait.words:
        cells = row, slice(column, column + len(text))
        if np.isin(picture.owners[cells], _MOVING).any():
            continue
        picture.characters[cells], picture.owners[cells] = [ord(character) for character in text], owner
    return picture
