"""Phase space with the methods in it, and a start to choose."""

import math
from typing import TYPE_CHECKING, ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.reactive import var

from engine.methods.own import OwnMethodError
from engine.models.model import State
from engine.run.lockstep import Sample
from tui.cli.time_limit import limited
from tui.drawing.picture import Picture
from tui.playback.live import has_own
from tui.playback.source import Source
from tui.views.phase.viewport import Viewport
from tui.views.reach import amplitude, frame
from tui.views.view import Chooser

if TYPE_CHECKING:  # what brings NumPy can wait for the first paint
    from engine.phase_space.area import Neighbourhood, Neighbours

DOTS = 4  # that an arrow moves the crosshair
RING = 0.1  # of the amplitude: large enough to be seen, and it stays a ring for a while


class PhasePane(Chooser[State]):
    """Click or enter chooses a start; a drag shows the orbit through the pointer."""

    BINDING_GROUP_TITLE = "Phase space"
    HELP = "A click starts there, a drag shows the orbit first; the wheel zooms, arrows move."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("z", "zoom(0.5)", "Zoom", tooltip="zoom in at the crosshair"),
        Binding("g", "radius", "Ring", tooltip="ring of neighbours, radii"),
    ]
    MOVES = True
    NEEDS_NUMPY = True

    radius: var[float | None] = var(None)
    """Of the ring of neighbours, over the amplitude or 1 rad; None: no ring but that of a shot."""

    def __init__(self) -> None:
        super().__init__()
        self.neighbours: Neighbours | None = None
        self.ring: Neighbourhood | None = None
        self.aiming = False  # the pointer is about to choose a start
        self.zoomed: Viewport | None = None  # None: the whole portrait

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
        if self.zoomed is not None:
            self.zoomed = self.zoomed.resized(*self.cells)
            return self.zoomed
        scene = self.source.scene
        half = math.pi
        if self.sample is not None and not self.shown.overview:
            stepping = self.source.stepping
            half = self.shown.theta or frame(scene, stepping, self.sample, self.places)
        line = self.shown.line
        fence = abs(line.value) if line and line.quantity == "omega" else 0.0
        return Viewport.portrait(*self.cells, scene, half, fence)

    @property
    def aim(self) -> State | None:
        """The state at the crosshair or, if there is none, under the pointer."""
        return self.cursor or self.pointer

    def picture(self, source: Source, sample: Sample) -> Picture:
        from tui.views.phase.facts import caption
        from tui.views.phase.picture import method_points, phase_picture
        from tui.views.phase.portrait import Portrait

        below = "click: start, wheel: zoom" if self.is_live else "wheel: zoom"
        self.write_titles("Phase space (F3): theta [rad], omega [rad/s]", below)
        self._carry_ring(source, sample)
        portrait = Portrait.of(self.viewport, source.scene.equations)
        orbit = self.pointer if self.aiming else self.cursor
        points = method_points(source, sample, self.shown, self.ring)
        plot = phase_picture(portrait, points, self.cursor, orbit, self.shown.line)
        return Picture((*plot.rows, caption(source, self.aim, self.room.width)))

    def _carry_ring(self, source: Source, sample: Sample) -> None:
        """Let the ring keep up, by so many steps a frame as cost 5 ms."""
        scene = source.scene
        share = self.radius or (RING if self.shown.ring else None)
        if share is None or scene.why_no_ring:
            self.neighbours = self.ring = None
            return
        from engine.phase_space.area import Neighbours

        radius = share * min(amplitude(scene.equations, scene.theta, scene.omega), 1.0)
        if self.neighbours is None or self.neighbours.radius != radius:
            self.neighbours = Neighbours(radius)
        steps = 1 if has_own(scene) else 100
        try:
            with limited("the ring"):
                self.ring = self.neighbours.follow(
                    scene, sample.run, sample.step, source.changes, steps
                )
        except OwnMethodError as error:
            self.radius = self.neighbours = self.ring = None
            self.notify(str(error), severity="warning", markup=False)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        cancels = self.aiming or self.zoomed is not None
        return (action == "cancel" and cancels) or super().check_action(action, parameters)

    def action_move(self, right: int, up: int) -> None:
        if self.drawable:
            here = self.aim or State(self.source.scene.theta, self.source.scene.omega)
            self.cursor = self.viewport.stepped(here, DOTS * right, DOTS * up)
            self.draw()

    def choose(self, place: State) -> None:
        self.start_at(*place)
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

    async def on_mouse_down(self, event: events.MouseDown) -> None:
        """Show the orbit through the pointer until it is released."""
        if self._cell(event) is None:
            if event.y == 0:
                await self.run_action("screen.view('phase')")
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
