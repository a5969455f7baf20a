"""CellWidget: a widget made of rows of characters with owners.  Only rows that changed are sent to the terminal."""

from collections.abc import Sequence
from itertools import zip_longest

import numpy as np
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region, Size
from textual.strip import Strip
from textual.widget import Widget

from tui.drawing.canvas import Picture
from tui.drawing.palette import NOBODY, palette

Row = Sequence[tuple[str, int | Style]]
"""Words next to each other, and whose they are; or how they look, where that is not an owner's colour."""

PRESENT = "-present"
"""The app's class where pictures have thick lines."""


def _grown(bits: int) -> int:
    """The dots of a braille cell, each as wide as the cell and two rows high."""
    rows = (0x09, 0x12, 0x24, 0xC0)  # two dots each, from the top
    neighbours = (*rows[1:], rows[2])
    return sum({dots for row, other in zip(rows, neighbours, strict=True) if bits & row for dots in (row, other)})


_THICK = np.array([0x2800 + _grown(bits) for bits in range(256)], np.uint32)


def thick(picture: Picture) -> Picture:
    """The picture with thick lines; words stay as they are."""
    codes = picture.characters
    return Picture(np.where(codes & ~np.uint32(0xFF) == 0x2800, _THICK[codes & 0xFF], codes), picture.owners)


def changed_rows(before: Picture | None, after: Picture) -> list[int]:
    """The rows that differ; all of them where there is nothing to compare with."""
    if before is None or before.characters.shape != after.characters.shape:
        return list(range(len(after.characters)))
    changed = (before.characters != after.characters) | (before.owners != after.owners)
    return np.flatnonzero(changed.any(axis=1)).tolist()


class CellWidget(Widget):
    """Shows rows or a picture; what is missing is blank, what is too long is cut off."""

    ALLOW_SELECT = False

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._rows: list[Row] = []
        self._picture: Picture | None = None
        self._styles: dict[int | Style, Style] = {}
        self._visible = False
        self.room = Size()  # asking Textual how large a widget is walks through the screen; and may change any time

    @property
    def drawable(self) -> bool:
        """Whether there is anything to draw on: on screen and not empty."""
        return self._visible and bool(self.room)

    def draw(self) -> None:
        """Bring what is shown up to date."""

    def on_resize(self) -> None:
        self._fit()

    def on_show(self) -> None:
        self._visible = True
        self._fit()

    def _fit(self) -> None:
        if self.room != self.size:
            self.room = self.size
            self.refresh()  # Textual may have painted it already, in the room that it had before
        self.draw()

    def on_hide(self) -> None:
        self._visible = False

    def show(self, rows: Sequence[Row], at_once: int | None = None) -> bool:
        """Show these rows, or so many of those that changed; whether that was all."""
        changed = [y for y, (old, new) in enumerate(zip_longest(self._rows, rows)) if old != new]
        wait = [] if at_once is None else [y for y in changed if y < len(rows)][at_once:]
        before = [*self._rows, *[()] * len(rows)]
        self._rows, self._picture = [before[y] if y in wait else row for y, row in enumerate(rows)], None
        self._refresh_rows([y for y in changed if y not in wait])
        return not wait

    def show_picture(self, picture: Picture) -> None:
        if self.app.has_class(PRESENT):
            picture = thick(picture)
        changed, self._picture = changed_rows(self._picture, picture), picture
        self._rows[len(picture.characters) :] = [()] * (len(picture.characters) - len(self._rows))
        for y in changed:
            self._rows[y] = picture.row(y)
        self._refresh_rows(changed)

    def _refresh_rows(self, changed: Sequence[int]) -> None:
        if changed:
            self.refresh(*(Region(0, y, self.room.width, 1) for y in changed))

    @property
    def text(self) -> str:
        """What is shown, without colours."""
        return "\n".join("".join(text for text, _ in row).rstrip() for row in self._rows)

    def render_line(self, y: int) -> Strip:
        row = self._rows[y] if y < len(self._rows) else ()
        strip = Strip([Segment(text, self._style(owner)) for text, owner in row])
        return strip.adjust_cell_length(self.room.width, self._style(NOBODY))

    def style_of(self, owner: int, base: Style) -> Style:
        """How an owner's characters look; `base` is the widget's own style."""
        return base if owner == NOBODY else base + Style(color=palette(self.app.theme).colour(owner))

    def notify_style_update(self) -> None:
        """Forget styles that the theme or the sheet has changed."""
        super().notify_style_update()
        self._styles = {}

    def _style(self, owner: int | Style) -> Style:
        style = self._styles.get(owner)
        if style is None:  # walking the sheet's chain is slow
            base = self.rich_style
            style = base + owner if isinstance(owner, Style) else self.style_of(owner, base)
            self._styles[owner] = style
        return style
