"""Save the lab as an SVG image, with the same bytes each time."""

import argparse
import os
from pathlib import Path

from pendu_tui.tui.cli.cast import check_fits
from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.cli.files import whole_file
from pendu_tui.tui.cli.options import add_file, number
from pendu_tui.tui.cli.report import file_type, say
from pendu_tui.tui.cli.scene import add_scene_options, scene_of
from pendu_tui.tui.terminal.options import add_picture_options, cells, terminal_options_of

EXAMPLES = """\
examples:
  pendu-tui snapshot --time 12 -o lab.svg
  pendu-tui snapshot --scene crossover --time 40 --size 200x60 --theme light -o crossover.svg
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    add = parser.add_argument
    time = "simulated seconds (%(default)g)"
    add("--time", metavar="S", type=moment, default=12.0, help=time)
    size = "columns x rows (120x40)"
    add("--size", metavar="CxR", type=cells, default=(120, 40), help=size)
    add_picture_options(parser, "dark", "braille")
    image = "the image to write (default: SCENE.svg)"
    svg = file_type([".svg"])
    add_file(parser, "-o", "--output", metavar="FILE.svg", type=svg, help=image)
    add("--force", action="store_true", help="overwrite FILE.svg")


def run(options: argparse.Namespace) -> int:
    import asyncio

    from pendu_tui.tui.screens.still import still

    scene = scene_of(options)
    check_fits(scene.cast)
    display = terminal_options_of(options, os.environ, "utf-8")
    path = options.output or Path(f"{scene.name}.svg")
    with whole_file(path, options.force) as file:
        svg = asyncio.run(still(scene, options.time, options.size, display))
        file.write_text(svg, encoding="utf-8")
    if options.output is None:
        say(f"saved {path}")
    return Exit.FINE


def moment(text: str) -> float:
    value = number(text)
    if not 0 <= value <= 3600:
        raise ValueError(f"{text!r} is not a valid time; use 0 to 3600 s")
    return value
