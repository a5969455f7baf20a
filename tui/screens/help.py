"""Help: the scene, the keys by what they are for, and the methods."""

from collections.abc import Sequence

from engine.methods import METHODS
from engine.scenes import Scene
from tui.cards import method_card, scene_card
from tui.keys import Key
from tui.screens.reader import Reader


def help_text(keys: Sequence[Key], scene: Scene) -> str:
    """What the help says: what to watch, the keys, those of the view first, and the methods."""
    parts = [scene_card(scene)]
    for group in dict.fromkeys(key.group for key in keys):
        lines = [f"  {key.shown:<14}{key.does}" for key in keys if key.group == group and key.shown]
        parts.append("\n".join([group.capitalize(), *lines]))
    return "\n\n".join([*parts, *(method_card(index) for index in range(len(METHODS)))])


class Help(Reader):
    """The help."""

    def __init__(self, keys: Sequence[Key], scene: Scene) -> None:
        super().__init__("Help", help_text(keys, scene))
