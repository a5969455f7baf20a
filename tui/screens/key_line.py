"""KeyLine: the keys that matter most, each also a button."""

from collections.abc import Sequence

from textual import events
from textual.reactive import var

from tui.drawing.cells import CellWidget
from tui.drawing.palette import QUIET, TEXT
from tui.drawing.picture import Picture, Row
from tui.views.keys import Key
from tui.views.messages import Asked


def key_row(keys: Sequence[Key], width: int) -> tuple[Row, list[tuple[int, int, str]]]:
    """The line, and (first column, end, action) of each key on it.  Keys that do not fit are left out."""
    row: list[tuple[str, int]] = []
    places, column = [], 0
    for key in keys:
        end = column + len(key.shown) + len(key.hint) + 3
        if end <= width:
            row += [(f" {key.shown} ", TEXT), (f"{key.hint} ", QUIET)]
            places.append((column, end, key.action))
            column = end
    return row, places


class KeyLine(CellWidget):
    """The line; a click on a key is as if it were pressed."""

    keys: var[Sequence[Key]] = var(())

    def __init__(self, keys: Sequence[Key]) -> None:
        super().__init__()
        self.set_reactive(KeyLine.keys, keys)
        self._places: list[tuple[int, int, str]] = []

    def watch_keys(self) -> None:
        self.draw()

    def draw(self) -> None:
        row, self._places = key_row(self.keys, self.room.width)
        self.show(Picture([row]))

    def on_click(self, event: events.Click) -> None:
        for first, end, action in self._places:
            if first <= event.x < end:
                self.post_message(Asked(action))
