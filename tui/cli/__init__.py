"""The command line, from the arguments to what is printed.

`dispatch` finds the command and its parser; `options`, `scene`, `cast` and `workers` have the
options that several commands share, and `checks` has --fail-if and --junit.  `columns` reads
foreign tables, and `report` is whatever is printed.  `files` writes whole files, `time_limit`
bounds a user's own methods, `install` advises on packages, and `errors`
makes one sentence and an exit code of whatever goes wrong.
"""

from tui.cli.dispatch import main

__all__ = ["main"]
