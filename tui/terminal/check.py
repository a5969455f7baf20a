"""Whether the lab can be shown on this terminal, and whether the terminal is there and keeps up."""

import os
import sys
from typing import Any

from tui.cli.errors import Exit, UserError


def check_terminal() -> None:
    """Raise UserError unless the lab can be shown: Textual itself would print garbage."""
    if not all(
        stream is not None and stream.isatty()
        for stream in (sys.__stdin__, sys.__stdout__, sys.__stderr__)
    ):
        raise UserError(
            "not a terminal: the lab is interactive. Use pendu-tui run, or --plain.",
            Exit.TERMINAL_UNSUITABLE,
        )
    term = os.environ.get("TERM", "")
    if term in ("", "dumb", "unknown"):
        raise UserError(
            f"the terminal (TERM={term}) cannot move its cursor: set TERM correctly, e.g. xterm-256color.",
            Exit.TERMINAL_UNSUITABLE,
        )


def is_gone() -> bool:
    """Whether the terminal has been closed: writing to it fails then, or blocks for ever."""
    try:
        os.get_terminal_size(0)
    except OSError:
        return True
    return False


def is_writing(app: Any) -> bool:
    """Return whether frames still wait to be written: on a slow line, another adds only delay.

    Textual queues 30 of them, some seconds at 64 KiB/s.  Where it has no such queue the answer is no.
    """
    writer = getattr(app._driver, "_writer_thread", None)
    queue = getattr(writer, "_queue", None)
    return queue is not None and not queue.empty()
