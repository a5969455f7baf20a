"""Draw the phase portrait of a method's own map, and describe the orbit of the scene's start."""

import argparse
import os
from pathlib import Path

from engine.methods import METHODS
from tui.cli.cast import KEYS, find
from tui.cli.errors import UserError
from tui.cli.options import Suggestions, add_file, count
from tui.cli.scene import add_scene_options, general_scene_of
from tui.terminal.options import add_picture_options, cells, terminal_options_of

EXAMPLES = """\
examples:
  pendu-tui section --h 0.3
  pendu-tui section --theta 1.25 --h 0.348 --method-key rk4
  pendu-tui section --methods symplectic_euler,verlet --h 0.45 --size 160x50
  pendu-tui section --h 0.35 --theme light -o section.svg
  pendu-tui section --h 0.348 --theta 1.25 --json | jq '.orbits[] | select(.island)'
"""

MOST_STARTS, MOST_STEPS = 10_000, 100_000


def add_options(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument(
        "--method-key",
        metavar="KEY",
        choices=Suggestions(KEYS),
        help="the method whose map is drawn (velocity_verlet, or the first of the scene's)",
    )
    parser.add_argument("--starts", metavar="N", type=count, default=300, help="orbits tried (%(default)s)")
    parser.add_argument("--steps", metavar="N", type=count, default=4000, help="steps of each orbit (%(default)s)")
    parser.add_argument("--size", metavar="CxR", type=cells, help="columns x rows of the picture (the terminal's)")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="one JSON object: the orbits of the scene's start")
    add_file(form, "-o", "--output", metavar="FILE.svg|txt", type=picture, help="write the picture to a file")
    parser.add_argument("--force", action="store_true", help="overwrite the file")
    add_picture_options(parser, "auto", "auto")


def picture(text: str) -> Path:
    """A file for a picture or a text, or a device."""
    path = Path(text)
    if path.suffix.lower() not in (".svg", ".txt") and (path.is_file() or not path.exists()):
        raise argparse.ArgumentTypeError(f"{text!r} is neither a picture nor a text; use {path.stem}.svg or .txt")
    return path


def run(options: argparse.Namespace) -> int:
    scene = general_scene_of(options)
    for name, most in (("starts", MOST_STARTS), ("steps", MOST_STEPS)):
        if (given := getattr(options, name)) > most:
            raise UserError(f"--{name} {given} is too many; use at most {most}.")
    from tui.commands.studies.reports.section import Study, print_json, print_text, write_file
    from tui.views.view import DESCRIBED_FIRST

    usual = next((method for method in scene.cast if method.key == DESCRIBED_FIRST), scene.cast[0])
    known = dict.fromkeys((*METHODS, *scene.cast))
    method = find(options.method_key, [*known], "--method-key") if options.method_key else usual
    study = Study(scene, method, options.starts, options.steps)
    if options.json:
        return print_json(study)
    display = terminal_options_of(options, os.environ, "utf-8")
    if options.output:
        theme = "dark" if options.theme == "auto" else options.theme  # of a file, not of the terminal
        size = options.size or (120, 36)
        return write_file(study, options.output, options.force, size, display._replace(theme=theme))
    return print_text(study, options.size, display)
