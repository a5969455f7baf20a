"""What the command palette offers: everything that has a key, and what has none."""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from engine.methods import METHODS
from engine.scenes import SCENES
from tui.drawing.palette import PALETTES
from tui.views.keys import Key


class Entry(NamedTuple):
    """An entry and the action behind it."""

    title: str
    about: str
    action: str


def menu(keys: Iterable[Key], live: bool, recordings: Iterable[Path]) -> list[Entry]:
    """The entries; only a live lab can be given another scene."""
    return [
        *(Entry(f"{key.does} ({key.shown})", key.group, key.action) for key in keys if _offered(key)),
        *(Entry(f"scene {name}", scene.watch, f"start_scene({name!r})") for name, scene in SCENES.items() if live),
        *(
            Entry(f"method {method.label}", "its card", f"app.extra('card', {index})")
            for index, method in enumerate(METHODS)
        ),
        *(Entry(f"theme {name}", "", f"app.use_theme({name!r})") for name in PALETTES),
        Entry("large numbers and thick lines, or not", "for a projector", "app.present"),
        *(Entry(f"replay {path.stem}", str(path), f"app.extra('replay', {str(path)!r})") for path in recordings),
        Entry("copy the command that reproduces this", "to the clipboard", "app.extra('copy_command')"),
    ]


def _offered(key: Key) -> bool:
    return bool(key.does and key.action) and key.action != "command_palette"
