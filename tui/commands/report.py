"""What commands print or write: reports as tables, JSON, CSV or figures."""

import argparse
import math
import sys
from argparse import Namespace
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import chain, cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TextIO

from pendu_tui.engine.methods import Cast, Method
from pendu_tui.engine.models import COMMON, DEFAULT_MODEL
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.files import printable
from pendu_tui.tui.cli.errors import MAX_CELL, UserError, say
from pendu_tui.tui.cli.files import FIGURES, check_free, text_file, whole_file
from pendu_tui.tui.drawing.picture import PALETTES, inks

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.table import Table as RichTable

Form = Literal["table", "json", "csv"]


def fields_of(value: object, *names: str) -> dict[str, Any]:
    """Return some attributes by name, as in JSON."""
    return {name: getattr(value, name) for name in names}


def scene_line(scene: Scene, *more: str) -> str:
    """Return the scene's name and numbers, and `more` of its attributes."""
    names = [each.name for each in COMMON if each.name != "h"]
    numbers = fields_of(scene, *names, *more)
    model = "" if scene.model == DEFAULT_MODEL else f" ({scene.equations.equation})"
    listed = ", ".join(f"{name} {value:g}" for name, value in numbers.items())
    return f"{scene.name}{model}: {listed} (SI units)"


def console(piped_width: int | None = None) -> "Console":
    """Return a console as wide as the terminal, or `piped_width` wide without one."""
    from rich.console import Console

    width = None if sys.stdout.isatty() else piped_width
    return Console(width=width, markup=False, emoji=False, highlight=False)


class Column(NamedTuple):
    """A column of a table: its head, and how to write a row's cell."""

    head: str
    cell: str | int | Callable[[Any], Any]  # a field's name or index, or a function of the row
    form: str | Callable[[Any], str] = ""  # how to write a value; if given, aligned right
    right: bool = False

    def text(self, row: Any) -> str:
        """Return the cell of a row, a dash for None."""
        value = self.cell(row) if callable(self.cell) else row[self.cell]
        if value is None:
            return "-"
        text = format(value, self.form) if isinstance(self.form, str) else self.form(value)
        return printable(text, MAX_CELL)  # no text may steer the terminal


def method_column(cast: Sequence[Method]) -> Column:
    """Return the column of the methods' labels; rows hold their keys."""
    labels = {method.key: method.label for method in cast}
    return Column("method", lambda row: labels[row["method"]])


@dataclass(frozen=True, slots=True)
class Table:
    """Rows in columns, folded to the terminal's width; a string is a heading."""

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
            import json  # the lab needs none

            schema = f"pendu.{self.name}/{self.version}"
            text = json.dumps({"schema": schema, **self.fields}, indent=2, allow_nan=False)
            print(text, file=out)
        elif form == "csv":
            records = self.rows if self.records is None else self.records
            write_records(records, out or sys.stdout)
        else:
            self._show_table()

    def _show_table(self) -> None:
        parts: list[Any] = [self.title] if self.title else []
        if self.columns:
            parts.append(Table(self.columns, self.rows))
        for part in (*parts, *self.notes):
            if isinstance(part, str):
                say(part)
                continue
            on = console(240)
            with on.capture() as drawn:  # Rich itself would end the process at a closed pipe
                on.print(part, no_wrap=True, overflow="crop")
            print(drawn.get(), end="")


def finite(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row for JSON, with None for numbers that are not finite."""

    def is_finite(value: Any) -> bool:
        return not isinstance(value, float) or math.isfinite(value)

    return {name: value if is_finite(value) else None for name, value in row.items()}


def write_records(records: Iterable[Mapping[str, Any]], out: TextIO) -> None:
    """Write CSV with the first record's fields as the header."""
    rest = iter(records)
    for first in rest:
        write_csv(out, list(first), (record.values() for record in chain([first], rest)))


def write_csv(out: TextIO, header: Sequence[str], rows: Iterable[Iterable[object]]) -> None:
    """Write rows of CSV; every number reads back the same, and None is empty."""
    import csv  # the lab needs none

    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)


def form_of(options: argparse.Namespace) -> Form:
    """Return the form that the options or the suffix of the -o file ask for."""
    path: Path | None = getattr(options, "output", None)
    suffix = path.suffix.lower() if path else ""
    if options.json or suffix == ".json":
        return "json"
    return "csv" if path or getattr(options, "csv", False) else "table"


def publish(report: Report, options: argparse.Namespace) -> None:
    """Print the report, or write it to the -o file in the form of its suffix."""
    path: Path | None = getattr(options, "output", None)
    if path is None:
        report.show(form_of(options))
        return
    with text_file(path, options.force) as out:
        report.show(form_of(options), out)


def check_output(options: argparse.Namespace) -> bool:
    """Return whether the output is a figure.

    Raises DiskError if the name is taken, UserError without Matplotlib.
    """
    path = options.output
    if path is None:
        return False
    check_free(path, options.force)
    is_figure = path.suffix.lower() in FIGURES
    if is_figure and find_spec("matplotlib") is None:
        raise UserError(f"{path.suffix} files need an extra: pip install 'pendu-tui[plot]'.")
    return is_figure


CM = 1 / 2.54  # inches
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 2)))
STYLE = {
    "font.size": 7,
    "axes.titlesize": 7,
    "figure.labelsize": 7,
    "axes.linewidth": 0.5,
    "lines.linewidth": 0.9,
    "lines.markersize": 2.5,
    "legend.frameon": False,
    "legend.handlelength": 2.4,
    "figure.constrained_layout.use": True,
    "savefig.dpi": 600,
    "svg.fonttype": "path",  # outlines, which need no font
    "svg.hashsalt": "pendu-tui",
    "pdf.fonttype": 42,  # TrueType, which journals ask for
}
NO_DATE = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {"Software": None}}


Line = tuple[str, Any, Any]
"""The letter of a method or the name of a reference, and the numbers x and y."""


def draw(
    options: Namespace, cast: Cast, lines: Iterable[Line], labels: tuple[str, str], log: str
) -> None:
    """Draw the lines of a chart one column wide and write the -o file by Matplotlib.

    `labels` are those of x and y, `log` names the logarithmic axes: "xy", "y" or "".  Methods
    differ in colour and in line style; references are dotted.  The same input gives the same bytes.
    """
    from matplotlib import style  # an extra
    from matplotlib.figure import Figure

    colours = map(PALETTES["light"].colour, inks(cast))
    looks = {
        method.letter: {"color": colour, "linestyle": line, "label": method.label, "marker": "."}
        for method, colour, line in zip(cast, colours, cycle(LINES))
    }
    suffix = options.output.suffix.lower()
    with (
        style.context(STYLE, after_reset=True),
        whole_file(options.output, options.force) as part,
    ):
        figure = Figure((8.5 * CM, 6 * CM))  # a column of a journal
        axes = figure.add_subplot(xlabel=labels[0], ylabel=labels[1])
        axes.set(**{f"{axis}scale": "log" for axis in log})
        for mark, x, y in lines:
            reference = {"color": "grey", "linestyle": ":", "linewidth": 0.5}
            axes.plot(x, y, **looks.get(mark, reference))
        figure.legend(loc="outside upper center", ncols=2)
        figure.savefig(part, format=suffix[1:], metadata=NO_DATE[suffix])
