"""What commands print: JSON, tables and progress.  Data on stdout, everything else on stderr."""

import json
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from time import monotonic
from typing import Any

from engine.scenes import Scene
from recordings.errors import printable


def write_json(name: str, fields: Mapping[str, Any]) -> None:
    """Print one object of the schema pendu.NAME/1.  Raises ValueError for a number that is not finite."""
    print(json.dumps({"schema": f"pendu.{name}/1", **fields}, allow_nan=False, indent=2))


def scene_fields(scene: Scene) -> dict[str, Any]:
    """A scene as JSON shows it, in SI units."""
    return asdict(scene)


def print_table(align: str, headers: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print a table; `align` has an l or an r for each column.  The first column is never wrapped."""
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold", show_header=any(headers))
    for side, header in zip(align, headers, strict=True):
        table.add_column(header, justify="left" if side == "l" else "right", no_wrap=not table.columns, overflow="fold")
    for row in rows:
        table.add_row(*(printable(cell, limit=1000) for cell in row))  # a file's text must not steer the terminal
    width = None if sys.stdout.isatty() else 240  # a file or a pipe has room for every column
    console = Console(width=width, markup=False, emoji=False, highlight=False)
    with console.capture() as drawn:  # or Rich ends the process when the reader of a pipe is gone
        console.print(table)
    print(drawn.get(), end="")


@contextmanager
def progress(what: str) -> Iterator[Callable[[float, float], None]]:
    """Yield a function to call with how much is done and how much there is in all.

    It shows a bar on stderr if that is a terminal and the work takes longer than a second.
    """
    began = monotonic()
    bar: Any = None

    def show(done: float, total: float) -> None:
        nonlocal bar
        if bar is None:
            if not sys.stderr.isatty() or monotonic() - began < 1:
                return
            from rich.console import Console
            from rich.progress import Progress

            bar = Progress(console=Console(stderr=True), transient=True)
            bar.add_task(what)
            bar.start()
        bar.update(0, completed=done, total=total)

    try:
        yield show
    finally:
        if bar is not None:
            bar.stop()
