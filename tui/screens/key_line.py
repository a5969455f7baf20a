"""KeyLine: the keys that are needed now, each also a button."""

from collections.abc import Iterable, Sequence
from itertools import groupby

from rich.cells import cell_len
from textual import events
from textual.app import App
from textual.binding import ActiveBinding
from textual.screen import Screen

from tui.drawing.cells import CellWidget
from tui.drawing.palette import QUIET, TEXT
from tui.drawing.picture import Picture, Row
from tui.screens.help import key_text


def footer(active: Iterable[ActiveBinding], order: Sequence[str]) -> list[ActiveBinding]:
    """Return the bindings that are shown, one an action, as the hints of `order`; the rest last.

    The bindings of a focused pane come where `order` has "".
    """
    by_action: dict[str, ActiveBinding] = {}
    for each in active:
        if each.binding.show and each.enabled:
            by_action.setdefault(each.binding.action, each)

    def place(each: ActiveBinding) -> int:
        hint = each.binding.description if isinstance(each.node, (Screen, App)) else ""
        return order.index(hint) if hint in order else len(order)

    return sorted(by_action.values(), key=place)


def key_row(
    bindings: Sequence[ActiveBinding], width: int
) -> tuple[Row, list[tuple[int, int, str]]]:
    """Return the line, and (first column, end, key) of each key that fits.

    Grouped keys share a hint.
    """
    row: list[tuple[str, int]] = []
    places: list[tuple[int, int, str]] = []
    column = 0
    for _, members in groupby(bindings, key=lambda each: each.binding.group or each.binding):
        keys = [each.binding for each in members]
        hint = f"{keys[0].description} "
        texts = [f" {key_text(key)}" for key in keys]
        if column + sum(map(cell_len, texts)) + 1 + cell_len(hint) > width:
            continue
        for binding, text in zip(keys, texts, strict=True):
            end = column + cell_len(text)
            places.append((column, end, binding.key))
            column = end
        row += [("".join(texts) + " ", TEXT), (hint, QUIET)]
        column += 1 + cell_len(hint)
        first, _, key = places[-1]
        places[-1] = (first, column, key)
    return row, places


class KeyLine(CellWidget):
    """The line; a click on a key presses it."""

    def __init__(self, order: Sequence[str]) -> None:
        """`order`: the hints of the screen's keys, the most important first."""
        super().__init__()
        self._order = order
        self._places: list[tuple[int, int, str]] = []

    def on_mount(self) -> None:
        self.screen.bindings_updated_signal.subscribe(self, lambda _: self.draw())

    def draw(self) -> None:
        if self.drawable and self.screen.is_current:
            bindings = footer(self.screen.active_bindings.values(), self._order)
            row, self._places = key_row(bindings, self.room.width)
            self.show(Picture([row]))

    def on_click(self, event: events.Click) -> None:
        for first, end, key in self._places:
            if first <= event.x < end:
                self.app.simulate_key(key)
