"""Phase space with the methods in it, or one method's map, and a start to choose."""

import math
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from textual import events
from textual.binding import Binding, BindingType
from textual.reactive import var

from engine.methods import Method
from engine.methods.own import OwnMethodError
from engine.models.model import Model, State
from engine.run.lockstep import Sample
from engine.scenes import SceneError
from tui.cli.time_limit import limited
from tui.drawing.palette import TEXT, inks
from tui.drawing.picture import Picture
from tui.playback.live import has_own
from tui.playback.source import Source
from tui.views.messages import Asked, SceneChosen
from tui.views.phase.viewport import Viewport
from tui.views.reach import amplitude, frame
from tui.views.view import Chooser

if TYPE_CHECKING:  # what brings NumPy can wait for the first paint
    from engine.phase_space.area import Neighbourhood, Neighbours
    from engine.phase_space.section import OrbitKind, Points
    from tui.views.phase.section import Section

TITLE = "Phase space (F3): theta [rad], omega [rad/s]"
DOTS = 4  # that an arrow moves the crosshair
RING = 0.1  # of the amplitude: large enough to be seen, and it stays a ring for a while
RING_STEPS = 100  # a frame, for a ring that has to catch up; they cost 5 ms
ORBIT_STEPS = 2000  # some ms


class PhasePane(Chooser[State]):
    """Click or enter chooses a start; a drag shows the orbit through the pointer."""

    BINDING_GROUP_TITLE = "Phase space"
    HELP = "A click starts there, a drag shows the orbit first; the wheel zooms, arrows move."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("z", "zoom(0.5)", "Zoom", tooltip="zoom in at the crosshair"),
        Binding("g", "radius", "Ring", tooltip="ring of neighbours, radii"),
    ]

    NEEDS_NUMPY = True

    radius: var[float | None] = var(None)
    """Of the ring of neighbours, over the amplitude or 1 rad; None: no ring but that of a shot."""

    def __init__(self, radius: float | None = None) -> None:
        super().__init__()
        self.set_reactive(PhasePane.radius, radius)
        self.neighbours: Neighbours | None = None
        self.ring: Neighbourhood | None = None
        self.aiming = False  # the pointer is about to choose a start
        self.zoomed: Viewport | None = None  # None: the whole portrait
        self._catching_up = False

    @property
    def settled(self) -> bool:
        """Whether the ring shown is that of the sample."""
        if self.sample is None or not self.drawable or self.neighbours is None:
            return self.sample is not None
        return self.neighbours.step == self.sample.step

    def watch_radius(self) -> None:
        """Begin another ring at the run's start."""
        self.neighbours = self.ring = None
        self.draw()

    @property
    def cells(self) -> tuple[int, int]:
        """Columns and rows of the plot; a pane that is just being hidden still has one of each."""
        return max(self.room.width, 1), max(self.room.height - 1, 1)

    @property
    def viewport(self) -> Viewport:
        assert self.source is not None
        if self.zoomed is None:
            line = self.shown.line
            fence = abs(line.value) if line and line.quantity == "omega" else 0.0
            return Viewport.portrait(*self.cells, self.source.scene, self._half_width, fence)
        self.zoomed = self.zoomed.resized(*self.cells)
        return self.zoomed

    @property
    def _half_width(self) -> float:
        """What is shown of theta [rad], to both sides."""
        source = self.source
        if source is None or self.sample is None or self.shown.overview:
            return math.pi
        if self.shown.theta is not None:
            return self.shown.theta
        return frame(source.scene, source.stepping, self.sample, self.places)

    @property
    def aim(self) -> State | None:
        """The state at the crosshair or, if there is none, under the pointer."""
        return self.cursor or self.pointer

    def picture(self, source: Source, sample: Sample) -> Picture:
        from tui.views.phase.facts import caption
        from tui.views.phase.picture import method_points, phase_picture
        from tui.views.phase.portrait import Portrait

        self.write_titles(TITLE, f"{'click: start, ' if self.is_live else ''}wheel: zoom")
        self._carry_ring(source, sample)
        portrait = Portrait.of(self.viewport, source.scene.equations)
        orbit = self.pointer if self.aiming else self.cursor
        points = method_points(source, sample, self.shown, self.ring)
        plot = phase_picture(portrait, points, self.cursor, orbit, self.shown.line)
        return Picture((*plot.rows, caption(source, self.aim, self.room.width)))

    def _carry_ring(self, source: Source, sample: Sample) -> None:
        """Let the ring keep up; where it has not, go on without waiting for the next sample."""
        share = self.radius or (RING if self.shown.ring else None)
        if share is None or source.scene.why_no_ring:
            self.neighbours = self.ring = None
            return
        scene = source.scene
        radius = share * min(amplitude(scene.equations, scene.theta, scene.omega), 1.0)
        from engine.phase_space.area import Neighbours

        if self.neighbours is None or self.neighbours.radius != radius:
            self.neighbours = Neighbours(radius)
        steps = 1 if has_own(source.scene) else RING_STEPS
        try:
            with limited("the ring"):
                self.ring = self.neighbours.follow(
                    source.scene, sample.run, sample.step, source.changes, steps
                )
        except OwnMethodError as error:
            self.radius = self.neighbours = self.ring = None
            self.notify(str(error), severity="warning", markup=False)
            return
        if self.neighbours.step < sample.step and not self._catching_up:
            self._catching_up = True
            self.set_timer(1 / 30, self._catch_up)

    def _catch_up(self) -> None:
        self._catching_up = False
        self.draw()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        cancels = self.aiming or self.zoomed is not None
        return (action == "cancel" and cancels) or super().check_action(action, parameters)

    def action_move(self, right: int, up: int) -> None:
        if self.source is not None and self.drawable:
            here = self.aim or State(self.source.scene.theta, self.source.scene.omega)
            self.cursor = self.viewport.stepped(here, DOTS * right, DOTS * up)
            self.draw()

    def choose(self, place: State) -> None:
        """Ask for a run from here with the step size in force."""
        assert self.source is not None
        try:
            scene = self.source.scene.altered(**place._asdict(), h=self.source.stepping.smallest)
        except SceneError as error:  # far out, omega may be beyond a scene's limits
            self.notify(str(error), severity="warning")
        else:
            self.post_message(SceneChosen(scene))
        self.draw()

    def action_cancel(self) -> None:
        """Leave the crosshair, or show the whole portrait again."""
        if self.cursor is None and not self.aiming:
            self.zoomed = None
        self.aiming = False
        super().action_cancel()

    def action_zoom(self, factor: float) -> None:
        """Zoom about the crosshair or the pointer, which moves to the middle."""
        viewport = self.viewport
        x, y = viewport.middle
        if at := self.aim:
            right = x - float(viewport.x(at.theta))
            viewport = viewport.panned(right, y - float(viewport.y(at.omega)))
        self.zoomed = viewport.zoomed(factor, x, y)
        self.draw()

    def action_radius(self) -> None:
        """Take the next larger ring, then the small ones, then none."""
        from engine.phase_space.area import RADII

        first = RADII.index(RING)
        radii = (None, *RADII[first:], *RADII[:first])
        self.radius = radii[(radii.index(self.radius) + 1) % len(radii)]

    def place_under(self, event: events.MouseEvent) -> State | None:
        cell = self._cell(event)
        return cell and self.viewport.at_cell(*cell)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Show the orbit through the pointer until it is released."""
        if self._cell(event) is None:
            if event.y == 0:
                self.post_message(Asked("view('phase')"))
            return
        self.focus(scroll_visible=False)
        if self.is_live:
            self.capture_mouse()
            self.aiming = True
            self.cursor = None
            self.pointer = self.place_under(event)
            self.draw()

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Choose the start under the pointer, if the drag has not been cancelled."""
        self.release_mouse()
        place = self.place_under(event)
        if self.aiming and place is not None:
            self.choose(place)
        self.aiming = False
        self.draw()

    def on_click(self, event: events.Click) -> None:
        event.prevent_default()  # the start was chosen on release

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        self._wheel(event, 0.8)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        self._wheel(event, 1.25)

    def _wheel(self, event: events.MouseEvent, factor: float) -> None:
        if (cell := self._cell(event)) is not None:
            self.zoomed = self.viewport.zoomed(factor, 2 * cell[0] + 1, 4 * cell[1] + 2)
            event.stop()
            self.draw()

    def _cell(self, event: events.MouseEvent) -> tuple[int, int] | None:
        """Return the plot's cell under the pointer."""
        x, y = event.get_content_offset_capture(self)
        columns, rows = self.cells
        return (x, y) if x in range(columns) and y in range(rows) else None


class Wanted(NamedTuple):
    """What a section depends on."""

    method: Method
    model: Model
    h: float  # s
    viewport: Viewport


class SectionPane(PhasePane):
    """The portrait or, after x, the section of the method that is described."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("x", "section", "Map", tooltip="a method's own map")
    ]

    shows_section: var[bool] = var(False)

    def __init__(self, radius: float | None = None) -> None:
        super().__init__(radius)
        self.wanted: Wanted | None = None
        self.share = 0.0  # of the section that is there
        self._section: Section | None = None

    @property
    def settled(self) -> bool:
        return self.share == 1 if self.drawable and self.shows_section else super().settled

    def watch_shows_section(self) -> None:
        self.wanted = self._section = None
        self.draw()

    def picture(self, source: Source, sample: Sample) -> Picture:
        if self.shows_section and (why := source.scene.why_not_mapped):
            self.notify(why, severity="warning")
            self.shows_section = False
        return self._map(source) if self.shows_section else super().picture(source, sample)

    def _map(self, source: Source) -> Picture:
        """Return the section, and a line about the orbit aimed at, or that of the start."""
        from tui.views.phase.section import Section
        from tui.words.orbit import sentence

        method = self.cast[self.index]
        h = abs(source.stepping.own[self.index])
        model = source.scene.equations
        wanted = Wanted(method, model, h, self.viewport)
        if wanted != self.wanted or self._section is None:
            self.wanted = wanted
            self.share = 0.0
            self._section = Section(wanted.viewport, model, method, inks(self.cast)[self.index])
        done = "" if self.share == 1 else f", computing {int(10 * self.share) / 10:.0%}"
        title = f"Own map of {method.label}: h {h:g} s, z {h * model.w0:.4g}{done}"
        self.write_titles(title, "wheel: zoom, tab: next method, x: back")
        start = self.cursor or State(source.scene.theta, source.scene.omega)
        points, _ = followed(method, model, h, start)
        plot = self._section.picture(points, start, self.cursor)
        _, kind = followed(method, model, h, self.aim or start)
        where = f"{self.aim.theta:g}, {self.aim.omega:g}" if self.aim else "start"
        return Picture.stacked(plot, Picture.of_line(f"{where}: {sentence(method, kind)}", TEXT))

    def fill(self, wanted: Wanted, points: "Points", share: float) -> None:
        """Add some orbits to a section, unless another one is wanted by now."""
        if wanted == self.wanted and self._section is not None:
            self._section.add(points)
            self.share = share
            self.draw()

    def action_section(self) -> None:
        self.shows_section = not self.shows_section


@lru_cache(maxsize=64)
def followed(method: Method, model: Model, h: float, start: State) -> "tuple[Points, OrbitKind]":
    """Return the orbit of a start, and its kind."""
    from engine.phase_space.section import kind_of, orbit

    points = orbit(method, model, h, start, ORBIT_STEPS)
    return points, kind_of(method, model, h, points)
