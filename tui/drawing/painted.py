"""Painted: the rows of a widget as Textual has been given them, of which only those that change are made anew."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from rich.segment import Segment
from rich.style import Style
from textual.color import Color
from textual.filter import ANSIToTruecolor, DimFilter, LineFilter, Monochrome, NoColor
from textual.geometry import Region, Spacing
from textual.strip import Strip

_NO_GUTTER, _BLACK = Spacing(), Color(0, 0, 0)
_OF_STYLES = (ANSIToTruecolor, DimFilter, Monochrome, NoColor)  # Textual's: they leave the characters alone


class _Looks(dict[Style, Style]):
    """Styles as they leave Textual's filters, which would look at every word anew."""

    def __init__(self, filters: Sequence[LineFilter], background: Color) -> None:
        super().__init__()
        self._filters, self._background = filters, background

    def __missing__(self, style: Style) -> Style:
        row = [Segment(" ", style)]
        for one in self._filters:
            row = one.apply(row, self._background)
        self[style] = look = row[0].style or style
        return look


class Line(Strip):
    """A row that is freed when it is replaced.  A Strip cut at its own width keeps itself in its cache."""

    __slots__ = ()

    def divide(self, cuts: Iterable[int]) -> Sequence[Strip]:
        """Cut at these columns."""
        cuts = [*cuts]
        return [self] if cuts == [self.cell_length] else super().divide(cuts)


@dataclass(slots=True)
class Painted:
    """What Textual has been given: lines from border to border, as they leave its filters."""

    lines: list[Strip] = field(default_factory=list)
    crop: Region | None = None
    gutter: Spacing = _NO_GUTTER
    background: Color = _BLACK
    filters: Sequence[LineFilter] = ()
    looks: _Looks = field(init=False)
    stale: set[int] = field(default_factory=set)  # rows that have changed since
    left: list[Segment] = field(default_factory=list)  # the border, the same on every row
    right: list[Segment] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.looks = _Looks([one for one in self.filters if isinstance(one, _OF_STYLES)], self.background)
        self.filters = [one for one in self.filters if not isinstance(one, _OF_STYLES)]
        if self.crop is not None:
            line, width = self.lines[self.gutter.top], self.crop.width
            self.left, self.right = [*line.crop(0, self.gutter.left)], [*line.crop(width - self.gutter.right, width)]

    def replace(self, y: int, pieces: Sequence[tuple[str, Style]]) -> None:
        """Put a row between its borders."""
        assert self.crop is not None
        looks = self.looks
        row = [Segment(text, looks[style]) for text, style in pieces]
        for one in self.filters:
            row = one.apply(row, self.background)
        self.lines[self.gutter.top + y] = Line([*self.left, *row, *self.right], self.crop.width)
