"""Write a recording as CSV, one row per sample and method, or as a layout for Foxglove."""

import argparse
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from recordings.errors import printable
from tui.cli.errors import Exit
from tui.cli.files import text_file
from tui.cli.options import add_file, add_recording
from tui.cli.output import progress, warn, write_csv
from tui.words.numbers import file_size

if TYPE_CHECKING:
    from recordings.recording import Recording

FORMATS = ("csv", "foxglove")
EXAMPLES = """\
examples:
  pendu-tui export latest --format csv -o latest.csv
  pendu-tui export drift --format csv | head -3
  pendu-tui export latest --format foxglove -o layout.json

A film of a recording: asciinema rec -c "pendu-tui replay drift" drift.cast
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser)
    parser.add_argument("--format", choices=FORMATS, default="csv", help="output format (%(default)s)")
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
        if options.format == "csv":
            from recordings.fields import columns

            head = columns(*recording.models)
            write_csv(out, head, _rows(recording, len(head), show))
        else:
            from tui.commands.files.foxglove import layout

            print(json.dumps(layout(recording.keys), indent=2), file=out)
        if recording.reason:
            warn(f"{printable(str(path))}: {recording.reason}; the rest is exported.")
    if options.output:
        size = file_size(options.output.stat().st_size)
        what = "a layout for" if options.format == "foxglove" else f"{recording.length:g} s of"
        warn(f"wrote {what} {printable(path.name)}, {size}: {printable(str(options.output))}")
    return Exit.FINE


def _rows(recording: "Recording", width: int, show: Callable[[int, int], None]) -> "Iterator[tuple[object, ...]]":
    from engine.run.lockstep import Sample
    from recordings.fields import rows

    samples = ((clock, value) for clock, value in recording.entries() if isinstance(value, Sample))
    for count, (clock, sample) in enumerate(samples, 1):
        yield from rows(clock, sample, recording.methods_of(sample.run), width)
        if count % 1000 == 0:
            show(count, recording.samples)
