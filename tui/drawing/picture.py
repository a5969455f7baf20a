"""Picture: rows of characters with inks, ready for a screen."""

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Self

from rich.style import Style
from rich.text import Text

from pendu_tui.tui.drawing.palette import Palette

Ink = int | Style
"""The colour of a character: a number for the theme's palette, or a style of its own."""

Row = Sequence[tuple[str, Ink]]
"""Pieces of text from the left, each in one ink."""


@dataclass(frozen=True, slots=True)
class Picture:
    """Rows from the top, which may be shorter than the widget is wide."""

    rows: Sequence[Row] = ()

    @property
    def text(self) -> str:
        """The characters without colours, a line per row, without trailing blanks."""
        return "\n".join("".join(text for text, _ in row).rstrip() for row in self.rows)

    def changes(self, before: "Picture", width: int) -> Iterator[tuple[int, int, int]]:
        """Yield row, first column and number of columns of what differs in rows of this width."""
        for y, (old, new) in enumerate(zip_longest(before.rows, self.rows, fillvalue=())):
            if old != new:
                begin = _equal(old, new)
                end = width
                if _length(old) == _length(new) == width:  # no character is two columns wide
                    end = max(width - _equal(old[::-1], new[::-1]), begin + 1)
                yield y, begin, end - begin

    @classmethod
    def of_text(cls, text: str, columns: int, rows: int, ink: Ink) -> Self:
        """Wrap and centre a text; lines that do not fit are cut off."""
        lines = textwrap.wrap(text, max(columns, 1))[:rows]
        above = (rows - len(lines)) // 2
        page = [""] * above + lines + [""] * (rows - above - len(lines))
        return cls(tuple(((line.center(columns), ink),) for line in page))


def _length(row: Row) -> int:
    return sum([len(text) for text, _ in row])


def _equal(old: Row, new: Row) -> int:
    """Return the length of the pieces that both rows begin with."""
    length = 0
    for one, other in zip(old, new, strict=False):
        if one != other:
            break
        length += len(one[0])
    return length


def lines_of(picture: Picture, palette: Palette | None) -> list[Text]:
    """Return a picture's lines for the terminal; without a palette, inks have no colour."""
    lines = []
    for row in picture.rows:
        line = Text()
        for text, ink in row:
            if isinstance(ink, int):
                line.append(text, palette and palette.colour(ink))
            else:
                line.append(text, ink)
        line.rstrip()
        lines.append(line)
    return lines
