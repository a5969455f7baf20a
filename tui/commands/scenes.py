"""List the scenes and what to watch in them, or show one scene and its numbers."""

import argparse
from collections.abc import Iterator
from typing import Any

from pendu_tui.engine.scenes import GROUPS, SCENES
from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.cli.scene import scene_named
from pendu_tui.tui.commands.report import Column, Report, publish
from pendu_tui.tui.words.cards import scene_card

COLUMNS = (
    Column("scene", lambda scene: scene.name),
    Column("z", lambda scene: scene.z, ".3g"),
    Column("what to watch", lambda scene: scene.watch),
)


def run(options: argparse.Namespace) -> int:
    scenes = list(SCENES.values())
    if options.key:
        scenes = [scene_named(options.key)]
    fields = {"scenes": [scene.fields() | {"speed": scene.speed} for scene in scenes]}
    report = Report(name="scenes", columns=COLUMNS, rows=list(_rows()), fields=fields)
    if options.key:
        (scene,) = scenes
        labels = ", ".join(method.label for method in scene.cast)
        notes = [
            f"{scene_card(scene)}\n  methods       {labels}",
            f"\nSee it: pendu-tui {scene.name}",
        ]
        report = Report(name="scenes", notes=notes, fields=fields)
    publish(report, options)
    return Exit.FINE


def _rows() -> Iterator[Any]:
    for group, members in GROUPS.items():
        yield ""
        yield group.upper()
        yield from members
