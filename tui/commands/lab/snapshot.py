"""Save the lab as an SVG image, byte-identical every time."""

import argparse
import os
from pathlib import Path

from tui.cli.errors import Exit
from tui.cli.files import whole_file
from tui.cli.options import add_file, number
from tui.cli.scene import add_scene_options, scene_of
from tui.terminal.options import add_picture_options, cells, terminal_options_of

EXAMPLES = """\
examples:
  pendu-tui snapshot --time 12 -o lab.svg
  pendu-tui snapshot --scene crossover --time 40 --size 200x60 --theme light -o crossover.svg
"""
LONGEST = 3600.0  # s


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument(
        "--time", metavar="S", type=moment, default=12.0, help="simulated seconds (%(default)g)"
    )
    parser.add_argument(
        "--size", metavar="CxR", type=cells, default=(120, 40), help="columns x rows (120x40)"
    )
    add_picture_options(parser, "dark", "braille")
    add_file(
        parser,
        "-o",
        "--output",
        metavar="FILE.svg",
        type=picture,
        help="the image to write (default: SCENE.svg)",
    )
    parser.add_argument("--force", action="store_true", help="overwrite FILE.svg")


def run(options: argparse.Namespace) -> int:
    scene = scene_of(options)
    import asyncio

    from tui.screens.still import portable, still

    display = terminal_options_of(options, os.environ, "utf-8")
    path = options.output or Path(f"{scene.name}.svg")
    with whole_file(path, options.force) as file:
        svg = asyncio.run(still(scene, options.time, options.size, display))
        file.write_text(portable(svg), encoding="utf-8")
    if options.output is None:
        print(f"saved {path}")
    return Exit.FINE


def picture(text: str) -> Path:
    """An .svg file, or a device."""
    path = Path(text)
    if path.suffix.lower() != ".svg" and (path.is_file() or not path.exists()):
        raise argparse.ArgumentTypeError(
            f"the image is an SVG; write it to {path.stem}.svg instead of {text!r}"
        )
    return path


def moment(text: str) -> float:
    """A time since the start [s]."""
    if not 0 <= (value := number(text)) <= LONGEST:
        raise argparse.ArgumentTypeError(f"{text!r} is not a valid time; use 0 to {LONGEST:g} s")
    return value
