"""The command line: `dispatch` finds the command; `options`, `output`, `errors`, `files` and `fail_if` serve all of them."""

from tui.cli.dispatch import main

__all__ = ["main"]
