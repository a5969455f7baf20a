"""Phase space (F3, and a pane of the lab): theta across, omega up.

The lab's pane is drawn without NumPy until the first paint, so what needs it is imported later.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

from textual import events
from textual.binding import Binding, BindingType

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.own import OwnMethodError
from pendu_tui.engine.models.model import Model, State
from pendu_tui.engine.quantities import Head
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.watchdog import limited
from pendu_tui.tui.drawing.picture import TEXT, Picture, inks
from pendu_tui.tui.playback.live import has_own
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.error_table import Column, ErrorTable
from pendu_tui.tui.views.view import Chooser, Memo, StudyView
from pendu_tui.tui.views.viewport import LEFT, Viewport, amplitude, reach

if TYPE_CHECKING:  # NumPy is imported after the first paint
    from pendu_tui.engine.studies.ring import Neighbourhood
    from pendu_tui.engine.studies.section import Points
    from pendu_tui.tui.views.portrait import Section

DOTS = 4  # an arrow key moves the crosshair so far


class PhasePane(Chooser[State]):
    """A click or enter starts a run there; the exact orbit under the pointer is drawn."""

    BINDING_GROUP_TITLE = "Phase space"
    HELP = "Click to start a run there; point to see the orbit; the wheel zooms."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("z", "zoom(0.5)", "Zoom", tooltip="zoom in at the crosshair"),
        Binding("g", "screen.switch('ring')", "Ring", tooltip="ring of neighbours"),
    ]
    EVERY = 6  # in the lab it is small
    NEEDS_NUMPY = True

    def __init__(self) -> None:
        super().__init__()
        self.neighbours: Neighbourhood | None = None
        self._ringless: Scene | None = None  # its own method failed to carry a ring
        self.zoomed: Viewport | None = None  # None: the whole portrait

    @property
    def settled(self) -> bool:
        is_behind = self.neighbours and self.neighbours.step != self.source.sample.step
        return super().settled and not (is_behind and self.drawable)

    @property
    def ring(self) -> "Neighbourhood | None":
        """The ring of this run, as far as it has been carried."""
        ring = self.neighbours
        if ring is None or not ring.is_of(self.source.scene, self.source.sample.run):
            return None
        return ring

    def area_columns(self) -> Sequence[Column]:
        """Return how each method has changed the area of the ring, if there is one."""
        ring = self.ring
        if ring is None:
            return ()
        ratios = dict(zip(self.cast, ring.area_ratios, strict=True))
        return [Column(9, AREA, lambda line, _: area_text(ratios[line.method]))]

    @property
    def _cells(self) -> tuple[int, int]:
        # of the field; at least one, while the pane is being hidden
        return max(self.room.width - LEFT, 1), max(self.room.height - 2, 1)

    @property
    def viewport(self) -> Viewport:
        if self.zoomed is not None:
            columns, rows = self._cells
            return self.zoomed._replace(columns=columns, rows=rows)
        scene = self.source.scene
        half = math.pi
        if not self.shown.overview:
            found = reach(scene, self.source.stepping, self.source.sample, self.places)
            half = self.shown.theta or found.frame
        line = self.shown.line
        fence = 0.0
        if line and line.quantity == "omega":
            fence = abs(line.value)
        return Viewport.portrait(*self._cells, scene, half, fence)

    @property
    def aim(self) -> State | None:
        return self.cursor or self.pointer

    def picture(self, source: Source, sample: Sample) -> Picture:
        from pendu_tui.tui.views import portrait

        self._carry_ring(source, sample)
        below = "click: start, wheel: zoom, g: ring"
        if self.shown.ring:
            below = portrait.ring_text(source, self.ring) or below
        self.write_titles("Phase space (F3): theta [rad], omega [rad/s]", below)
        ground = portrait.portrait_of(self.viewport, source.scene.equations)
        points = portrait.method_points(source, sample, self.shown, self.ring)
        plot = portrait.phase_picture(ground, points, self.cursor, self.aim, self.shown.line)
        words = portrait.caption(source, self.aim, self.room.width)
        return Picture([*portrait.framed(ground.viewport, plot), words])

    def _carry_ring(self, source: Source, sample: Sample) -> None:
        scene = source.scene
        if not self.shown.ring or scene.why_no_ring or scene is self._ringless:
            self.neighbours = None
            return
        from pendu_tui.engine.studies.ring import Neighbourhood

        ring = self.ring
        if ring is None:
            # large enough to see, small enough to stay a ring for a while
            radius = 0.1 * min(amplitude(scene.equations, scene.theta, scene.omega), 1.0)
            ring = Neighbourhood(scene, radius, sample.run)
        steps = 100  # a frame, which cost 5 ms
        if has_own(scene):
            steps = 1
        try:
            with limited():
                self.neighbours = ring.following(sample.step, source.changes, steps)
        except OwnMethodError as error:
            self._ringless = scene
            self.neighbours = None
            self.notify(str(error), severity="warning")

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        if action == "cancel" and self.zoomed is not None:
            return True
        return super().check_action(action, parameters)

    def action_move(self, right: int, up: int) -> None:
        if self.drawable:
            here = self.aim or State(self.source.scene.theta, self.source.scene.omega)
            self.cursor = self.viewport.stepped(here, DOTS * right, DOTS * up)
            self.draw()

    def choose(self, place: State) -> None:
        self.start_at(*place)

    def action_cancel(self) -> None:
        if self.cursor is None:
            self.zoomed = None
        super().action_cancel()

    def action_zoom(self, factor: float) -> None:
        """Zoom about the crosshair or the pointer, which moves to the middle."""
        viewport = self.viewport
        if at := self.aim:
            viewport = viewport._replace(theta=at.theta, omega=at.omega)
        self.zoomed = viewport.zoomed(factor, *viewport.middle)
        self.draw()

    def place_under(self, event: events.MouseEvent) -> State | None:
        cell = self._cell(event)
        return cell and self.viewport.at_cell(*cell)

    async def on_click(self, event: events.Click) -> None:
        if event.y == 0:  # the title
            await self.run_action("screen.view('phase')")

    def wheel(self, event: events.MouseEvent, factor: float) -> None:
        if (cell := self._cell(event)) is not None:
            self.zoomed = self.viewport.zoomed(factor, 2 * cell[0] + 1, 4 * cell[1] + 2)
            self.draw()

    def _cell(self, event: events.MouseEvent) -> tuple[int, int] | None:
        x, y = event.get_content_offset_capture(self)
        columns, rows = self._cells
        return (x - LEFT, y) if x - LEFT in range(columns) and y in range(rows) else None


STARTS = 300  # orbits of a section
AREA = Head("area", 11, "area/area0", 11)


class SectionPane(PhasePane):
    """The portrait or, after key x, a section of one method."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("x", "screen.switch('section')", "Map", tooltip="a method's phase portrait")
    ]
    EVERY = 4

    def __init__(self) -> None:
        super().__init__()
        self._section = Memo(self._begun)

    def picture(self, source: Source, sample: Sample) -> Picture:
        if not self.shown.section:
            return super().picture(source, sample)
        if why := source.scene.why_not_mapped:
            self.write_titles("Map", "x: back")
            return Picture(self.words(why))
        return self._map(source)

    def _begun(
        self, viewport: Viewport, model: Model, method: Method, ink: int, h: float
    ) -> "Section":
        """Begin to compute a section, of which there is nothing yet."""
        from pendu_tui.engine.studies.section import pieces, spread
        from pendu_tui.tui.views import portrait

        starts = spread(STARTS, viewport.across, viewport.up)
        self.compute(pieces, method, model, h, starts, portrait.ORBIT_STEPS)
        return portrait.Section(viewport, model, method, ink)

    def _map(self, source: Source) -> Picture:
        from pendu_tui.tui.views import portrait
        from pendu_tui.tui.words.studies import orbit_words

        method = self.cast[self.index]
        h = abs(source.stepping.own[self.index])
        model = source.scene.equations
        section = self._section(self.viewport, model, method, inks(self.cast)[self.index], h)
        title = f"Map of {method.label}: h {h:g} s, z {h * model.w0:.4g}"
        if section.orbits < STARTS:
            title += f", computing {10 * section.orbits // STARTS / 10:.0%}"
        self.write_titles(title, "wheel: zoom, tab: next method, x: back")
        start = self.cursor or State(source.scene.theta, source.scene.omega)
        orbit, kind = portrait.orbit_of(method, model, h, start)
        plot = section.picture(orbit, start, self.cursor)
        where = "start"
        if self.aim:
            where = f"{self.aim.theta:g}, {self.aim.omega:g}"
            _, kind = portrait.orbit_of(method, model, h, self.aim)
        words = f"{where}: {orbit_words(method, kind)}"
        return Picture([*portrait.framed(self.viewport, plot), [(words, TEXT)]])

    def forget(self) -> None:
        self._section.forget()

    def add(self, result: "Points") -> None:
        self._section.result.add(result)


def view(name: str) -> StudyView:
    pane = SectionPane()
    return StudyView(name, pane, ErrorTable(pane.area_columns))


def area_text(ratio: float) -> str:
    """Return an area ratio as a text that differs from 1: "1 + 2.2e-16"."""
    if ratio == 0:
        return "< 1e-308"
    if not ratio < math.inf:
        return "> 1e308"
    if ratio == 1:
        return "1"
    if abs(ratio - 1) < 1e-6:
        return f"1 {'+' if ratio > 1 else '-'} {abs(ratio - 1):.1e}"
    if 1e-3 <= ratio < 1e3:
        return f"{ratio:.9f}"
    return f"{ratio:.3e}"
