"""The command line, from the arguments to what is printed.

`dispatch` finds the command and its parser.  `options` has the options that several commands share, `scene` those
that describe a scene, `scene_file` a scene in a file, and `cast` those that choose its methods.  `fail_if` reads the
expression of --fail-if, `columns` those of foreign tables, whose names `heads` finds; `objects` are tables in another
form than text in rows.  `report` prints the result of a command as a table,
JSON or CSV, `output` sentences, pictures and progress, and `junit` writes checks as XML.  `files` writes whole files
and takes requests to stop, `install` advises on optional packages, and `errors` makes one sentence and an exit code of
whatever goes wrong.
"""

from tui.cli.dispatch import main

__all__ = ["main"]
