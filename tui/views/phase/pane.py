"""PhasePane: the methods in phase space, where a new start can be chosen."""

import math
from typing import TYPE_CHECKING, ClassVar

from textual import events
from textual.binding import Binding, BindingType

from pendu_tui.engine.methods.own import OwnMethodError
from pendu_tui.engine.models.model import State
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.cli.time_limit import limited
from pendu_tui.tui.drawing.picture import Picture
from pendu_tui.tui.playback.live import has_own
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.views.phase.viewport import Viewport
from pendu_tui.tui.views.reach import amplitude, reach
from pendu_tui.tui.views.view import Chooser

if TYPE_CHECKING:  # NumPy is imported after the first paint
    from pendu_tui.engine.phase_space.area import Neighbourhood, Neighbours
    from pendu_tui.tui.drawing.canvas import Canvas

TRAIL_SECONDS = 0.09  # of the clock, for which trails stay as they are: three frames
DOTS = 4  # an arrow key moves the crosshair so far


class PhasePane(Chooser[State]):
    """A click or enter starts a run there; the exact orbit under the pointer is drawn."""

    BINDING_GROUP_TITLE = "Phase space"
    HELP = "A click starts there, the pointer shows the orbit; the wheel zooms, arrows move."
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("z", "zoom(0.5)", "Zoom", tooltip="zoom in at the crosshair"),
        Binding("g", "screen.switch('ring')", "Ring", tooltip="ring of neighbours"),
    ]
    MOVES = True
    NEEDS_NUMPY = True

    def __init__(self) -> None:
        super().__init__()
        self.neighbours: Neighbours | None = None
        self.ring: Neighbourhood | None = None
        self._ringless: Scene | None = None  # its own method failed to carry a ring
        self.zoomed: Viewport | None = None  # None: the whole portrait
        self._ground: Canvas | None = None  # with trails, and what it shows
        self._ground_key: object = None
        self._ground_t = 0.0  # s, simulated

    @property
    def settled(self) -> bool:
        if self.sample is None or not self.drawable or self.neighbours is None:
            return self.sample is not None
        return self.neighbours.step == self.sample.step

    @property
    def _cells(self) -> tuple[int, int]:
        # at least one, while the pane is being hidden
        return max(self.room.width, 1), max(self.room.height - 1, 1)

    @property
    def viewport(self) -> Viewport:
        if self.zoomed is not None:
            columns, rows = self._cells
            return self.zoomed._replace(columns=columns, rows=rows)
        scene = self.source.scene
        half = math.pi
        if self.sample is not None and not self.shown.overview:
            found = reach(scene, self.source.stepping, self.sample, self.places)
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
        from pendu_tui.tui.views.phase.portrait import (
            Portrait,
            caption,
            method_points,
            phase_ground,
            phase_picture,
            ring_text,
        )

        self._carry_ring(source, sample)
        below = "click: start, wheel: zoom, g: ring"
        if self.shown.ring:
            below = ring_text(source, self.neighbours) or below
        self.write_titles("Phase space (F3): theta [rad], omega [rad/s]", below)
        portrait = Portrait.of(self.viewport, source.scene.equations)
        points = method_points(source, sample, self.shown, self.ring)
        line = self.shown.line
        key = portrait.viewport, source.scene, self.cursor, self.aim, self.shown, sample.run
        seconds = abs(sample.t - self._ground_t) / abs(source.playhead.speed)
        is_late = seconds >= TRAIL_SECONDS or source.playhead.paused
        if is_late or key != self._ground_key:
            self._ground_key = key
            self._ground_t = sample.t
            self._ground = phase_ground(portrait, points, self.cursor, self.aim, line)
        plot = phase_picture(portrait, points, self._ground)
        return Picture((*plot.rows, caption(source, self.aim, self.room.width)))

    def _carry_ring(self, source: Source, sample: Sample) -> None:
        scene = source.scene
        if not self.shown.ring or scene.why_no_ring or scene is self._ringless:
            self.neighbours = self.ring = None
            return
        from pendu_tui.engine.phase_space.area import Neighbours

        # large enough to see, small enough to stay a ring for a while
        radius = 0.1 * min(amplitude(scene.equations, scene.theta, scene.omega), 1.0)
        if self.neighbours is None or self.neighbours.radius != radius:
            self.neighbours = Neighbours(radius)
        steps = 100  # a frame, which cost 5 ms
        if has_own(scene):
            steps = 1
        try:
            with limited():
                self.ring = self.neighbours.follow(
                    scene, sample.run, sample.step, source.changes, steps
                )
        except OwnMethodError as error:
            self._ringless = scene
            self.neighbours = self.ring = None
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
        self.draw()

    def action_cancel(self) -> None:
        if self.cursor is None:
            self.zoomed = None
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

    def place_under(self, event: events.MouseEvent) -> State | None:
        cell = self._cell(event)
        return cell and self.viewport.at_cell(*cell)

    async def on_click(self, event: events.Click) -> None:
        if event.y == 0:  # the title
            await self.run_action("screen.view('phase')")

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
        x, y = event.get_content_offset_capture(self)
        columns, rows = self._cells
        return (x, y) if x in range(columns) and y in range(rows) else None
