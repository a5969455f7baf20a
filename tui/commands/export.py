"""Write a recording as CSV or Parquet, one row per sample and method."""

import argparse
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING

from pendu_tui.recordings.errors import printable
from pendu_tui.tui.cli.errors import Exit, UserError
from pendu_tui.tui.cli.files import text_file, whole_file
from pendu_tui.tui.cli.install import install_advice
from pendu_tui.tui.cli.options import add_file, add_recording, resolve
from pendu_tui.tui.cli.report import progress, warn, write_csv
from pendu_tui.tui.words.numbers import file_size

if TYPE_CHECKING:
    from pendu_tui.recordings.recording import Recording

EXAMPLES = """\
examples:
  pendu-tui export latest -o latest.csv
  pendu-tui export drift --format parquet -o drift.parquet
"""

Rows = Iterator[tuple[object, ...]]


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser)
    add = parser.add_argument
    add("--format", choices=("csv", "parquet"), help="default: parquet for OUT.parquet, else csv")
    where = "write to OUT instead of stdout"
    add_file(parser, "-o", "--output", metavar="OUT", type=Path, help=where)
    add("--force", action="store_true", help="overwrite OUT")


def run(options: argparse.Namespace) -> int:
    from pendu_tui.recordings.recording import Recording

    path = resolve(options.file)
    form = options.format
    if form is None and options.output and options.output.suffix.lower() == ".parquet":
        form = "parquet"
    with Recording.open(path) as recording, progress(printable(path.name)) as show:
        columns = columns_of({run.scene.model: None for run in recording.runs})
        rows = _rows(recording, show)
        if form == "parquet":
            _write_parquet(options, columns, rows)
        else:
            with text_file(options.output, options.force) as out:
                # NaN, because readers take an empty column for text
                write_csv(out, columns, (["NaN" if x is None else x for x in row] for row in rows))
        if recording.reason:
            warn(f"{printable(str(path))}: {recording.reason}; the rest is exported.")
    if options.output:
        size = file_size(options.output.stat().st_size)
        name = printable(str(options.output))
        warn(f"wrote {recording.length:g} s of {printable(path.name)}, {size}: {name}")
    return Exit.FINE


def columns_of(models: Iterable[str]) -> tuple[str, ...]:
    """Return the columns, names with units; energies are per unit m·L²."""
    from pendu_tui.recordings.fields import EXTRA, MOMENT, READING

    moment = [field.column for field in MOMENT]
    extra = dict.fromkeys(field.column for model in models for field in EXTRA[model])
    return "clock_s", *moment, "method", *(field.column for field in READING), *extra


def _rows(recording: "Recording", show: Callable[[int, int], None]) -> Rows:
    from pendu_tui.recordings.fields import EXTRA, READING

    extra = dict.fromkeys(field.name for run in recording.runs for field in EXTRA[run.scene.model])
    scalars_of = attrgetter(*(field.name for field in READING))
    for count, (clock, sample) in enumerate(recording.samples_between(), 1):
        methods = recording.methods_of(sample.run)
        for method, reading in zip(methods, sample.readings, strict=True):
            place = (clock, sample.run, sample.step, sample.t, method)
            yield *place, *scalars_of(reading), *map(reading.extra.get, extra)
        if count % 1000 == 0:
            show(count, recording.samples)


def _write_parquet(options: argparse.Namespace, columns: tuple[str, ...], rows: Rows) -> None:
    if options.output is None:
        raise UserError("Parquet is not text: name a file with -o.")
    try:
        import pyarrow
        from pyarrow.parquet import ParquetWriter
    except ImportError:
        advice = install_advice("pyarrow", "parquet")
        raise UserError(f"--format parquet needs pyarrow: {advice}.") from None

    types = {"run": pyarrow.int64(), "step": pyarrow.int64(), "method": pyarrow.string()}
    schema = pyarrow.schema([(name, types.get(name, pyarrow.float64())) for name in columns])
    with (
        whole_file(options.output, options.force) as part,
        ParquetWriter(part, schema) as writer,
    ):
        while batch := list(islice(rows, 100_000)):
            values = dict(zip(columns, zip(*batch, strict=True), strict=True))
            writer.write_table(pyarrow.table(values, schema))
