"""KeyLine: the keys that matter most, each also a button."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from textual import events
from textual.message import Message

from tui.drawing.cells import CellWidget, Row
from tui.drawing.palette import FRAME, TEXT


class Hint(NamedTuple):
    """A key as people read it, what it does, and the action behind it."""

    key: str
    label: str
    action: str


def key_row(hints: Sequence[Hint], width: int) -> tuple[Row, list[tuple[int, int, str]]]:
    """The line, and (first column, end, action) of each hint on it.  Hints that do not fit are left out."""
    row: list[tuple[str, int]] = []
    places, column = [], 0
    for hint in hints:
        end = column + len(hint.key) + len(hint.label) + 3
        if end <= width:
            row += [(f" {hint.key} ", TEXT), (f"{hint.label} ", FRAME)]
            places.append((column, end, hint.action))
            column = end
    return row, places


class KeyLine(CellWidget):
    """The line."""

    @dataclass
    class Pressed(Message):
        """A hint was clicked."""

        action: str

    def __init__(self, hints: Sequence[Hint]) -> None:
        super().__init__()
        self._hints = hints
        self._places: list[tuple[int, int, str]] = []

    def draw(self) -> None:
        """Draw the line."""
        row, self._places = key_row(self._hints, self.room.width)
        self.show([row])

    def on_click(self, event: events.Click) -> None:
        """A click is the key's press."""
        for first, end, action in self._places:
            if first <= event.x < end:
                self.post_message(self.Pressed(action))
