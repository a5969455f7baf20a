"""Points in phase space, with trails and rings -> a picture on the theoretical portrait."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.models.model import State
from engine.phase_space.area import Neighbourhood
from engine.run.lockstep import Sample
from tui.drawing.canvas import Canvas, Picture
from tui.drawing.palette import EXACT, TEXT, faint, series
from tui.drawing.trails import Trails
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
    owner: int
    letter: str
    ring: Track | None = None


class PhaseTrails:
    """The trails of a source's methods on a portrait, which go on from frame to frame."""

    def __init__(self) -> None:
        self._of: object = None  # what they are trails of
        self._trails: Trails | None = None
        self._added = 0  # samples of the history that they show

    def follow(self, portrait: Portrait, source: Source, shown: Shown) -> Canvas:
        """The portrait's ground, with the trails up to the newest sample."""
        history, places, viewport = source.history, shown.places(source.scene.cast), portrait.viewport
        key, new = (portrait, history, history.rewound, places), history.added - self._added
        if self._trails is None or key != self._of or new > TRAIL:
            owners = [faint(series(source.scene.cast[place])) for place in places]
            self._of, self._trails, new = key, Trails(portrait.ground, owners, TRAIL), TRAIL
        for states in history.states(new):
            shown_states = [states[place] for place in places]
            self._trails.add([(viewport.x(theta), viewport.y(omega)) for theta, omega in shown_states])
        self._added = history.added
        return self._trails.canvas


def source_picture(
    viewport: Viewport,
    source: Source,
    sample: Sample,
    shown: Shown,
    trails: PhaseTrails,
    ring: Neighbourhood | None,
    *aims: State | None,
) -> Picture:
    """What is to be shown of a sample, with the crosshair and the state whose orbit is shown, if any."""
    portrait = Portrait.of(viewport, source.scene.w0, source.scene.model)
    around = None if source.scene.why_no_ring else ring
    ground = trails.follow(portrait, source, shown) if shown.trails else portrait.ground
    return phase_picture(portrait, ground, method_points(source, sample, shown, around), *aims)


def method_points(source: Source, sample: Sample, shown: Shown, ring: Neighbourhood | None) -> list[PhasePoint]:
    """The points that are to be shown of a sample, the exact one first."""
    exact = source.exact.at(sample.t)
    points = [PhasePoint(*exact, EXACT, "x")] if shown.exact and math.isfinite(exact.theta) else []
    for index in shown.places(source.scene.cast):
        method = source.scene.cast[index]
        reading = sample.readings[index]
        around = None if ring is None else ring.rings[index]
        points.append(PhasePoint(reading.theta, reading.omega, series(method), method.letter, around))
    return points


@np.errstate(over="ignore", invalid="ignore")  # a method may be farther out than dots can be counted
def phase_picture(
    portrait: Portrait,
    ground: Canvas,
    points: Sequence[PhasePoint],
    crosshair: tuple[float, float] | None = None,
    orbit: tuple[float, float] | None = None,
) -> Picture:
    """Points on the portrait's ground, later ones in front; perhaps a crosshair, perhaps the exact orbit of a state.

    Dots of several owners in one cell all stay.
    """
    viewport = portrait.viewport
    canvas = ground.copy()
    if crosshair is not None:
        x, y = viewport.x(crosshair[0]), viewport.y(crosshair[1])
        canvas.line([0, canvas.width], [y, y], TEXT, dotted=True)
        canvas.line([x, x], [0, canvas.height], TEXT, dotted=True)
    if orbit is not None:
        canvas.points(*portrait.orbit(*orbit), EXACT)
    if rings := [(point.owner, _closed(point.ring)) for point in points if point.ring is not None]:
        canvas.line(*on_screen(viewport, *_together(rings)))
    for point in points:
        x, y = float(viewport.x(point.theta)), float(viewport.y(point.omega))
        canvas.disc(x, y, 1.6, point.owner, hollow=point.owner == EXACT)
        letter(canvas, x, y, point)
    picture = canvas.picture()
    portrait.letters.write(picture)
    return picture


def _together(tracks: Sequence[tuple[int, Track]]) -> tuple[Floats, Floats, NDArray[np.int8]]:
    """All thetas, all omegas and whose they are: NumPy takes as long for a track as for all of them."""
    owners = np.repeat(np.array([owner for owner, _ in tracks], np.int8), [len(track[0]) for _, track in tracks])
    return np.concatenate([track[0] for _, track in tracks]), np.concatenate([track[1] for _, track in tracks]), owners


def _closed(ring: Track) -> Track:
    """A ring that comes back to its beginning, and a break."""
    return np.append(ring[0], [ring[0][0], np.nan]), np.append(ring[1], [ring[1][0], np.nan])


def on_screen(
    viewport: Viewport, theta: Floats, omega: Floats, owners: NDArray[np.int8]
) -> tuple[Floats, Floats, NDArray[np.int8]]:
    """Lines in dots, broken where they leave one edge for the other."""
    x, y = viewport.x(theta), viewport.y(omega)
    if not viewport.wrap:
        return x, y, owners
    across = np.flatnonzero(np.abs(np.diff(x)) > np.pi / viewport.theta_per_dot) + 1
    return np.insert(x, across, np.nan), np.insert(y, across, np.nan), np.insert(owners, across, 0)


def letter(canvas: Canvas, x: float, y: float, point: PhasePoint) -> None:
    """Write the point's letter into the first free cell around it, or at the edge nearest to it."""
    if not (math.isfinite(x) and math.isfinite(y)):
        return
    inside = 0 <= x < canvas.width and 0 <= y < canvas.height
    column = int(min(max(x, 0), canvas.width - 1)) // 2
    row = int(min(max(y, 0), canvas.height - 1)) // 4
    for right, down in _BESIDE if inside else ((0, 0), *_BESIDE):
        if canvas.is_free(column + right, row + down):
            canvas.label(column + right, row + down, point.letter, point.owner)
            return
