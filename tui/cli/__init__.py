"""The command line, from the arguments to what is printed.

`dispatch` finds the command and its parser, `dropped` what replaces one that is gone.  `options`,
`scene`, `cast` and `workers` hold options that several commands share, `scene_file` reads TOML,
`checks` --fail-if.  `columns` reads other programs' tables, `report` prints, `files` writes whole
files, `time_limit` interrupts a user's own methods, and `errors` turns errors into a sentence and
an exit code.
"""

from pendu_tui.tui.cli.dispatch import main

__all__ = ["main"]
