"""Braille to half blocks or ASCII, for terminals without it."""

import unicodedata

from rich.cells import cell_len
from rich.segment import Segment
from textual.color import Color
from textual.filter import LineFilter

from tui.terminal.options import CharacterSet

# the dots of a cell, in Unicode's order
_UPPER = 0x01 | 0x08 | 0x02 | 0x10
_LOWER = 0x04 | 0x20 | 0x40 | 0x80


def _braille(blank_upper_lower_both: str) -> dict[int, str]:
    return {
        0x2800 + bits: blank_upper_lower_both[bool(bits & _UPPER) + 2 * bool(bits & _LOWER)]
        for bits in range(256)
    }


_LIKE = {
    "-": "─━╺╸–−▔",
    "|": "│┃╹╻┊▏▎▌▐▊▕",
    "+": "┌┐└┘├┤┬┴┼┿╋┏┓┗┛┣┫┻╭╮╰╯╴▛▜▙▟",
    "#": "█",
    "'": "▀",
    ".": "▄▁·…",
    "x": "×",
    "/": "╱",
    "u": "µ",
    "o": "°•",
    "~": "±",
    "V": "√",
    "_": "½",
}


class _Ascii(dict[int, str]):
    """A table for str.translate; a character without a likeness becomes question marks."""

    def __missing__(self, code: int) -> str:
        character = chr(code)
        plain = unicodedata.normalize("NFKD", character)[0]
        self[code] = (
            plain if plain.isascii() and cell_len(character) == 1 else "?" * cell_len(character)
        )
        return self[code]


class CharacterSetFilter(LineFilter):
    """Replaces the characters that the terminal does not have."""

    def __init__(self, character_set: CharacterSet) -> None:
        super().__init__(enabled=character_set != "braille")
        self._table: dict[int, str] = _braille(" ▀▄█")
        if character_set == "ascii":
            self._table = _Ascii(_braille(" '.:"))
            self._table.update(
                (ord(character), like) for like, those in _LIKE.items() for character in those
            )

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        table = self._table
        return [Segment(text.translate(table), style, control) for text, style, control in segments]
