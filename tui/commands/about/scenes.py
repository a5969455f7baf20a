"""List the scenes with what to watch, or one of them with its numbers."""

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
  pendu-tui crossover
  pendu-tui --scene mine.toml
  pendu-tui scenes --json | jq -r '.scenes[].name'
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "key", metavar="SCENE", nargs="?", choices=Suggestions(SCENES), help="the scene to show"
    )
    add_report_options(parser)


def run(options: argparse.Namespace) -> int:
    scenes = list(SCENES.values()) if options.key is None else [scene_named(options.key)]
    report = _list(scenes) if options.key is None else _one(scenes[0])
    publish(report, options)
    return Exit.FINE


def _fields(scenes: list[Scene]) -> dict[str, Any]:
    return {"scenes": [scene.fields() | {"speed": scene.speed} for scene in scenes]}


def _list(scenes: list[Scene]) -> Report:
    """Return the scenes in groups, the group's name above each."""
    rows: list[tuple[str, str, str]] = []
    for group, members in GROUPS.items():
        rows += [("", "", ""), (group.upper(), "", "")]
        rows += [(scene.name, f"{scene.z:.3g}", scene.watch) for scene in members]
    columns = (
        Column("scene", lambda row: row[0]),
        Column("z", lambda row: row[1], right=True),
        Column("what to watch", lambda row: row[2]),
    )
    return Report(name="scenes", columns=columns, rows=rows, fields=_fields(scenes))


def _one(scene: Scene) -> Report:
    """Return the fields of a scene, and what it shows."""
    fields = _fields([scene])["scenes"][0]
    fields["methods"] = ", ".join(fields["methods"])
    columns = (Column("", lambda row: row[0]), Column("", lambda row: str(row[1])))
    notes = [f"See it: pendu-tui {scene.name}" if scene.name in SCENES else ""]
    rows = [(name, value) for name, value in fields.items() if value is not None]
    return Report(name="scenes", columns=columns, rows=rows, notes=notes, fields=_fields([scene]))
