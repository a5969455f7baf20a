"""A report: the result of a command as a table, JSON or CSV, all from the same rows."""

import argparse
import csv
import json
import math
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TextIO

from engine.methods import Method
from recordings.errors import printable
from recordings.files import is_stream
from tui.cli.files import text_file
from tui.cli.options import add_file
from tui.cli.output import draw, print_lines

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table as RichTable

Form = Literal["table", "json", "csv"]
MAX_CELL = 1000  # characters


class Column(NamedTuple):
    """A column of a table: its head, and how the cell of a row is written."""

    head: str
    cell: str | Callable[[Any], Any]  # the name of a field, or a function of the row
    form: str | Callable[[Any], str] = ""  # how a value is written; if given, aligned right
    right: bool = False

    def text(self, row: Any) -> str:
        """Return the cell of a row; a dash where there is no value."""
        value = row[self.cell] if isinstance(self.cell, str) else self.cell(row)
        if value is None:
            return "-"
        text = format(value, self.form) if isinstance(self.form, str) else self.form(value)
        return printable(text, MAX_CELL)  # no text may steer the terminal


def method_column(cast: Sequence[Method]) -> Column:
    """Return the column of the labels of methods, whose keys the rows have."""
    labels = {method.key: method.label for method in cast}
    return Column("method", lambda row: labels[row["method"]])


@dataclass(frozen=True, slots=True)
class Table:
    """Rows in columns, folded to the terminal's width; a text is the head of the rows below."""

    columns: Sequence[Column]
    rows: Iterable[Any]

    def __rich__(self) -> "RichTable":
        from rich.table import Table as RichTable

        headed = any(column.head for column in self.columns)
        table = RichTable(box=None, pad_edge=False, header_style="bold", show_header=headed)
        for number, column in enumerate(self.columns):
            side: Literal["left", "right"] = "right" if column.right or column.form else "left"
            table.add_column(column.head, justify=side, overflow="fold", no_wrap=number == 0)
        for row in self.rows:
            cells = [row] if isinstance(row, str) else [each.text(row) for each in self.columns]
            table.add_row(*cells)
        return table


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """The result of a command.

    The table shows `rows` in `columns`, below `title` and above `notes`.  JSON is the one object of
    `fields`; CSV has a line for each of `records`, which are the rows by default.
    """

    name: str  # of the schema
    version: int = 1
    title: str = ""
    columns: Sequence[Column] = ()
    rows: Sequence[Any] = ()
    fields: Mapping[str, Any]
    records: Iterable[Mapping[str, Any]] | None = None
    notes: Sequence["str | Table | RenderableType"] = ()

    def show(self, form: Form = "table", out: TextIO | None = None) -> None:
        """Print the report on `out`, by default stdout.

        Raises ValueError for JSON of nan or inf.
        """
        if form == "json":
            schema = f"pendu.{self.name}/{self.version}"
            text = json.dumps({"schema": schema, **self.fields}, indent=2, allow_nan=False)
            print(text, file=out)
            return
        if form == "csv":
            write_records(self.rows if self.records is None else self.records, out or sys.stdout)
            return
        table = [Table(self.columns, self.rows)] if self.columns else []
        for part in (*([self.title] if self.title else []), *table, *self.notes):
            if isinstance(part, str):
                print_lines(part)
            else:
                draw(part)


def finite(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row as JSON can hold it: null for a limit that is not there."""
    return {name: None if value == math.inf else value for name, value in row.items()}


def write_records(records: Iterable[Mapping[str, Any]], out: TextIO) -> None:
    """Write CSV headed by the fields of the first record."""
    rest = iter(records)
    for first in rest:
        write_csv(out, list(first), (record.values() for record in chain([first], rest)))


def write_csv(out: TextIO, header: Sequence[str], rows: Iterable[Iterable[object]]) -> None:
    """Write rows so that every number reads back the same; None is an empty field."""
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)


def add_report_options(
    parser: argparse._ActionsContainer, *, csv: bool = False, files: Sequence[str] = ()
) -> None:
    """Add --json, --csv for rows of numbers, and -o for files with these suffixes."""
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument("--json", action="store_true", help="one JSON object, SI units")
    if csv:
        forms.add_argument("--csv", action="store_true", help="a line of CSV for each row")
    if files:
        names = "|".join(files)
        what = f"write FILE, in the form of its suffix: {', '.join(files)}"
        add_file(forms, "-o", "--output", metavar=f"FILE{names}", type=file_type(files), help=what)
        parser.add_argument("--force", action="store_true", help="overwrite FILE")


def file_type(suffixes: Sequence[str]) -> Callable[[str], Path]:
    """Return a reader of the name of a file with one of these suffixes, or of a device or pipe."""

    def read(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in suffixes and not is_stream(path):
            named = " or ".join(f"{path.stem}{suffix}" for suffix in suffixes)
            raise argparse.ArgumentTypeError(f"{text!r} has another suffix; use {named}")
        return path

    return read


def form_of(options: argparse.Namespace) -> Form:
    """Return the form that the options ask for."""
    if options.json:
        return "json"
    return "csv" if getattr(options, "csv", False) else "table"


def publish(report: Report, options: argparse.Namespace) -> None:
    """Print the report as the options ask, or write it to their file in the form of its suffix."""
    path: Path | None = getattr(options, "output", None)
    if path is None:
        report.show(form_of(options))
        return
    with text_file(path, options.force) as out:
        report.show("json" if path.suffix.lower() == ".json" else "csv", out)
