"""PhasePane: phase space to choose a start from, with the mouse or the keyboard."""

from typing import ClassVar

from textual import events
from textual.binding import BindingType

from engine.models.state import State
from engine.phase_space.area import RADII
from engine.scenes import SceneError
from tui.views.keys import Key, bindings
from tui.views.messages import SceneChosen
from tui.views.phase.display import PhaseDisplay

BIG_STEP = 8  # dots

_GROUP = "phase space"
KEYS = (
    Key("", "tab", "in the lab: to this pane, for its keys", "", _GROUP),
    Key("left", "arrows", "crosshair, to choose a start", "move(-1, 0)", _GROUP),
    Key("right", "", "", "move(1, 0)", _GROUP),
    Key("up", "", "", "move(0, -1)", _GROUP),
    Key("down", "", "", "move(0, 1)", _GROUP),
    Key("shift+left", "shift+arrows", "crosshair in big steps", f"move({-BIG_STEP}, 0)", _GROUP),
    Key("shift+right", "", "", f"move({BIG_STEP}, 0)", _GROUP),
    Key("shift+up", "", "", f"move(0, {-BIG_STEP})", _GROUP),
    Key("shift+down", "", "", f"move(0, {BIG_STEP})", _GROUP),
    Key("enter", "enter", "start at the crosshair", "choose", _GROUP),
    Key("escape", "esc", "leave the crosshair, cancel a drag", "cancel", _GROUP),
    Key("z", "z", "zoom in at the crosshair or the pointer", "zoom(0.5)", _GROUP),
    Key("Z,shift+z", "Z", "zoom out", "zoom(2.0)", _GROUP),
    Key("o", "o", "overview: the whole portrait", "whole", _GROUP),
    Key("c", "c", "angles within a turn, or unwrapped", "wrap", _GROUP),
    Key("g", "g", "a ring of neighbours, of another radius", "radius(1)", _GROUP),
    Key("G,shift+g", "G", "a smaller ring, or none", "radius(-1)", _GROUP),
    Key("", "click, drag", "start there; a drag shows the orbit first", "", _GROUP),
    Key("", "wheel", "zoom at the pointer", "", _GROUP),
    Key("", "shift+drag", "move the picture, as arrows do at its edge", "", _GROUP),
)


class PhasePane(PhaseDisplay):
    """Click or Enter chooses a start; a drag shows the exact orbit through the pointer before.

    The wheel zooms; a drag with a modifier or another button moves the picture.
    """

    BINDINGS: ClassVar[list[BindingType]] = bindings(*KEYS)

    def __init__(self, id: str | None = None, radius: float | None = None) -> None:
        super().__init__(id, radius)
        self._panning: tuple[int, int] | None = None  # the cell where the picture was last moved to

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """A recording has no start to choose; its arrows, enter and esc are not the pane's."""
        if action in ("move", "choose", "cancel"):
            live = self.source is not None and self.source.kind == "LIVE"
            return live and (action == "move" or self.crosshair is not None or self.aiming)
        return True

    def action_move(self, right: int, down: int) -> None:
        """Move the crosshair by dots; at the edge the picture moves."""
        if self.source is None or not self.drawable:
            return
        viewport = self.viewport
        here = self.crosshair or self.aim or State(self.source.scene.theta, self.source.scene.omega)
        x, y = float(viewport.x(here.theta)), float(viewport.y(here.omega))
        if not (0 <= x < 2 * viewport.columns and 0 <= y < 4 * viewport.rows):
            x, y = viewport.middle
        x, y = x + right, y + down
        self.crosshair = viewport.at(x, y)
        over = min(x - 1, 0) + max(x - 2 * viewport.columns + 1, 0), min(y - 1, 0) + max(y - 4 * viewport.rows + 1, 0)
        if any(over) and not (self.wrap and self.zoomed is None and over[1] == 0):
            self.zoomed = viewport.panned(-over[0], -over[1])
        self.draw()

    def action_choose(self) -> None:
        """Start at the crosshair."""
        if self.crosshair is not None:
            chosen, self.crosshair = self.crosshair, None
            self._start_at(chosen)

    def _start_at(self, state: State) -> None:
        """Ask for a run from here with the step size in force."""
        assert self.source is not None
        try:
            scene = self.source.scene.altered(theta=state.theta, omega=state.omega, h=self.source.stepping.smallest)
        except SceneError as error:  # far out, omega may be no pendulum's
            self.notify(str(error), severity="warning")
        else:
            self.post_message(SceneChosen(scene))
        self.draw()

    def action_cancel(self) -> None:
        """Leave the crosshair, or a drag."""
        self.crosshair, self.aiming = None, False
        self.draw()

    def action_zoom(self, factor: float) -> None:
        """Zoom at the crosshair, which comes to the middle, or at the pointer, or else at the middle."""
        middle = self.viewport.middle
        if self.crosshair is not None:
            x, y = self.viewport.x(self.crosshair.theta), self.viewport.y(self.crosshair.omega)
            self.zoomed = self.viewport.panned(middle[0] - float(x), middle[1] - float(y))
        elif self.pointer is not None:
            middle = 2 * self.pointer[0] + 1, 4 * self.pointer[1] + 2
        self._zoom(factor, *middle)

    def action_whole(self) -> None:
        """Show the whole portrait."""
        self.zoomed = None
        self.draw()

    def action_wrap(self) -> None:
        """Show angles within a turn, or where they are."""
        self.wrap = not self.wrap

    def action_radius(self, direction: int) -> None:
        """Take the next larger ring, or the next smaller one; the ends are joined by none."""
        radii = (None, *RADII)
        self.radius = radii[(radii.index(self.radius) + direction) % len(radii)]

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Begin to choose a start or, with a modifier or another button, to move the picture."""
        if (cell := self._cell(event)) is None:
            return
        self.focus(scroll_visible=False)
        self.capture_mouse()
        if event.button != 1 or event.shift or event.ctrl or event.meta:
            self._panning = cell
        elif self.source is not None and self.source.kind == "LIVE":
            self.crosshair, self.pointer, self.aiming = None, cell, True
            self.draw()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Say what is under the pointer; choose, or move the picture."""
        held = self.aiming or self._panning is not None
        self.pointer = self._cell(event, clamp=held)
        if self._panning is not None and self.pointer is not None:
            right, down = self.pointer[0] - self._panning[0], self.pointer[1] - self._panning[1]
            self._panning, self.zoomed = self.pointer, self.viewport.panned(2 * right, 4 * down)
        if held:
            self.draw()
        else:
            self.tell()

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Choose the start under the pointer, or stop moving the picture."""
        self.release_mouse()
        self._panning = None
        if self.aiming:
            self.aiming = False
            cell = self._cell(event, clamp=True)
            assert cell is not None
            self._start_at(self.viewport.at_cell(*cell))

    def on_leave(self) -> None:
        """Nothing is under the pointer any more."""
        if not self.aiming:
            self.pointer = None
            self.tell()

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        """Zoom in at the pointer."""
        self._wheel(event, 0.8)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        """Zoom out from the pointer."""
        self._wheel(event, 1.25)

    def _wheel(self, event: events.MouseEvent, factor: float) -> None:
        if (cell := self._cell(event)) is not None:
            self._zoom(factor, 2 * cell[0] + 1, 4 * cell[1] + 2)
            event.stop()

    def _zoom(self, factor: float, x: float, y: float) -> None:
        self.zoomed = self.viewport.zoomed(factor, x, y)
        self.draw()

    def _cell(self, event: events.MouseEvent, clamp: bool = False) -> tuple[int, int] | None:
        """The plot's cell under the pointer, or the nearest."""
        x, y = event.get_content_offset_capture(self)
        columns, rows = self.cells
        nearest = min(max(x, 0), columns - 1), min(max(y, 0), rows - 1)
        return nearest if clamp or nearest == (x, y) else None
