"""The owners of characters, and their colours in each theme.

Every character of a picture has an owner, a method or one of those below; only here does an owner become
a colour.  Colour is never alone: methods also have a digit and a letter.
"""

from typing import NamedTuple
from zlib import crc32

from engine.methods import METHODS, Method

EXACT, FRAME, TEXT, WARN, QUIET, GOOD, NOBODY = -1, -2, -3, -4, -5, -6, -7
"""Owners that are not methods (whose numbers are their `series`): exact motion, lines and borders, text, warnings,
text that matters less, what is as it should be, blanks.  FRAME is too faint for words."""

FAINT = 64
"""Added to a method's series: its fainter colour, for trails."""

_SERIES = {method.key: number for number, method in enumerate(METHODS)}


class Palette(NamedTuple):
    """The colours of a theme as #rrggbb, or as Rich's names of the terminal's own 16."""

    methods: tuple[str, ...]  # by series, which share them where there are more
    exact: str
    frame: str
    text: str
    warn: str
    background: str
    good: str

    def colour(self, owner: int) -> str:
        """The colour of an owner; a ninth method gets another shade of the first one's colour, and so on."""
        if owner >= FAINT:
            return mixed(self.colour(owner - FAINT), self.background, 0.5)
        if owner >= 0:
            lap, index = divmod(owner, len(self.methods))
            return mixed(self.methods[index], self.text, 1 - 0.6**lap)
        others = {EXACT: self.exact, FRAME: self.frame, WARN: self.warn, QUIET: self.exact, GOOD: self.good}
        return others.get(owner, self.text)


# The methods' colours are optimised for contrast and for separation under all kinds of colour blindness:
# the worst pair is 19.5 (dark), 16.0 (light) and 21.6 (high-contrast, all with 7:1) apart in OKLab, compared
# with 3.5 for red, green, yellow and blue.  The terminal's own colours are at least 14.4 apart on black in
# the palettes of xterm, VGA, Tango and Windows.  Those are the first four; the worst pair of all eight is 10.0, 9.7
# and 9.2 apart.
PALETTES = {
    "dark": Palette(
        methods=("#DF9F20", "#8888DD", "#4CE5E5", "#FBFB51", "#87B4FF", "#B4FFC3", "#F0C378", "#A5780F"),
        exact="#A0A0A0",
        frame="#606468",
        text="#D8D8D8",
        warn="#FF6B6B",
        background="#121212",
        good="#7FD17F",
    ),
    "light": Palette(
        methods=("#AE3D04", "#5139C6", "#101070", "#631D1D", "#964B96", "#3C5AFF", "#693C69", "#00002D"),
        exact="#686868",
        frame="#84888C",
        text="#202020",
        warn="#C00000",
        background="#F4F4F4",
        good="#006B2D",
    ),
    "high-contrast": Palette(
        methods=("#EE7766", "#8888FF", "#77FFFF", "#FFDD00", "#69B4F0", "#C3FFA5", "#96D2F0", "#D2B40F"),
        exact="#C0C0C0",
        frame="#A0A0A0",
        text="#FFFFFF",
        warn="#FF9C9C",
        background="#000000",
        good="#9CFF9C",
    ),
    "ansi": Palette(
        methods=("bright_red", "bright_blue", "bright_cyan", "bright_yellow"),
        exact="white",
        frame="white",
        text="bright_white",
        warn="bright_magenta",
        background="black",
        good="bright_green",
    ),
}


def palette(theme: str) -> Palette:
    """The palette of this name; for other themes, the one that suits the name best."""
    return PALETTES.get(theme) or PALETTES["ansi" if "ansi" in theme else "light" if "light" in theme else "dark"]


def faint(owner: int) -> int:
    """The owner of a method's trail; other owners have no fainter shade."""
    return owner + FAINT if owner >= 0 else owner


def series(method: Method) -> int:
    """A method's number as an owner: the same in every cast, so a method keeps its colour."""
    return _SERIES.get(method.key, len(_SERIES) + crc32(method.key.encode()) % 8)


def mark(place: int, method: Method) -> str:
    """A method's digit, which is its place in the cast from 1, and its letter, as "1 e"."""
    return f"{place + 1} {method.letter}"


def mixed(colour: str, other: str, share: float) -> str:
    """`colour` with a share of `other`; of the terminal's own colours, the darker one of the pair."""
    if not colour.startswith("#"):
        return colour if share < 0.2 else colour.removeprefix("bright_")
    parts = (
        round((1 - share) * int(colour[at : at + 2], 16) + share * int(other[at : at + 2], 16)) for at in (1, 3, 5)
    )
    return "#" + "".join(f"{part:02X}" for part in parts)
