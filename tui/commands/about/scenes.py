"""List the scenes: start values, step size, and what to watch."""

import argparse
import math

from engine.scenes import SCENES
from tui.cli.errors import Exit
from tui.cli.output import print_table, write_json

EXAMPLES = """\
examples:
  pendu-tui scenes
  pendu-tui --scene crossover
  pendu-tui scenes --json | jq -r '.scenes[].name'
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="one JSON object, SI units")


def run(options: argparse.Namespace) -> int:
    if options.json:
        write_json("scenes", {"scenes": [scene.fields() for scene in SCENES.values()]})
        return Exit.FINE
    print_table(
        "lrrrrl",
        ("scene", "theta [deg]", "omega [rad/s]", "h [s]", "z = h·w0", "what to watch"),
        (
            (s.name, f"{math.degrees(s.theta):.5g}", f"{s.omega:g}", f"{s.h:g}", f"{s.z:.3f}", s.watch)
            for s in SCENES.values()
        ),
    )
    return Exit.FINE
