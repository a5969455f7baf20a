"""The subcommands, one module each; only the chosen one is imported.

A module holds `run(options) -> int`, which returns the exit code or raises UserError.  COMMANDS in
tui/cli/commands.py names the options of each, `options` has them in one table.
"""
