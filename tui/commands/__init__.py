"""The subcommands, one module each; only the chosen one is imported.

On screen: `live`, `replay`, and their `keys`; `snapshot` saves a picture.  Studies: `accuracy`, `stability`, which
print with `reports`.  Runs and recordings: `run`, `verify`, `info`, `recover`, `export`, `recordings`.  Lists and
help: `scenes`, `methods`, `doctor`, `completion`.

A module has a docstring and `EXAMPLES`, which --help shows above and below the options; `add_options(parser)`; and
`run(options) -> int`, which returns the exit code or raises UserError.  It imports Textual, NumPy or Rich no
earlier than in `run`.  Its name and a line about it stand in COMMANDS in tui/cli/dispatch.py.
"""
