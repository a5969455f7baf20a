"""The command line, from the arguments to what is printed.

`dispatch` finds the command and its parser; `options`, `scene`, `cast`, `workers` and `junit` have
the options that several commands share, and `fail_if` reads the expression of --fail-if.  `columns`
reads foreign tables, `report` prints the result of a command, `output` all else.  `files` writes
whole files, `time_limit` bounds a user's own methods, `install` advises on packages, and `errors`
makes one sentence and an exit code of whatever goes wrong.
"""

from tui.cli.dispatch import main

__all__ = ["main"]
