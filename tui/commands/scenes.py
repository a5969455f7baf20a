"""List the scenes and what to watch in them, or show one scene and its numbers."""

import argparse
from typing import Any

from engine.scenes import GROUPS, SCENES, Scene
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
    rows: list[Any] = []
    if options.key:
        scenes = [scene_named(options.key)]
        fields = _fields(scenes[0])
        shown = fields | {"methods": ", ".join(fields["methods"])}
        rows += [(name, str(value)) for name, value in shown.items() if value is not None]
        columns = [Column("", 0), Column("", 1)]
        notes = [f"See it: pendu-tui {options.key}"]
    else:
        scenes = list(SCENES.values())
        for group, members in GROUPS.items():
            rows += ["", group.upper(), *members]
        columns = [
            Column("scene", lambda scene: scene.name),
            Column("z", lambda scene: scene.z, ".3g"),
            Column("what to watch", lambda scene: scene.watch),
        ]
        notes = []
    values = {"scenes": [_fields(scene) for scene in scenes]}
    report = Report(name="scenes", columns=columns, rows=rows, notes=notes, fields=values)
    publish(report, options)
    return Exit.FINE


def _fields(scene: Scene) -> dict[str, Any]:
    return scene.fields() | {"speed": scene.speed}
