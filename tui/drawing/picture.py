"""Picture: rows of characters with inks, ready for a screen."""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Self

from rich.style import Style

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

    def changed_rows(self, before: "Picture") -> list[int]:
        pairs = zip_longest(before.rows, self.rows)
        return [y for y, (old, new) in enumerate(pairs) if old != new]

    @classmethod
    def of_text(cls, text: str, columns: int, rows: int, ink: Ink) -> Self:
        """Wrap and centre a text; lines that do not fit are cut off."""
        lines = textwrap.wrap(text, max(columns, 1))[:rows]
        above = (rows - len(lines)) // 2
        page = [""] * above + lines + [""] * (rows - above - len(lines))
        return cls(tuple(((line.center(columns), ink),) for line in page))
