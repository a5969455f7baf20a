"""CellWidget: a widget that shows a Picture and repaints only the rows that changed."""

import re
from collections.abc import Callable
from functools import partial
from typing import Any, Self

from rich.segment import Segment
from rich.style import Style
from textual.cache import FIFOCache
from textual.filter import ANSIToTruecolor
from textual.geometry import NULL_OFFSET, Offset, Region, Size
from textual.strip import Strip
from textual.widget import Widget

from pendu_tui.tui.drawing.picture import NOBODY, Ink, Picture, palette

_NARROW = re.compile("[ -~\u2500-\u25ff\u2800-\u28ff]*").fullmatch
"""Matches text whose characters all are a column wide, sooner than Rich can tell."""
_segment: Callable[[tuple[str, Style, None]], Segment] = partial(tuple.__new__, Segment)
"""A Segment of a text, a style and no control, in a third of the time that its name takes."""


class _Line(Strip):
    """A line whose front is painted; Textual would look for its end character by character.

    Most lines last for a frame, so each of the caches is made when it is first used.
    """

    __slots__ = ("behind", "front")

    def __init__(self, segments: list[Segment], width: int, front: int, behind: int) -> None:
        self._segments = segments
        self._cell_length = width
        self._render_cache = None
        self._link_ids = None
        self._cell_count = None
        self.front = front  # columns
        self.behind = behind  # segments

    def __getattr__(self, name: str) -> Any:
        setattr(self, name, FIFOCache(4))
        return getattr(self, name)

    def crop(self, start: int, end: int | None = None) -> Strip:
        if (start, end) == (0, self.front):
            painted = self._segments[: len(self._segments) - self.behind]
            return _Line(painted, self.front, self.front, 0)
        return super().crop(start, end)


class _Styles(dict[Ink, Style]):
    """The styles of inks: walking the style sheet is slow."""

    def __init__(self, widget: "CellWidget") -> None:
        super().__init__()
        self._widget = widget

    def __missing__(self, ink: Ink) -> Style:
        base = self._widget.rich_style
        style = base + ink if isinstance(ink, Style) else self._widget.style_of(ink, base)
        self[ink] = style
        return style


class CellWidget(Widget):
    """Shows a picture, cut off or filled with blanks where it does not fit."""

    def __init__(self) -> None:
        super().__init__()
        self._picture = Picture()
        self._styles = _Styles(self)
        self._lines: list[Strip] = []  # the visible ones, with the border
        self._crop: Region | None = None  # of the lines; None if they are stale
        self._changed: dict[int, tuple[int, int]] = {}  # rows: columns, pieces behind
        self.room = Size()
        """Columns and rows of a picture.  Textual walks through the screen for `size`."""
        self._origin = NULL_OFFSET

    @property
    def drawable(self) -> bool:
        """Whether it is on screen and not empty."""
        return bool(self.room) and self.is_on_screen

    @property
    def content_offset(self) -> Offset:
        """Where the picture begins.  Textual walks through the style sheet for it."""
        return self._origin

    def draw(self) -> None:
        """Show the current state."""

    def on_show(self) -> None:
        self.draw()

    def show(self, picture: Picture) -> None:
        changes = [*picture.changes(self._picture, self.room.width)]
        self._picture = picture
        self._changed.update((y, (columns, behind)) for y, columns, behind in changes)
        if changes:
            self.refresh(*[Region(0, y, columns, 1) for y, columns, _ in changes])

    @property
    def text(self) -> str:
        return self._picture.text

    def refresh(self, *regions: Region, **options: bool) -> Self:
        if not regions:
            self._crop = None
        return super().refresh(*regions, **options)

    def render_lines(self, crop: Region) -> list[Strip]:
        """Return the visible lines; the style sheet is only consulted for the border."""
        if crop != self._crop:
            if self.room != self.size:  # the first paint comes before the first resize
                self.room = self.size
                self.draw()
            self._lines = super().render_lines(crop)
            self._crop = crop if crop == Region(0, 0, *self.outer_size) else None
            top, right, bottom, left = self.gutter
            self._origin = Offset(left, top)
            filters = self.get_line_filters()  # the palettes have true colours
            self._filters = [each for each in filters if not isinstance(each, ANSIToTruecolor)]
            self._background = self.background_colors[1]
            self._end = len(self._lines) - bottom  # `room` may still be the old one
            if self._lines:
                inside = self._lines[min(top, len(self._lines) - 1)]
                self._left = [*inside.crop(0, left)]
                self._right = [*inside.crop(crop.width - right)]
        else:
            left, top = self._origin
            for y, (columns, behind) in self._changed.items():
                if top + y < self._end:
                    segments = self._segments(y)
                    for each in self._filters:
                        segments = each.apply(segments, self._background)
                    self._lines[top + y] = _Line(
                        [*self._left, *segments, *self._right],
                        width=crop.width,
                        front=left + columns,
                        behind=behind + len(self._right),
                    )
        self._changed.clear()
        return self._lines

    def render_line(self, y: int) -> Strip:
        return Strip(self._segments(y), self.room.width)

    def _segments(self, y: int) -> list[Segment]:
        rows = self._picture.rows
        row = rows[y] if y < len(rows) else ()
        styles = self._styles
        segments = [_segment((text, styles[ink], None)) for text, ink in row]
        text = "".join([text for text, _ in row])
        if len(text) != self.room.width or not _NARROW(text):
            segments = Segment.adjust_line_length(segments, self.room.width, styles[NOBODY])
        return segments

    def style_of(self, ink: int, base: Style) -> Style:
        return base + Style(color=palette(self.app.theme).colour(ink))

    def notify_style_update(self) -> None:
        """Forget the styles of the old theme or sheet."""
        super().notify_style_update()
        self._styles.clear()
        self._crop = None
