"""The command line, from the arguments to what is printed.

`dispatch` finds the command in `commands` and runs it.  `scene`, `cast` and `workers` read options
that several commands share, `checks` reads --fail-if, `options` the values of options, and `tables`
what other programs write.  `files` writes whole files, `watchdog` interrupts a user's own
methods, and `errors` turns errors into a sentence and an exit code.
"""

from pendu_tui.tui.cli.dispatch import main

__all__ = ["main"]
