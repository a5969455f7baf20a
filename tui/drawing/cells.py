"""CellWidget: a widget made of rows of characters with owners.  Only rows that changed are sent to the terminal."""

import textwrap
from collections.abc import Callable, Sequence
from itertools import zip_longest
from typing import TYPE_CHECKING, Self

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region, Size
from textual.strip import Strip
from textual.widget import Widget

from tui.drawing.faults import Fault, Guarded, sentence
from tui.drawing.painted import Painted
from tui.drawing.palette import NOBODY, WARN, palette
from tui.drawing.sketch import Sketch

if TYPE_CHECKING:
    from tui.drawing.canvas import Picture  # brings NumPy, which can wait for the first paint

Row = Sequence[tuple[str, int | Style]]
"""Words next to each other, and whose they are; or how they look, where that is not an owner's colour."""


class CellWidget(Guarded, Widget):
    """Shows rows, a picture or a sketch; what is missing is blank, what is too long is cut off."""

    ALLOW_SELECT = False

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._rows: list[Row] = []
        self._picture: Picture | None = None
        self._sketch: Sketch | None = None
        self._picture_width: int | None = None  # that every row has; None: they differ
        self._styles: dict[int | Style, Style] = {}
        self._plain: set[Style] = set()  # in which a blank is nothing but a blank
        self._visible = False
        self._painted = Painted()
        self.room = Size()  # asking Textual how large a widget is walks through the screen; and may change any time

    @property
    def drawable(self) -> bool:
        """Whether there is anything to draw on: on screen and not empty."""
        return self._visible and bool(self.room)

    def draw(self) -> None:
        """Bring what is shown up to date."""

    def fail(self, error: BaseException) -> None:
        """Say so in place of what cannot be shown; what is drawn next replaces it."""
        width, height = self.room
        self._painted = Painted()
        self.show([[(line, WARN)] for line in textwrap.wrap(sentence(error), max(width, 1))[:height]])
        self.app.post_message(Fault(error, shown=self.drawable))

    def on_resize(self) -> None:
        self._fit()

    def on_show(self) -> None:
        self._visible = True
        if not self._fit():
            self.draw()

    def _fit(self) -> bool:
        """Draw in the room that there is now; whether it is another one than before."""
        if self.room == self.size:
            return False
        self.room = self.size
        self.refresh()
        self.draw()
        return True

    def on_hide(self) -> None:
        self._visible = False

    def wake(self) -> None:
        """Draw again, if on screen: Textual does not always say so of what was hidden with what is around it."""
        if self.is_on_screen:
            self.on_show()

    def show(self, rows: Sequence[Row], at_once: int | None = None) -> bool:
        """Show these rows, or so many of those that changed; whether that was all."""
        changed = [y for y, (old, new) in enumerate(zip_longest(self._rows, rows)) if old != new]
        wait = [] if at_once is None else [y for y in changed if y < len(rows)][at_once:]
        before = [*self._rows, *[()] * len(rows)]
        self._rows, self._picture = [before[y] if y in wait else row for y, row in enumerate(rows)], None
        self._sketch = self._picture_width = None
        self._refresh_rows([y for y in changed if y not in wait])
        return not wait

    def show_picture(self, picture: "Picture") -> None:
        changed, self._picture, self._sketch = picture.changed_rows(self._picture), picture, None
        self._picture_width = picture.characters.shape[1]
        self._replace_rows(changed, picture.row, len(picture.characters))

    def show_sketch(self, sketch: Sketch) -> None:
        changed, self._picture, self._sketch = sketch.changed_rows(self._sketch), None, sketch
        self._picture_width = sketch.columns
        self._replace_rows(changed, sketch.row, sketch.rows)

    def _replace_rows(self, changed: Sequence[int], row: Callable[[int], Row], count: int) -> None:
        self._rows[count:] = [()] * (count - len(self._rows))
        for y in changed:
            self._rows[y] = row(y)
        self._refresh_rows(changed)

    def _refresh_rows(self, changed: Sequence[int]) -> None:
        """Paint these anew, from border to border: Textual would have to cut the border's own cells off."""
        if changed:
            self._painted.stale.update(changed)
            gutter = self._painted.gutter
            width = self.room.width + gutter.width
            blocks: list[tuple[int, int]] = []  # rows below each other, which Textual takes apart again: first, end
            for y in changed:
                if blocks and y == blocks[-1][1]:
                    blocks[-1] = blocks[-1][0], y + 1
                else:
                    blocks.append((y, y + 1))
            self.refresh(*(Region(-gutter.left, first, width, end - first) for first, end in blocks))

    @property
    def text(self) -> str:
        """What is shown, without colours."""
        return "\n".join("".join(text for text, _ in row).rstrip() for row in self._rows)

    def refresh(self, *regions: Region, repaint: bool = True, layout: bool = False, recompose: bool = False) -> Self:
        """Paint all of it anew, or what regions there are."""
        if not regions:
            self._painted = Painted()
        return super().refresh(*regions, repaint=repaint, layout=layout, recompose=recompose)

    def render_lines(self, crop: Region) -> list[Strip]:
        """Textual's lines, border included.

        They are kept, and only rows that changed are made anew: Textual would go through the sheet for each paint.
        """
        try:
            return self._lines(crop)
        except Exception as error:
            self.call_later(self.fail, error)  # it is being painted
            return [Strip.blank(crop.width, self.rich_style)] * crop.height

    def _lines(self, crop: Region) -> list[Strip]:
        painted = self._painted
        if crop != painted.crop:
            if self.room != self.size:  # Textual paints first and says later that a widget is on screen, and how large
                self._visible = True
                self._fit()
            lines, gutter = super().render_lines(crop), self.gutter
            if self.room and self.room == self.size and crop == Region(0, 0, *(self.room + gutter.totals)):
                self._painted = Painted(lines, crop, gutter, self.background_colors[1], self.get_line_filters())
            return lines
        for y in painted.stale:
            if y < self.room.height:
                painted.replace(y, self._pieces(y))
        painted.stale.clear()
        return painted.lines

    def render_line(self, y: int) -> Strip:
        return Strip([Segment(text, style) for text, style in self._pieces(y)], self.room.width)

    def _pieces(self, y: int) -> list[tuple[str, Style]]:
        """One row, as wide as the room."""
        row = self._rows[y] if y < len(self._rows) else ()
        if self._picture_width != self.room.width:
            missing = self.room.width - sum([cell_len(text) for text, _ in row])
            if missing < 0:
                strip = Strip([Segment(text, self._style(owner)) for text, owner in row])
                return [(text, style or Style()) for text, style, _ in strip.adjust_cell_length(self.room.width)]
            row = (*row, (" " * missing, NOBODY))
        return self._joined(row) if self._picture_width is None else [(text, self._style(owner)) for text, owner in row]

    def _joined(self, row: Row) -> list[tuple[str, Style]]:
        """A row in few pieces: a blank looks the same in any colour, so it takes that of what is next to it."""
        pieces: list[tuple[str, Style]] = []
        before, look = "", self._style(NOBODY)
        for text, owner in row:
            style = self._style(owner)
            if style is not look and before:
                both_plain = style in self._plain and look in self._plain
                if both_plain and text.isspace():
                    style = look
                elif not (both_plain and before.isspace()):
                    pieces.append((before, look))
                    before = ""
            before, look = before + text, style
        return [*pieces, (before, look)] if before else pieces

    def style_of(self, owner: int, base: Style) -> Style:
        """How an owner's characters look; `base` is the widget's own style.

        In pictures and sketches only colours may differ: their rows join blanks to what is next to them.
        """
        return base if owner == NOBODY else base + Style(color=palette(self.app.theme).colour(owner))

    def notify_style_update(self) -> None:
        """Forget styles that the theme or the sheet has changed."""
        super().notify_style_update()
        self._styles, self._plain = {}, set()
        self._painted = Painted()

    def _style(self, owner: int | Style) -> Style:
        style = self._styles.get(owner)
        if style is None:  # walking the sheet's chain is slow
            base = self.rich_style
            style = base + owner if isinstance(owner, Style) else self.style_of(owner, base)
            self._styles[owner] = style
            if (style.bgcolor, style.reverse, style.underline) == (base.bgcolor, base.reverse, base.underline):
                self._plain.add(style)
        return style
