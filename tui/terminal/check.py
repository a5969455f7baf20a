"""Whether the lab can be shown on this terminal, and whether the terminal is still there."""

import os
import sys

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
