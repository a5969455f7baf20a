"""Save the lab as an SVG image, with the same bytes each time."""

import argparse
import os
from pathlib import Path

from pendu_tui.tui.cli.cast import check_fits
from pendu_tui.tui.cli.errors import Exit, say
from pendu_tui.tui.cli.files import whole_file
from pendu_tui.tui.cli.scene import scene_of
from pendu_tui.tui.terminal.options import terminal_options_of


def run(options: argparse.Namespace) -> int:
    import asyncio

    from pendu_tui.tui.screens.launch import still

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
