"""The phase portrait of a method's own map, dot by dot: as many orbits as can be told apart."""

import numpy as np
from numpy.typing import NDArray

from engine.methods import Method
from engine.models.model import Model, Phase, State
from engine.phase_space.section import Points, spread
from tui.drawing.canvas import Canvas
from tui.drawing.palette import FRAME, faint
from tui.drawing.picture import Picture
from tui.views.phase.picture import PhasePoint, draw_crosshair, letter, on_screen
from tui.views.phase.portrait import Portrait, axes, write_words
from tui.views.phase.viewport import Viewport

GAP = 2  # dots between orbits
TAKEN = (0.6, 0.3)  # of an orbit's dots may lie within a gap of others'; second, where orbits do not come together
SPIRAL = 300  # steps of an orbit that are joined by lines, if the method is not symplectic


def starts(viewport: Viewport, count: int) -> Points:
    """So many starts all over a viewport."""
    width, height = 2.0 * viewport.columns, 4.0 * viewport.rows
    return spread(
        count, (viewport.theta_at(0.0), viewport.theta_at(width)), (viewport.omega_at(height), viewport.omega_at(0.0))
    )


class Section:
    """Orbits of one method on one viewport, with the separatrix of the true pendulum underneath."""

    def __init__(self, viewport: Viewport, model: Model, method: Method, ink: int) -> None:
        self.viewport = viewport
        self.method = method
        self.ink = ink
        self._ground = Canvas(viewport.columns, viewport.rows)
        if model.key == "pendulum":
            self._ground.scatter(*Portrait.of(viewport, model.w0).separatrix, FRAME)
        self._near = np.zeros((4 * viewport.rows + 2 * GAP, 2 * viewport.columns + 2 * GAP), np.bool_)
        self._axes = axes(viewport)

    def add(self, points: Points) -> None:
        """Draw those orbits, a column each, that leave a gap to those before."""
        x, y = self._dots(points)
        inside = (x >= 0) & (x < 2 * self.viewport.columns) & (y >= 0) & (y < 4 * self.viewport.rows)
        for each in range(x.shape[1]):
            at = inside[:, each]
            i, j = np.unique(np.stack([x[at, each], y[at, each]]).astype(np.intp), axis=1)
            if len(i) and self._near[j + GAP, i + GAP].mean() <= TAKEN[self.method.symplectic]:
                self._ground.scatter(i, j, faint(self.ink))
                for right in range(2 * GAP + 1):
                    for down in range(2 * GAP + 1):
                        self._near[j + down, i + right] = True

    def picture(self, orbit: Points, start: State, crosshair: Phase | None = None) -> Picture:
        """All that was drawn, one orbit in thick dots or, if it is a spiral, joined; its start, perhaps a crosshair."""
        viewport, canvas, ink = self.viewport, self._ground.copy(), self.ink
        if self.method.symplectic:
            x, y = self._dots(orbit)
            for right, down in ((0, 0), (1, 0), (0, 1)):
                canvas.scatter(x + right, y + down, ink)
        else:
            theta, omega = orbit[0][:SPIRAL], orbit[1][:SPIRAL]
            canvas.path(on_screen(viewport, theta, omega), ink)
        if crosshair is not None:
            draw_crosshair(canvas, float(viewport.x(crosshair[0])), float(viewport.y(crosshair[1])))
        at_x, at_y = float(viewport.x(start[0])), float(viewport.y(start[1]))
        canvas.disc(at_x, at_y, 1.6, ink)
        letter(canvas, at_x, at_y, PhasePoint(*start, ink, self.method.letter))
        write_words(canvas, self._axes)
        return canvas.picture()

    @np.errstate(all="ignore")  # a method may be farther out than dots can be counted
    def _dots(self, points: Points) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return np.floor(self.viewport.x(points[0])), np.floor(self.viewport.y(points[1]))
