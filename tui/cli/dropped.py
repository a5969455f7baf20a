"""Commands and options of earlier versions.  A row stays for one version."""

from collections.abc import Sequence
from itertools import takewhile

from pendu_tui.tui.cli.errors import UserError

DROPPED = {
    "keys": "pendu-tui live, and there the key ?",
    "section": "pendu-tui live, and there F3 and the key x",
    "info": "pendu-tui recordings show",
    "recover": "pendu-tui recordings recover",
    "stability --section": "pendu-tui live, and there F3 and the key x",
    "stability --starts": "pendu-tui live, and there F3 and the key x",
    "stability --map": "-o map.csv or -o map.svg; pendu-tui live draws it with F5",
    "run --junit": "the exit code, or the pytest plugin and pytest --junit-xml",
    "judge --junit": "the exit code, or the pytest plugin and pytest --junit-xml",
    "run --resume": "several lists that are shorter",
    "run --executor": "--workers N, or --dask ADDRESS for other machines",
    "stability --executor": "--workers N, or --dask ADDRESS for other machines",
    "accuracy --executor": "--workers N, or --dask ADDRESS for other machines",
    "accuracy --budget": "--target, whose table has the cost of each method",
    "accuracy --safety": "a smaller --target",
    "completion": "pendu-tui --print-completion SHELL",
    "export --format": "CSV, which DuckDB, polars and pandas read",
    "recordings prune": "rm; pendu-tui recordings lists the files, newest first",
    "diff": "pendu-tui verify, which names the first difference; or export both and compare",
    "live --ghost": "pendu-tui replay FILE; in the lab r keeps the run before it, dimmed",
}
"""What to use instead of a COMMAND, a `COMMAND SUBCOMMAND` or a `COMMAND --option`."""


def refuse_dropped(command: str, arguments: Sequence[str]) -> None:
    """Raise UserError if a command, or one of the words after it, has been dropped."""
    words = takewhile("--".__ne__, arguments)
    for name in (command, *(f"{command} {word.partition('=')[0]}" for word in words)):
        if name in DROPPED:
            raise UserError(f"{name} has been dropped; use instead: {DROPPED[name]}.")
