"""The phase portrait of a method's own map, dot by dot: as many orbits as look different."""

import numpy as np
from numpy.typing import NDArray

from engine.methods import Method
from engine.models.model import Model, State
from engine.phase_space.section import Points, spread
from tui.drawing.canvas import Canvas
from tui.drawing.palette import FRAME, faint
from tui.drawing.picture import Picture
from tui.views.phase.picture import PhasePoint, draw_crosshair, draw_point, on_screen
from tui.views.phase.portrait import Portrait, axes, write_words
from tui.views.phase.viewport import Viewport

GAP = 2  # dots between orbits
MAX_TAKEN = {True: 0.6, False: 0.3}
"""The share of an orbit's dots that may lie in a gap of others', symplectic or not."""
SPIRAL = 300  # steps of an orbit that are joined by lines, if the method is not symplectic


def starts(viewport: Viewport, count: int) -> Points:
    """Return so many starts all over a viewport."""
    across = viewport.theta_at(0.0), viewport.theta_at(2.0 * viewport.columns)
    return spread(count, across, (viewport.omega_at(4.0 * viewport.rows), viewport.omega_at(0.0)))


class Section:
    """Orbits of one method on one viewport, with the separatrix of the true pendulum underneath."""

    def __init__(self, viewport: Viewport, model: Model, method: Method, ink: int) -> None:
        self.viewport = viewport
        self.method = method
        self.ink = ink
        self._ground = Canvas(viewport.columns, viewport.rows)
        self._ground.scatter(*Portrait.of(viewport, model).separatrix, FRAME)
        self._near = np.zeros(
            (4 * viewport.rows + 2 * GAP, 2 * viewport.columns + 2 * GAP), np.bool_
        )
        self._axes = axes(viewport)

    def add(self, points: Points) -> None:
        """Draw those orbits, a column each, that leave a gap to those before."""
        x, y = self._dots(points)
        inside = (
            (x >= 0) & (x < 2 * self.viewport.columns) & (y >= 0) & (y < 4 * self.viewport.rows)
        )
        for each in range(x.shape[1]):
            at = inside[:, each]
            i, j = np.unique(np.stack([x[at, each], y[at, each]]).astype(np.intp), axis=1)
            if len(i) and self._near[j + GAP, i + GAP].mean() <= MAX_TAKEN[self.method.symplectic]:
                self._ground.scatter(i, j, faint(self.ink))
                for right in range(2 * GAP + 1):
                    for down in range(2 * GAP + 1):
                        self._near[j + down, i + right] = True

    def picture(self, orbit: Points, start: State, crosshair: State | None = None) -> Picture:
        """Return the drawing with one orbit in thick dots, or a joined spiral, and its start."""
        canvas = self._ground.copy()
        if self.method.symplectic:
            x, y = self._dots(orbit)
            for right, down in ((0, 0), (1, 0), (0, 1)):
                canvas.scatter(x + right, y + down, self.ink)
        else:
            canvas.path(on_screen(self.viewport, orbit[0][:SPIRAL], orbit[1][:SPIRAL]), self.ink)
        if crosshair is not None:
            draw_crosshair(canvas, self.viewport, crosshair)
        draw_point(canvas, self.viewport, PhasePoint(*start, self.ink, self.method.letter))
        write_words(canvas, self._axes)
        return canvas.picture()

    @np.errstate(all="ignore")  # a method may be farther out than dots can be counted
    def _dots(self, points: Points) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return np.floor(self.viewport.x(points[0])), np.floor(self.viewport.y(points[1]))
