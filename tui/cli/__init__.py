"""The command line: `dispatch` finds the command, `options`, `output`, `errors`, `files` and `fail_if` are what commands share."""

from tui.cli.dispatch import main

__all__ = ["main"]
