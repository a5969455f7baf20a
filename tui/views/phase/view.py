"""PhaseView: phase space over the whole screen, with a table of areas."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import ClassVar

import numpy as np
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.reactive import var

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models.model import Model, State
from pendu_tui.engine.phase_space.section import OrbitKind, Points, kind_of, orbit, pieces, spread
from pendu_tui.engine.quantities import Head
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import FRAME, TEXT, faint, inks
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.error_table import Column, ErrorTable
from pendu_tui.tui.views.phase.pane import PhasePane
from pendu_tui.tui.views.phase.portrait import (
    BLOCK,
    PhasePoint,
    Portrait,
    axes,
    draw_crosshair,
    draw_dots,
    draw_points,
    on_screen,
    write_words,
)
from pendu_tui.tui.views.phase.viewport import Viewport
from pendu_tui.tui.views.view import Memo, StudyView
from pendu_tui.tui.words.studies import sentence

STARTS = 300  # orbits of a section
ORBIT_STEPS = 2000  # they take a few ms
GAP = 2  # dots between orbits of a section
AREA = Head("area", 11, "area/area0", 11)


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
            draw_dots(canvas, viewport, orbit, self._ink, BLOCK[:3])
        else:  # a spiral of 300 steps
            canvas.path(*on_screen(viewport, orbit[0][:300], orbit[1][:300]), self._ink)
        if crosshair is not None:
            draw_crosshair(canvas, viewport, crosshair)
        draw_points(canvas, viewport, [PhasePoint(*start, self._ink, self._method.letter)])
        write_words(canvas, axes(viewport))
        return canvas.picture()


class SectionPane(PhasePane):
    """The portrait or, after key x, a section of one method."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("x", "section", "Map", tooltip="a method's own map")
    ]

    shows_section: var[bool] = var(False)

    def __init__(self) -> None:
        super().__init__()
        self._section = Memo(self._begun)
        self._orbits = 0  # of the section, so far

    @property
    def settled(self) -> bool:
        if self.drawable and self.shows_section:
            return self._orbits == STARTS
        return super().settled

    def watch_shows_section(self) -> None:
        if not self.shows_section:
            self._section.forget()
            self.workers.cancel_node(self)
        self.draw()

    def picture(self, source: Source, sample: Sample) -> Picture:
        if self.shows_section and (why := source.scene.why_not_mapped):
            self.notify(why, severity="warning")
            self.shows_section = False
        if self.shows_section:
            return self._map(source)
        return super().picture(source, sample)

    def _begun(
        self, viewport: Viewport, model: Model, method: Method, ink: int, h: float
    ) -> Section:
        """Begin to compute a section, of which there is nothing yet."""
        self._orbits = 0
        self.compute(pieces, method, model, h, starts(viewport, STARTS), ORBIT_STEPS)
        return Section(viewport, model, method, ink)

    def _map(self, source: Source) -> Picture:
        method = self.cast[self.index]
        h = abs(source.stepping.own[self.index])
        model = source.scene.equations
        section = self._section(self.viewport, model, method, inks(self.cast)[self.index], h)
        title = f"Own map of {method.label}: h {h:g} s, z {h * model.w0:.4g}"
        if self._orbits < STARTS:
            title += f", computing {10 * self._orbits // STARTS / 10:.0%}"
        self.write_titles(title, "wheel: zoom, tab: next method, x: back")
        start = self.cursor or State(source.scene.theta, source.scene.omega)
        plot = section.picture(_orbit(method, model, h, start)[0], start, self.cursor)
        _, kind = _orbit(method, model, h, self.aim or start)
        where = "start"
        if self.aim:
            where = f"{self.aim.theta:g}, {self.aim.omega:g}"
        return Picture((*plot.rows, [(f"{where}: {sentence(method, kind)}", TEXT)]))

    def forget(self) -> None:
        self._section.forget()

    def add(self, result: Points) -> None:
        self._section.result.add(result)
        self._orbits += result[0].shape[1]

    def action_section(self) -> None:
        self.shows_section = not self.shows_section


@lru_cache(maxsize=64)
def _orbit(method: Method, model: Model, h: float, start: State) -> tuple[Points, OrbitKind]:
    points = orbit(method, model, h, start, ORBIT_STEPS)
    return points, kind_of(method, model, h, points)


class AreaTable(ErrorTable):
    """Also says how each method has changed the area of the ring, if there is one."""

    def __init__(self, pane: PhasePane) -> None:
        super().__init__()
        self._pane = pane

    @property
    def more(self) -> Sequence[Column]:
        ring = self._pane.ring
        if ring is None or len(ring.area_ratios) != len(self.cast):  # of the run before
            return ()
        ratios = dict(zip(self.cast, ring.area_ratios, strict=True))
        return [Column(9, AREA, lambda line, _: area_text(ratios[line.method]))]


class PhaseView(StudyView):
    PANE = SectionPane

    def compose(self) -> ComposeResult:
        yield from super().compose()
        yield self.with_source(AreaTable(self.pane))


def area_text(ratio: float) -> str:
    """Return an area ratio as a text that differs from 1: "1 + 2.2e-16"."""
    if not 0 < ratio < math.inf:
        return "> 1e308" if ratio else "< 1e-308"
    if ratio == 1:
        return "1"
    if abs(ratio - 1) < 1e-6:
        return f"1 {'+' if ratio > 1 else '-'} {abs(ratio - 1):.1e}"
    return f"{ratio:.9f}" if 1e-3 <= ratio < 1e3 else f"{ratio:.3e}"
