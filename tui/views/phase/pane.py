"""PhasePane: phase space, the methods in it, and a start to choose with the mouse or the keyboard."""

from time import perf_counter
from typing import TYPE_CHECKING, ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.reactive import var

from engine.methods.own import OwnMethodError
from engine.models.model import State
from engine.run.lockstep import Sample
from engine.scenes import SceneError
from tui.drawing.picture import Picture
from tui.playback.source import Source
from tui.views.messages import Asked, SceneChosen
from tui.views.phase.viewport import Viewport
from tui.views.view import Chooser

if TYPE_CHECKING:  # what brings NumPy can wait for the first paint
    from engine.phase_space.area import Neighbourhood, Neighbours

TITLE = "Phase space (F3): theta [rad], omega [rad/s]"
DOTS = 4  # that an arrow moves the crosshair
RING_TIME = 0.005  # s of a frame, for a ring that has to catch up


class PhasePane(Chooser[State]):
    """Click or enter chooses a start; a drag shows the orbit through the pointer."""

    BINDING_GROUP_TITLE = "Phase space"
    HELP = "A click starts there, a drag shows the orbit first; the wheel zooms, arrows move."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "move(-1, 0)", "crosshair: choose a start", False, "arrows"),
        Binding("right", "move(1, 0)"),
        Binding("up", "move(0, 1)"),
        Binding("down", "move(0, -1)"),
        Binding("enter", "choose", "Start", tooltip="start at the crosshair"),
        Binding("escape", "cancel", "leave it, then all in view", False, "esc"),
        Binding("z", "zoom(0.5)", "Zoom", tooltip="zoom in at the crosshair"),
        Binding("g", "radius", "Ring", tooltip="ring of neighbours, radii"),
    ]

    NEEDS_NUMPY = True

    radius: var[float | None] = var(None)
    """Of the ring of neighbours [rad]; None: no ring."""

    def __init__(self, radius: float | None = None) -> None:
        super().__init__()
        self.set_reactive(PhasePane.radius, radius)
        self.neighbours: Neighbours | None = None
        self.ring: Neighbourhood | None = None
        self.pointer: tuple[int, int] | None = None  # the cell under it
        self.aiming = False  # the pointer is about to choose a start
        self.zoomed: Viewport | None = None  # None: the whole portrait
        self._catching_up = False

    @property
    def settled(self) -> bool:
        """Whether the ring shown is that of the sample."""
        if self.sample is None or not self.drawable or self.neighbours is None:
            return self.sample is not None
        return self.neighbours.step == self.sample.step

    def watch_source(self) -> None:
        self.border_title = Content(TITLE)
        self.border_subtitle = f"{'click: start, ' if self.is_live else ''}wheel: zoom"
        super().watch_source()

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
            return Viewport.portrait(*self.cells, self.source.scene)
        self.zoomed = self.zoomed.resized(*self.cells)
        return self.zoomed

    @property
    def aim(self) -> State | None:
        """The state at the crosshair or, if there is none, under the pointer."""
        return self.cursor or (
            None if self.pointer is None else self.viewport.at_cell(*self.pointer)
        )

    def picture(self, source: Source, sample: Sample) -> Picture:
        from tui.views.phase.facts import caption
        from tui.views.phase.picture import method_points, phase_picture
        from tui.views.phase.portrait import Portrait

        self._carry_ring(source, sample)
        portrait = Portrait.of(self.viewport, source.scene.equations)
        orbit = self.aim if self.aiming or self.cursor is not None else None
        points = method_points(source, sample, self.shown, self.ring)
        plot = phase_picture(portrait, points, self.cursor, orbit)
        return Picture((*plot.rows, caption(source, self.aim, self.room.width)))

    def _carry_ring(self, source: Source, sample: Sample) -> None:
        """Let the ring keep up; where it has not, go on without waiting for the next sample."""
        if self.radius is None or source.scene.why_no_ring:
            self.neighbours = self.ring = None
            return
        from engine.phase_space.area import Neighbours

        self.neighbours = self.neighbours or Neighbours(self.radius)
        end = perf_counter() + RING_TIME
        try:
            while True:
                self.ring = self.neighbours.follow(
                    source.scene, sample.run, sample.step, source.changes, most=1
                )
                if self.neighbours.step >= sample.step or perf_counter() > end:
                    break
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

    # The keyboard

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        cancels = self.aiming or self.zoomed is not None
        return (action == "cancel" and cancels) or super().check_action(action, parameters)

    def action_move(self, right: int, up: int) -> None:
        """Move the crosshair; at the edge the picture moves."""
        if self.source is None or not self.drawable:
            return
        viewport = self.viewport
        here = self.aim or State(self.source.scene.theta, self.source.scene.omega)
        self.cursor, moved = viewport.stepped(here, DOTS * right, DOTS * up)
        goes_round = moved.wrap and self.zoomed is None and moved.omega == viewport.omega
        if moved != viewport and not goes_round:
            self.zoomed = moved
        self.draw()

    def choose(self, state: State) -> None:
        """Ask for a run from here with the step size in force."""
        assert self.source is not None
        try:
            scene = self.source.scene.altered(**state._asdict(), h=self.source.stepping.smallest)
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
        """Zoom at the crosshair, which comes to the middle, or at the pointer, or else at the middle."""
        viewport = self.viewport
        x, y = viewport.middle
        if (at := self.cursor) is not None:
            viewport = viewport.panned(
                x - float(viewport.x(at.theta)), y - float(viewport.y(at.omega))
            )
        elif self.pointer is not None:
            x, y = 2 * self.pointer[0] + 1, 4 * self.pointer[1] + 2
        self.zoomed = viewport.zoomed(factor, x, y)
        self.draw()

    def action_radius(self) -> None:
        """Take the next larger ring, after the largest none."""
        from engine.phase_space.area import RADII

        radii = (None, *RADII)
        self.radius = radii[(radii.index(self.radius) + 1) % len(radii)]

    # The mouse

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Begin to choose a start."""
        if (cell := self._cell(event)) is None:
            if event.y == 0:
                self.post_message(Asked("view('phase')"))
            return
        self.focus(scroll_visible=False)
        if self.is_live and event.button == 1:
            self.capture_mouse()
            self.cursor, self.pointer, self.aiming = None, cell, True
            self.draw()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        self.pointer = self._cell(event, clamp=self.aiming)
        self.draw()

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Choose the start under the pointer."""
        self.release_mouse()
        if self.aiming and (cell := self._cell(event, clamp=True)) is not None:
            self.aiming = False
            self.choose(self.viewport.at_cell(*cell))

    def on_leave(self) -> None:
        if not self.aiming:
            self.pointer = None
            self.draw()

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        self._wheel(event, 0.8)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        self._wheel(event, 1.25)

    def _wheel(self, event: events.MouseEvent, factor: float) -> None:
        if (cell := self._cell(event)) is not None:
            self.zoomed = self.viewport.zoomed(factor, 2 * cell[0] + 1, 4 * cell[1] + 2)
            event.stop()
            self.draw()

    def _cell(self, event: events.MouseEvent, clamp: bool = False) -> tuple[int, int] | None:
        """Return the plot's cell under the pointer; clamp: or the nearest."""
        x, y = event.get_content_offset_capture(self)
        columns, rows = self.cells
        nearest = min(max(x, 0), columns - 1), min(max(y, 0), rows - 1)
        return nearest if clamp or nearest == (x, y) else None
