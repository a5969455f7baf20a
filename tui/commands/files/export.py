"""Write a recording as CSV: one row per sample and method, units in the header."""

import argparse
import csv
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from engine.methods import Cast
from engine.run.lockstep import Sample
from recordings.errors import printable
from recordings.fields import MOMENT, READING, values_of
from tui.cli.errors import Exit
from tui.cli.files import text_file
from tui.cli.options import add_file, add_recording
from tui.cli.output import progress, warn

if TYPE_CHECKING:
    from recordings.recording import Recording
    from recordings.scan import ShowProgress

COLUMNS = ("clock_s", *(field.column for field in MOMENT), "method", *(field.column for field in READING))
"""Names with their units; energies are per unit m·L²."""

EXAMPLES = """\
examples:
  pendu-tui export latest --format csv -o latest.csv
  pendu-tui export drift --format csv | head -3
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser)
    parser.add_argument("--format", choices=("csv",), default="csv", help="output format (only %(default)s)")
    add_file(parser, "-o", "--output", metavar="OUT", type=Path, help="write to OUT instead of stdout")
    parser.add_argument("--force", action="store_true", help="overwrite OUT")


def run(options: argparse.Namespace) -> int:
    from recordings import library
    from recordings.recording import Recording

    path = library.resolve(options.file)
    with (
        Recording.open(path) as recording,
        progress(printable(path.name)) as show,
        text_file(options.output, options.force) as out,
    ):
        write_csv(recording, out, show)
        if recording.reason:
            warn(f"{printable(str(path))}: {recording.reason}; the rest is exported.")
    return Exit.FINE


def write_csv(recording: "Recording", out: TextIO, show: "ShowProgress | None" = None) -> int:
    """Write all samples and return how many there were.  Every number reads back with the same bits."""
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(COLUMNS)
    count, run = 0, 0
    cast: Cast = ()
    for clock, value in recording.entries():
        if not isinstance(value, Sample):
            continue
        if value.run != run:
            run, scene = value.run, recording.events.start_of(value.run)
            cast = scene.cast if scene else cast
        for method, reading in zip(cast, value.readings, strict=True):
            rows.writerow((clock, value.run, value.step, value.t, method.key, *values_of(reading)))
        count += 1
        if show and count % 1000 == 0:
            show(count, recording.samples)
    return count
