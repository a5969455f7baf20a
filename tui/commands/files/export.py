"""Write a recording as CSV: one row per sample and method, units in the header."""

import argparse
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.files import text_file
from tui.cli.options import add_file, add_recording
from tui.cli.output import progress, warn, write_csv

if TYPE_CHECKING:
    from recordings.recording import Recording

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
    from recordings.fields import COLUMNS
    from recordings.recording import Recording

    path = library.resolve(options.file)
    with (
        Recording.open(path) as recording,
        progress(printable(path.name)) as show,
        text_file(options.output, options.force) as out,
    ):
        write_csv(out, COLUMNS, _rows(recording, show))
        if recording.reason:
            warn(f"{printable(str(path))}: {recording.reason}; the rest is exported.")
    return Exit.FINE


def _rows(recording: "Recording", show: Callable[[int, int], None]) -> "Iterator[tuple[object, ...]]":
    from engine.run.lockstep import Sample
    from recordings.fields import rows

    samples = ((clock, value) for clock, value in recording.entries() if isinstance(value, Sample))
    for count, (clock, sample) in enumerate(samples, 1):
        yield from rows(clock, sample, recording.methods)
        if count % 1000 == 0:
            show(count, recording.samples)
