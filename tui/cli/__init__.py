"""The command line, from the arguments to what is printed.

`dispatch` finds the command and its parser.  `options` has the options that several commands share
and reads their values, `scene` has those that describe a scene, here or in a file, `cast` those
that choose its methods, and `workers` those that choose where tasks run.  `fail_if` reads the
expression of --fail-if; `junit` concludes checks and writes them as XML.  `columns` reads foreign
tables.  `report` prints the result of a command as a table, JSON or CSV, or writes it to a file;
`output` prints sentences, pictures and progress.  `files` writes whole files and takes requests to stop,
`time_limit` bounds the time of a user's own methods, `install` advises on packages, and `errors`
makes one sentence and an exit code of whatever goes wrong.
"""

from tui.cli.dispatch import main

__all__ = ["main"]
