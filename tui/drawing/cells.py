"""CellWidget: a widget that shows a Picture.  Only rows that changed are sent to the terminal."""

from collections.abc import Sequence

from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region, Size
from textual.strip import Strip
from textual.widget import Widget

from tui.drawing.palette import NOBODY, palette
from tui.drawing.picture import Ink, Picture, Row


class CellWidget(Widget):
    """Shows a picture; what is missing is blank, what is too long is cut off."""

    ALLOW_SELECT = False

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._picture = Picture()
        self._styles: dict[Ink, Style] = {}
        self.room = Size()
        """Columns and rows of a picture.  Textual walks through the screen for `size`."""

    @property
    def drawable(self) -> bool:
        """Whether there is anything to draw on: on screen and not empty."""
        return bool(self.room) and self.is_on_screen

    def draw(self) -> None:
        """Bring what is shown up to date."""

    def on_resize(self) -> None:
        self.room = self.size
        self.draw()

    def on_show(self) -> None:
        self.draw()

    def show(self, picture: Picture | Sequence[Row]) -> None:
        """Show a picture in place of the one before."""
        if not isinstance(picture, Picture):  # until all callers hand over pictures
            picture = Picture(picture)
        changed = picture.changed_rows(self._picture)
        self._picture = picture
        if changed:
            self.refresh(*(Region(0, y, self.room.width, 1) for y in changed))

    @property
    def text(self) -> str:
        """What is shown, without colours."""
        return self._picture.text

    def render_line(self, y: int) -> Strip:
        rows = self._picture.rows
        row = rows[y] if y < len(rows) else ()
        strip = Strip([Segment(text, self._style(ink)) for text, ink in row])
        return strip.adjust_cell_length(self.room.width, self._style(NOBODY))

    def style_of(self, ink: int, base: Style) -> Style:
        """Return how characters in an ink look; `base` is the widget's own style."""
        return base if ink == NOBODY else base + Style(color=palette(self.app.theme).colour(ink))

    def notify_style_update(self) -> None:
        """Forget styles that the theme or the sheet has changed."""
        super().notify_style_update()
        self._styles = {}

    def _style(self, ink: Ink) -> Style:
        style = self._styles.get(ink)
        if style is None:  # walking the sheet's chain is slow
            base = self.rich_style
            style = base + ink if isinstance(ink, Style) else self.style_of(ink, base)
            self._styles[ink] = style
        return style
