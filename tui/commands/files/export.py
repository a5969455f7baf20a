"""Write a recording as CSV, one row per sample and method, as an asciicast, the replay as a film for a terminal, or as
a layout for Foxglove."""

import argparse
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from recordings.errors import printable
from tui.cli.errors import Exit, UserError
from tui.cli.files import text_file
from tui.cli.options import add_file, add_recording, positive
from tui.cli.output import progress, warn, write_csv
from tui.terminal.options import add_picture_options, cells, frames_per_second, terminal_options_of
from tui.words.numbers import file_size

if TYPE_CHECKING:
    from textual.strip import Strip

    from recordings.recording import Recording

FORMATS = ("csv", "cast", "foxglove")
MOST_FRAMES = 100_000  # almost three hours at the usual rate
FILM = {"size": (80, 24), "speed": 1.0, "fps": 10}
"""The options of a film, with their defaults."""

EXAMPLES = """\
examples:
  pendu-tui export latest --format csv -o latest.csv
  pendu-tui export drift --format csv | head -3
  pendu-tui export drift --format cast --size 120x40 --speed 2 -o drift.cast
  pendu-tui export latest --format foxglove -o layout.json

asciinema plays a .cast: asciinema play drift.cast, or its player on a web page.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_recording(parser)
    parser.add_argument("--format", choices=FORMATS, default="csv", help="output format (%(default)s)")
    add_file(parser, "-o", "--output", metavar="OUT", type=Path, help="write to OUT instead of stdout")
    parser.add_argument("--force", action="store_true", help="overwrite OUT")
    add_picture_options(parser, "dark", "braille")
    film = parser.add_argument_group("cast", "of --format cast only, as is display")
    film.add_argument("--size", metavar="CxR", type=cells, help="columns x rows (80x24)")
    film.add_argument("--speed", metavar="X", type=positive, help="playback speed (1)")
    film.add_argument("--fps", metavar="N", type=frames_per_second, help="frames per second of the film (10)")


def run(options: argparse.Namespace) -> int:
    from recordings import library
    from recordings.recording import Recording

    given = [name for name in FILM if getattr(options, name) is not None]
    if options.format != "cast" and given:
        raise UserError(f"--{given[0]} belongs to --format cast.")
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
        elif options.format == "foxglove":
            from tui.commands.files.foxglove import layout

            print(json.dumps(layout(recording.keys), indent=2), file=out)
        else:
            _film(recording, options, out, show)
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


def _film(recording: "Recording", options: argparse.Namespace, out: TextIO, show: Callable[[int, int], None]) -> None:
    import asyncio

    from tui.playback.marks import Marks
    from tui.playback.replay import Replay
    from tui.screens.still import film
    from tui.terminal import asciicast

    if recording.at(0.0) is None:
        raise UserError(f"{printable(str(recording.path))} contains no samples.", Exit.INPUT_UNREADABLE)
    chosen: dict[str, Any] = {name: getattr(options, name) or usual for name, usual in FILM.items()}
    frames = int(recording.length / chosen["speed"] * chosen["fps"]) + 2  # the last one lies behind the end
    if frames > MOST_FRAMES:
        raise UserError(f"the film would have {frames} frames, more than {MOST_FRAMES}: use a higher --speed.")
    replay = Replay(recording, Marks(recording.path), clock=lambda: 0.0)
    replay.set_speed(chosen["speed"])
    options.fps = chosen["fps"]
    before: list[list[asciicast.Cell]] = []
    terminal, stderr = terminal_options_of(options, {}, "utf-8"), sys.stderr

    def take(frame: int, screen: "list[Strip]") -> None:
        nonlocal before
        now = asciicast.cells(screen)
        sent = asciicast.changed(before, now)
        begin, end = asciicast.BEGIN * (frame == 0), asciicast.END * (frame == frames - 1)
        if begin + sent + end:
            print(asciicast.event(frame / chosen["fps"], begin + sent + end), file=out)
        before = now
        with redirect_stderr(stderr):  # Textual's is deaf
            show(frame, frames)

    print(asciicast.header(chosen["size"], f"pendu-tui replay {printable(recording.path.stem)}"), file=out)
    asyncio.run(film(replay, frames, chosen["size"], terminal, take))
