"""The subcommands, one module each.

A module `tui.commands.NAME` has
- a docstring, which --help shows, and `EXAMPLES`, which --help shows below the options;
- `add_options(parser)`, which adds its options;
- `run(options) -> int`, which does it and returns the exit code, or raises UserError.
Its name and one line about it stand in COMMANDS in tui/cli/dispatch.py.  Only the chosen module is imported,
and a module imports Textual, NumPy or Rich no earlier than in `run`.
"""
