"""What passes between Textual and the terminal: characters, pastes, frames that wait."""

import sys
import time
import unicodedata
from collections.abc import Iterable
from typing import Any

from rich.cells import cell_len
from rich.segment import Segment
from textual._xterm_parser import XTermParser
from textual.color import Color
from textual.filter import LineFilter
from textual.message import Message

from pendu_tui.tui.terminal.options import CharacterSet


def _braille(blank_upper_lower_both: str) -> dict[int, str]:
    """Return a replacement for each braille character, by its upper and lower dots."""
    upper = 0b00011011  # a bit for each dot, in Unicode's order
    lower = 0b11100100
    return {
        0x2800 + dots: blank_upper_lower_both[bool(dots & upper) + 2 * bool(dots & lower)]
        for dots in range(256)
    }


_LIKE = {
    "-": "─━╺╸–−▔",
    "|": "│┃╹╻▏▎▌▐▊▕",
    ":": "┊",
    "+": "┌┐└┘├┤┬┴┼┿╋┏┓┗┛┣┫┻╭╮╰╯╴▛▜▙▟",
    "#": "█",
    "'": "▀",
    ".": "▄▁·",
    ">": "…",
    "x": "×",
    "/": "╱",
    "u": "µ",
    "o": "°•",
    "~": "±",
    "V": "√",
    "_": "½",
}


class _Ascii(dict[int, str]):
    """A table for str.translate; characters without an equivalent become question marks."""

    def __missing__(self, code: int) -> str:
        width = cell_len(chr(code))
        plain = unicodedata.normalize("NFKD", chr(code))[0]
        self[code] = plain if plain.isascii() and width == 1 else "?" * width
        return self[code]


class CharacterSetFilter(LineFilter):
    """Half blocks or ASCII in place of braille, for terminals without it."""

    def __init__(self, character_set: CharacterSet) -> None:
        super().__init__(enabled=character_set != "braille")
        self._table = _braille(" ▀▄█")
        if character_set == "ascii":
            self._table = _Ascii(_braille(" '.:"))
            for like, those in _LIKE.items():
                self._table.update(str.maketrans(dict.fromkeys(those, like)))

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        table = self._table
        return [Segment(text.translate(table), style) for text, style, _ in segments]


END_OF_PASTE = "\x1b[201~"
MAX_SILENCE = 2.0  # s


class PatientParser(XTermParser):
    """A parser of what the terminal sends, in which a paste ends after two seconds of silence.

    Textual would take all keys after a paste whose end is lost for pasted text, for ever.
    """

    _heard_at = 0.0  # s

    def feed(self, data: str) -> Iterable[Message]:
        self._heard_at = time.monotonic()
        return super().feed(data)

    def tick(self) -> Iterable[Message]:
        yield from super().tick()
        if time.monotonic() > self._heard_at + MAX_SILENCE:
            yield from self.feed(END_OF_PASTE)  # which means nothing without a paste


def limit_pastes() -> None:
    """Have it read the keys in all drivers that Textual has loaded."""
    for name in ("linux_driver", "web_driver", "win32"):
        if driver := sys.modules.get(f"textual.drivers.{name}"):
            vars(driver)["XTermParser"] = PatientParser


def is_writing(app: Any) -> bool:
    """Return whether frames still wait to be written; on a slow line more would only add delay.

    Textual queues 30 of them, some seconds at 64 KiB/s.  Returns False where it has no queue.
    """
    writer = getattr(app._driver, "_writer_thread", None)
    queue = getattr(writer, "_queue", None)
    return queue is not None and not queue.empty()
