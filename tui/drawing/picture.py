"""Pictures: rows of characters in inks, and the colour of each ink in each theme.

Every character of a picture has an ink, a method's or one of those below; only here does an ink
become a colour.  Nothing depends on colour alone: methods also have a digit and a letter.
"""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import NamedTuple

from rich.style import Style
from rich.text import Text

from pendu_tui.engine.methods import Cast, Method

EXACT = -1
FRAME = -2
TEXT = -3
WARN = -4
QUIET = -5
GOOD = -6
NOBODY = -7
"""The other inks.  QUIET is for less important text; FRAME is too faint for words."""

FAINT = 64
"""Added to a method's ink it gives the fainter one of its trail."""


class Palette(NamedTuple):
    """The colours of a theme as #rrggbb, or as Rich's names of the terminal's own 16."""

    methods: tuple[str, ...]  # by ink: four classics, then six for all others
    exact: str
    frame: str
    text: str
    warn: str
    background: str
    good: str

    def colour(self, ink: int) -> str:
        """Return the colour of an ink; after ten methods the ten come again."""
        if ink >= FAINT:
            return mixed(self.colour(ink - FAINT), self.background, 0.5)
        if ink >= 0:
            return self.methods[ink % len(self.methods)]
        others = {EXACT: self.exact, QUIET: self.exact, FRAME: self.frame}
        others |= {WARN: self.warn, GOOD: self.good}
        return others.get(ink, self.text)


# Optimised for contrast and for distance in OKLab under all kinds of colour blindness, in the
# casts of the scenes: the classics are 13.3 apart at least, where red, green, yellow and blue are
# 3.5 apart.  The light theme's colours are dark enough to read on white, yet none looks black.
PALETTES = {
    "dark": Palette(
        methods=(
            *("#DF9F20", "#8888DD", "#4CE5E5", "#FBFB51"),
            *("#FF5599", "#009966", "#CC11FF", "#77BBFF", "#99DD00", "#EE3322"),
        ),
        exact="#A0A0A0",
        frame="#606468",
        text="#D8D8D8",
        warn="#FF6B6B",
        background="#121212",
        good="#7FD17F",
    ),
    "light": Palette(
        methods=(
            *("#78240C", "#A800FC", "#0C3C90", "#547800"),
            *("#C72575", "#8713E9", "#6E0F42", "#2300B4", "#752AB6", "#005ED2"),
        ),
        exact="#686868",
        frame="#84888C",
        text="#202020",
        warn="#C00000",
        background="#F4F4F4",
        good="#006B2D",
    ),
    "high-contrast": Palette(
        methods=(
            *("#EE7766", "#8888FF", "#77FFFF", "#FFDD00"),
            *("#00B0AC", "#BB8FFF", "#D48A22", "#ABE4FF", "#50CBDB", "#77C340"),
        ),
        exact="#C0C0C0",
        frame="#A0A0A0",
        text="#FFFFFF",
        warn="#FF9C9C",
        background="#000000",
        good="#9CFF9C",
    ),
    "ansi": Palette(
        methods=(
            *("bright_red", "bright_blue", "bright_cyan", "bright_yellow"),
            *("green", "blue", "red", "cyan", "yellow", "white"),
        ),
        exact="white",
        frame="bright_black",
        text="bright_white",
        warn="bright_magenta",
        background="black",
        good="bright_green",
    ),
}


def palette(theme: str) -> Palette:
    """Return the palette of a theme; for Textual's own, guess it from the name."""
    like = next((name for name in ("ansi", "light") if name in theme), "dark")
    return PALETTES.get(theme, PALETTES[like])


def inks(cast: Cast) -> tuple[int, ...]:
    """Return the inks of a cast: classics have their own, others the next free one."""
    free = itertools.count(4)
    return tuple(next(free) if method.hue is None else method.hue for method in cast)


def ink_of(method: Method, cast: Cast) -> int:
    """Return a method's ink in a cast; outside it a classic's own, or QUIET."""
    known = {each.key: ink for each, ink in zip(cast, inks(cast), strict=True)}
    return known.get(method.key, QUIET if method.hue is None else method.hue)


def faint(ink: int) -> int:
    """Return the ink of a method's trail; other inks have no fainter shade."""
    return ink + FAINT if ink >= 0 else ink


def mark(place: int, method: Method) -> str:
    """Return a method's place in the cast from 1 and its letter, as "1 e"."""
    return f"{place + 1} {method.letter}"


def mixed(colour: str, other: str, share: float) -> str:
    """Return `colour` mixed with `other`; the darker of two ANSI colours."""
    if not colour.startswith("#"):
        return colour if share < 0.2 else colour.removeprefix("bright_")
    parts = (
        round((1 - share) * int(colour[at : at + 2], 16) + share * int(other[at : at + 2], 16))
        for at in (1, 3, 5)
    )
    return "#" + "".join(f"{part:02X}" for part in parts)


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
        """Yield each row that differs, the column where an equal end begins, and its pieces.

        Rows have this width; where a character may be two columns wide, no end is equal.
        """
        for y, (old, new) in enumerate(zip_longest(before.rows, self.rows, fillvalue=())):
            if old != new:
                behind = _equal_at_end(old, new)
                front = _length(new[: len(new) - behind])
                is_whole = front + _length(new[len(new) - behind :]) == width
                if not is_whole or _length(old[: len(old) - behind]) != front:
                    behind = 0
                    front = width
                yield y, front, behind


def _length(row: Row) -> int:
    return sum([len(text) for text, _ in row])


def _equal_at_end(old: Row, new: Row) -> int:
    """Return the number of pieces that both rows end with."""
    count = 0
    for one, other in zip(reversed(old), reversed(new), strict=False):
        if one != other:
            break
        count += 1
    return count


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
