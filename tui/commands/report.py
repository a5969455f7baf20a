"""What commands print or write: reports as tables, JSON, CSV or figures."""

import argparse
import csv
import json
import math
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import cycle
from operator import itemgetter
from pathlib import Path
from typing import Any, Literal, NamedTuple, TextIO

from rich.console import Console, RenderableType
from rich.table import Table as RichTable

from pendu_tui.engine.methods import Cast, Method
from pendu_tui.engine.models import COMMON, DEFAULT_MODEL
from pendu_tui.engine.scenes import Scene
from pendu_tui.recordings.files import check_target, printable
from pendu_tui.tui.cli.errors import MAX_CELL, UserError, say
from pendu_tui.tui.cli.files import FIGURES, text_file, whole_file

Form = Literal["table", "json", "csv", "figure"]

CM = 1 / 2.54  # inches
DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 2)))
STYLE = {
    "font.size": 7,
    "axes.linewidth": 0.5,
    "lines.linewidth": 0.9,
    "lines.markersize": 2.5,
    "legend.frameon": False,
    "figure.constrained_layout.use": True,
    "savefig.dpi": 600,
    "svg.fonttype": "path",  # outlines, which need no font
    "svg.hashsalt": "pendu-tui",
    "pdf.fonttype": 42,  # TrueType, which journals ask for
}
NO_DATE = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {"Software": None}}


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


class Column(NamedTuple):
    """A column of a table: its head, and how to write a row's cell."""

    head: str
    cell: str | Callable[[Any], Any]  # a field's name, or a function of the row
    form: str | Callable[[Any], str] = ""  # how to write a value; if given, aligned right

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


def limit_text(z: float, decimals: int = 9) -> str:
    """Write the largest stable z = h·w0 of the linear oscillator."""
    return {math.inf: "any", 0.0: "0"}.get(z) or f"{z:.{decimals}f}"


@dataclass(frozen=True, slots=True)
class Table:
    """Rows in columns, folded to the terminal's width; a string is a heading."""

    columns: Sequence[Column]
    rows: Iterable[Any]

    def __rich__(self) -> RichTable:
        table = RichTable(box=None, pad_edge=False, header_style="bold")
        for number, column in enumerate(self.columns):
            side: Literal["left", "right"] = "right" if column.form else "left"
            table.add_column(column.head, justify=side, overflow="fold", no_wrap=number == 0)
        for row in self.rows:
            cells = [row] if isinstance(row, str) else [each.text(row) for each in self.columns]
            table.add_row(*cells)
        return table


Line = tuple[str, Any, Any]
"""The letter of a method or the name of a reference, and the numbers x and y."""


@dataclass(frozen=True, slots=True)
class Figure:
    """A chart of lines, one column of a journal wide.

    Methods differ in colour and in line style; references are dotted.
    """

    cast: Cast
    lines: Iterable[Line]
    x_label: str
    y_label: str
    log: str  # the logarithmic axes: "xy" or "y"

    def draw(self, file: Path, suffix: str) -> None:
        """Draw the figure by Matplotlib; the same lines give the same bytes."""
        from matplotlib import figure as figures
        from matplotlib import style  # an extra

        from pendu_tui.tui.drawing.picture import PALETTES, inks

        colours = map(PALETTES["light"].colour, inks(self.cast))
        looks = {
            method.letter: {"color": ink, "linestyle": dashes, "label": method.label, "marker": "."}
            for method, ink, dashes in zip(self.cast, colours, cycle(DASHES))
        }
        reference = {"color": "grey", "linestyle": ":", "linewidth": 0.5}
        with style.context(STYLE, after_reset=True):
            figure = figures.Figure((8.5 * CM, 6 * CM))
            axes = figure.add_subplot(xlabel=self.x_label, ylabel=self.y_label)
            axes.set(**{f"{axis}scale": "log" for axis in self.log})
            for mark, x, y in self.lines:
                axes.plot(x, y, **looks.get(mark, reference))
            figure.legend(loc="outside upper center", ncols=2)
            figure.savefig(file, format=suffix[1:], metadata=NO_DATE[suffix])


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
    rows: Iterable[Any] = ()
    fields: Mapping[str, Any]
    records: Iterable[Mapping[str, Any]] | None = None
    notes: Iterable[str | Table | RenderableType] = ()
    figure: Figure | None = None

    def show(self, form: Form = "table", out: TextIO | None = None) -> None:
        """Print the report on `out`, by default stdout.

        Raises ValueError for JSON of nan or inf.
        """
        if form == "json":
            schema = f"pendu.{self.name}/{self.version}"
            text = json.dumps({"schema": schema, **self.fields}, indent=2, allow_nan=False)
            print(text, file=out)
        elif form == "csv":
            records = list(self.rows if self.records is None else self.records)
            names = list(records[0])
            write_csv(out or sys.stdout, names, map(itemgetter(*names), records))
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
            width = None if sys.stdout.isatty() else 240
            on = Console(width=width, markup=False, emoji=False, highlight=False)
            with on.capture() as drawn:  # Rich itself would end the process at a closed pipe
                on.print(part)
            print(drawn.get(), end="")


def finite(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row for JSON, with None for numbers that are not finite."""
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value
        for name, value in row.items()
    }


def write_csv(out: TextIO, header: Sequence[str], rows: Iterable[Iterable[object]]) -> None:
    """Write rows of CSV; every number reads back the same, and None is empty."""
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)


def form_of(options: argparse.Namespace) -> Form:
    """Return the form that the options or the suffix of the -o file ask for."""
    suffix = options.output.suffix.lower() if options.output else ""
    if suffix in FIGURES:
        return "figure"
    if options.json or suffix == ".json":
        return "json"
    if options.output or options.csv:
        return "csv"
    return "table"


def check_output(options: argparse.Namespace) -> Form:
    """Return the form of the output.

    Raises DiskError if the name is taken, UserError for a figure without Matplotlib.
    """
    form = form_of(options)
    if options.output:
        check_target(options.output, options.force)
    if form == "figure" and find_spec("matplotlib") is None:
        raise UserError(f"{options.output.suffix} files need an extra: install pendu-tui[plot].")
    return form


def publish(report: Report, options: argparse.Namespace) -> None:
    """Print the report, or write it to the -o file in the form of its suffix."""
    form = form_of(options)
    if form == "figure":
        assert report.figure is not None
        with whole_file(options.output, options.force) as part:
            report.figure.draw(part, options.output.suffix.lower())
    else:
        with text_file(options.output, options.force) as out:
            report.show(form, out)
