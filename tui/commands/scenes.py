"""List the scenes with what to watch, or one of them with its numbers."""

import argparse
from operator import itemgetter
from typing import Any

from engine.scenes import GROUPS, SCENES
from tui.cli.errors import Exit
from tui.cli.options import Suggestions
from tui.cli.report import Column, Report, add_report_options, publish
from tui.cli.scene import scene_named

EXAMPLES = """\
examples:
  pendu-tui scenes
  pendu-tui scenes crossover
  pendu-tui scenes --json | jq -r '.scenes[].name'
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    names = Suggestions(SCENES)
    parser.add_argument("key", metavar="SCENE", nargs="?", choices=names, help="the scene to show")
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    scenes = list(SCENES.values())
    heads: tuple[str, ...] = ("scene", "z", "what to watch")
    if options.key:
        scenes = [scene_named(options.key)]
        heads = ("", "")
    fields = [scene.fields() | {"speed": scene.speed} for scene in scenes]
    rows: list[tuple[Any, ...]] = []
    notes = []
    if options.key is None:
        for group, members in GROUPS.items():
            rows += [("", "", ""), (group.upper(), "", "")]
            rows += [(scene.name, f"{scene.z:.3g}", scene.watch) for scene in members]
    else:
        shown = fields[0] | {"methods": ", ".join(fields[0]["methods"])}
        rows = [(name, str(value)) for name, value in shown.items() if value is not None]
        notes = [f"See it: pendu-tui {options.key}"]
    columns = [Column(head, itemgetter(at), right=head == "z") for at, head in enumerate(heads)]
    fields_of_all = {"scenes": fields}
    report = Report(name="scenes", columns=columns, rows=rows, notes=notes, fields=fields_of_all)
    publish(report, options)
    return Exit.FINE
