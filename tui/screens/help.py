"""Help: the scene, the keys by what they are for, and the methods."""

from collections.abc import Sequence

from engine.methods import METHODS
from tui.playback.source import Source
from tui.screens.text import TextScreen
from tui.views.keys import Key
from tui.words.cards import method_card, scene_card
from tui.words.describe import step_text


def help_text(keys: Sequence[Key], source: Source) -> str:
    """What the help says: what to watch, the keys, those of the view first, and the methods."""
    scene = source.scene
    parts = [scene_card(scene, "" if source.stepping.h == scene.h else f"h = {step_text(source)}")]
    for group in dict.fromkeys(key.group for key in keys):
        lines = [f"  {key.shown:<14}{key.does}" for key in keys if key.group == group and key.shown]
        parts.append("\n".join([group.capitalize(), *lines]))
    return "\n\n".join([*parts, *(method_card(index) for index in range(len(METHODS)))])


class Help(TextScreen):
    """The help."""

    def __init__(self, keys: Sequence[Key], source: Source) -> None:
        super().__init__("Help", help_text(keys, source))
