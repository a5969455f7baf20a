"""What the lab looks like and how it is controlled, from the command line or the terminal."""

import argparse
import codecs
import os
import re
import select
import sys
import time
from collections.abc import Mapping
from typing import Literal, NamedTuple, get_args

from pendu_tui.recordings.system import environment, key_by_key
from pendu_tui.tui.cli.errors import Exit, UserError

CharacterSet = Literal["braille", "half", "ascii"]
"""The characters of pictures; with ASCII, lines and words are ASCII, too."""

CHARACTER_SETS: tuple[CharacterSet, ...] = get_args(CharacterSet)
FPS = 30
CALM_FPS = 10
SMALLEST = (60, 16)  # columns and rows of the smallest terminal on which the lab fits
LARGEST = (400, 200)


class TerminalOptions(NamedTuple):
    theme: str = "dark"
    character_set: CharacterSet = "braille"
    mouse: bool = True
    fps: int = FPS


USUAL = TerminalOptions()


def cells(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,4})[x×](\d{1,4})", text) or ("", 0, 0)
    columns = int(match[1])
    rows = int(match[2])
    if not (SMALLEST[0] <= columns <= LARGEST[0] and SMALLEST[1] <= rows <= LARGEST[1]):
        limits = " to ".join(f"{columns}x{rows}" for columns, rows in (SMALLEST, LARGEST))
        raise ValueError(f"{text!r} is not a size; use, for example, 120x40, from {limits}")
    return columns, rows


def terminal_options_of(
    options: argparse.Namespace, environment: Mapping[str, str], encoding: str
) -> TerminalOptions:
    theme = options.theme
    if theme == "auto":
        theme = fitting_theme(environment)
    pixels = options.pixels
    if pixels == "auto":
        pixels = "braille" if is_utf8(encoding) else "ascii"
    fps = FPS
    if environment.get("TEXTUAL_ANIMATIONS", "").lower() == "none":
        fps = CALM_FPS
    return TerminalOptions(theme, pixels, mouse=not options.no_mouse, fps=options.fps or fps)


def is_utf8(encoding: str) -> bool:
    return codecs.lookup(encoding).name == "utf-8"


def fitting_theme(environment: Mapping[str, str]) -> str:
    """Return the terminal's own colours if they are few or NO_COLOR is set, else a theme.

    COLORFGBG, such as "0;15", ends with the background's number among the 16 colours: 7 and 9 to 15
    are light.
    """
    if environment.get("NO_COLOR") or colours(environment) <= 16:
        return "ansi"
    ground = environment.get("COLORFGBG", "").rpartition(";")[2]
    return "light" if ground in map(str, (7, *range(9, 16))) else "dark"


def colours(environment: Mapping[str, str]) -> int:
    """Return how many colours the terminal has, by the variables that Rich reads."""
    if environment.get("COLORTERM", "").strip().lower() in ("truecolor", "24bit"):
        return 1 << 24
    term = environment.get("TERM", "").lower()
    if term in ("", "dumb", "unknown"):
        return 0
    return 256 if term.endswith(("256color", "kitty")) else 16


def check_terminal() -> None:
    """Raise UserError unless the lab can be shown; Textual would print garbage."""
    if not all(stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr)):
        why = "not a terminal: the lab is interactive. Use pendu-tui run, or --plain."
        raise UserError(why, Exit.TERMINAL_UNSUITABLE)
    term = environment().get("TERM", "")
    if term in ("", "dumb", "unknown"):
        why = f"the terminal (TERM={term}) cannot move its cursor: set TERM correctly, e.g."
        raise UserError(f"{why} xterm-256color.", Exit.TERMINAL_UNSUITABLE)


def background() -> Literal["light", "dark"] | None:
    """Ask the terminal for its background before Textual reads from it; None if it does not tell.

    OSC 11 asks for the colour, then DA1 for attributes, which every terminal reports.  Terminals
    answer in order, so after the second answer none is left that Textual could take for keys.
    """
    assert sys.__stdin__ is not None
    assert sys.__stderr__ is not None
    keyboard = sys.__stdin__.fileno()
    reply = b""
    end = time.monotonic() + 1.0  # s; some terminals never answer
    with key_by_key(keyboard) as can_wait:
        if not can_wait:
            return None
        os.write(sys.__stderr__.fileno(), b"\x1b]11;?\x1b\\\x1b[c")
        while not re.search(rb"\x1b\[\?[\d;]*c", reply):
            left = max(0.0, end - time.monotonic())
            if not select.select([keyboard], [], [], left)[0]:
                break
            reply += os.read(keyboard, 1024)
    colour = rb"\x1b\]11;rgba?:([0-9a-fA-F]+)/([0-9a-fA-F]+)/([0-9a-fA-F]+)"
    found = re.search(colour, reply)
    if found is None:
        return None
    red, green, blue = (int(part, 16) / (16 ** len(part) - 1) for part in found.groups())
    luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue  # ITU-R BT.709
    return "light" if luminance > 0.5 else "dark"
