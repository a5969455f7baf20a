"""TextScreen: a text over the lab, to scroll in; and the text of the help."""

from collections.abc import Sequence
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.widgets import Static

from tui.playback.source import Source
from tui.screens.dialogs.modal import Modal
from tui.screens.keys import key_list
from tui.views.keys import Key
from tui.words.cards import glossary, method_card, scene_card
from tui.words.describe import step_text


def help_text(keys: Sequence[Key], source: Source) -> str:
    """The glossary, what to watch in the scene, the keys by group, and the methods."""
    scene = source.scene
    now = "" if source.stepping.h == scene.h else f"h = {step_text(source)}"
    return "\n\n".join([glossary(), scene_card(scene, now), key_list(keys), *map(method_card, scene.cast)])


class TextScreen(Modal[None]):
    """A text.  Esc closes it, and so do the keys that open one."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,question_mark,q,space,enter,d,E,shift+e", "dismiss(None)", "close")
    ]

    def __init__(self, title: str, text: str) -> None:
        super().__init__()
        self.text = text
        self.text_title = title

    def compose(self) -> ComposeResult:
        with VerticalScroll(id="text") as scroll:
            scroll.border_title = self.text_title
            scroll.border_subtitle = "arrows scroll, Esc closes"
            yield Static(self.text, markup=False)
