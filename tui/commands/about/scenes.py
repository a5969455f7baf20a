"""List the scenes: start values, step size, and what to watch."""

import argparse

from engine.scenes import GROUPS, LEFT_OUT, SCENES
from tui.cli.errors import Exit
from tui.cli.output import print_lines, write_json
from tui.cli.report import print_table

EXAMPLES = """\
examples:
  pendu-tui scenes
  pendu-tui --scene crossover
  pendu-tui --scene mine.toml
  pendu-tui scenes --json | jq -r '.scenes[].name'
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="one JSON object, SI units")


def run(options: argparse.Namespace) -> int:
    if options.json:
        write_json("scenes", {"scenes": [scene.fields() | {"speed": scene.speed} for scene in SCENES.values()]})
        return Exit.FINE
    print_table("lrl", ("scene", "h·w", "what to watch"), [row for group in GROUPS for row in _rows(group)])
    print_lines("", LEFT_OUT)
    return Exit.FINE


def _rows(group: str) -> list[tuple[str, str, str]]:
    """The group's name, and a row for each of its scenes; h·w is the step times the highest frequency."""
    return [("", "", ""), (group.upper(), "", ""), *((s.name, f"{s.z:.3g}", s.watch) for s in GROUPS[group])]
