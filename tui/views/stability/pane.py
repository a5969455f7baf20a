"""StabilityPane: the map of stability, to choose h and amplitude from with the mouse or the keyboard."""

from typing import ClassVar

from textual import events
from textual.binding import BindingType

from tui.views.keys import Key, bindings
from tui.views.messages import SceneChosen
from tui.views.stability.display import StabilityDisplay
from tui.views.stability.picture import MARGIN, place_at

BIG_STEP = 5  # cells of the map

_GROUP = "stability"
KEYS = (
    Key("left", "arrows", "cursor, to choose h and amplitude", "move(-1, 0)", _GROUP),
    Key("right", "", "", "move(1, 0)", _GROUP),
    Key("up", "", "", "move(0, 1)", _GROUP),
    Key("down", "", "", "move(0, -1)", _GROUP),
    Key("shift+left", "shift+arrows", "cursor in big steps", f"move({-BIG_STEP}, 0)", _GROUP),
    Key("shift+right", "", "", f"move({BIG_STEP}, 0)", _GROUP),
    Key("shift+up", "", "", f"move(0, {BIG_STEP})", _GROUP),
    Key("shift+down", "", "", f"move(0, {-BIG_STEP})", _GROUP),
    Key("enter", "enter", "start with the cursor's h and amplitude", "choose", _GROUP),
    Key("tab", "tab", "the next method in words", "next_method", _GROUP),
    Key("escape", "esc", "leave the cursor", "cancel", _GROUP),
    Key("", "click", "start with that h and amplitude", "", _GROUP),
)


class StabilityPane(StabilityDisplay):
    """A click, or Enter at the cursor, starts a run at rest; the pointer and the cursor say what is there."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(*KEYS)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """A recording has no start to choose; its arrows, enter and esc are not the pane's."""
        if action in ("move", "choose", "cancel"):
            return self._is_live and (action == "move" or self.cursor is not None)
        return True

    def action_move(self, right: int, up: int) -> None:
        """Move the cursor by cells of the map."""
        z, theta = self.aim(self.index) or (0, 0)
        self.cursor = min(max(z + right, 0), len(self.grid.z) - 1), min(max(theta + up, 0), len(self.grid.theta) - 1)
        self.draw()

    def action_choose(self) -> None:
        """Start with the cursor's h and amplitude."""
        if self.cursor is not None:
            chosen, self.cursor = self.cursor, None
            self._choose(*chosen)

    def action_cancel(self) -> None:
        """Leave the cursor."""
        self.cursor = None
        self.draw()

    def action_next_method(self) -> None:
        """Speak of the next method that is shown."""
        shown = self.shown.indices
        self.index = next((index for index in shown if index > self.index), shown[0] if shown else 0)
        self.tell()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Say what is under the pointer."""
        if (under := self._under(event)) != self.pointer:
            self.pointer = under
            self.tell()

    def on_leave(self) -> None:
        """Nothing is under the pointer any more."""
        self.pointer = None
        self.tell()

    def on_click(self, event: events.Click) -> None:
        """Start with what was clicked on."""
        if (under := self._under(event)) is not None and self._is_live:
            self.cursor = None
            self._choose(*under)

    @property
    def _is_live(self) -> bool:
        return self.source is not None and self.source.kind == "LIVE"

    def _choose(self, z: int, theta: int) -> None:
        assert self.source is not None
        scene, h = self.source.scene, float(self.grid.z[z]) / self.source.scene.w0
        self.post_message(SceneChosen(scene.altered(theta=float(self.grid.theta[theta]), omega=0.0, h=h)))

    def _under(self, event: events.MouseEvent) -> tuple[int, int] | None:
        """The map's cell under the pointer; its method is the one spoken of from now on."""
        columns, rows = self.panel_size()
        x, y = event.get_content_offset_capture(self)
        across, column = divmod(x, columns + 2)
        down, row = divmod(y, rows + 2)
        number, shown = 2 * down + across, self.shown.indices
        if not (across in (0, 1) and MARGIN <= column < columns and 1 <= row <= rows and 0 <= number < len(shown)):
            return None
        self.index = shown[number]
        return place_at(self.grid, row - 1, column - MARGIN, rows, columns - MARGIN)
