"""TourPanel: the step's title with its keys, and below it what is said."""

import textwrap

from rich.style import Style

from tui.drawing.cells import CellWidget
from tui.drawing.palette import EXACT, TEXT, WARN
from tui.drawing.picture import Picture, Row
from tui.views.messages import Asked
from tui.words.tour.guide import Guide

TITLE = -10
"""The owner of the title."""


def tour_rows(title: str, keys: str, said: tuple[str, ...], width: int, height: int) -> list[Row]:
    """The title line, and the sentences each on lines of its own, the last of them in full."""
    heads = [(f" {title} ", TITLE), ("  ", TEXT), (keys[: max(width - len(title) - 4, 0)], EXACT)]
    wrapped = [textwrap.wrap(text, max(width - 2, 2)) for text in said]
    lines = [(line, TEXT if text is wrapped[-1] else EXACT) for text in wrapped for line in text]
    return [heads, *([(f" {line}", owner)] for line, owner in lines[-(height - 1) :])]


class TourPanel(CellWidget):
    """Above the key line, in place of the insight line; a click goes forward."""

    def __init__(self) -> None:
        super().__init__()
        self.guide: Guide | None = None

    def draw(self) -> None:
        if self.guide is not None and self.drawable:
            self.show(Picture(tour_rows(self.guide.title, _keys(self.guide), self.guide.said, *self.room)))

    def on_click(self) -> None:
        self.post_message(Asked("tour_forward"))

    def style_of(self, owner: int, base: Style) -> Style:
        if owner == TITLE:
            return super().style_of(WARN, base) + Style(reverse=True, bold=True)
        return super().style_of(owner, base)


def _keys(guide: Guide) -> str:
    forward = "again" if guide.is_astray else _FORWARD[guide.stage]
    return f"enter {forward}  backspace back  esc leave"


_FORWARD = {"watching": "skip", "asked": "answer", "answered": "go on"}
