"""The subcommands, one module each; only the chosen one is imported.

A module has a docstring and `EXAMPLES`, which --help shows above and below the options;
`add_options(parser)`; and `run(options) -> int`, which returns the exit code or raises UserError.
It imports Textual, NumPy or Rich no earlier than in `run`.  COMMANDS in tui/cli/dispatch.py lists
its name and a line about it.
"""
