"""Whether a terminal can show the lab, still exists, and keeps up."""

import os
import re
import select
import sys
import time
from typing import Any, Literal

from pendu_tui.recordings.system import environment, key_by_key
from pendu_tui.tui.cli.errors import Exit, UserError


def check_terminal() -> None:
    """Raise UserError unless the lab can be shown; Textual would print garbage."""
    if not all(stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr)):
        why = "not a terminal: the lab is interactive. Use pendu-tui run, or --plain."
        raise UserError(why, Exit.TERMINAL_UNSUITABLE)
    term = environment().get("TERM", "")
    if term in ("", "dumb", "unknown"):
        why = f"the terminal (TERM={term}) cannot move its cursor: set TERM correctly, e.g."
        raise UserError(f"{why} xterm-256color.", Exit.TERMINAL_UNSUITABLE)


def is_writing(app: Any) -> bool:
    """Return whether frames still wait to be written; on a slow line more would only add delay.

    Textual queues 30 of them, some seconds at 64 KiB/s.  Returns False where it has no queue.
    """
    writer = getattr(app._driver, "_writer_thread", None)
    queue = getattr(writer, "_queue", None)
    return queue is not None and not queue.empty()


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
        if can_wait:
            os.write(sys.__stderr__.fileno(), b"\x1b]11;?\x1b\\\x1b[c")
        while can_wait and not re.search(rb"\x1b\[\?[\d;]*c", reply):
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
