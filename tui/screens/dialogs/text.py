"""TextScreen: a text over the lab, to scroll in."""

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.widgets import Static

from tui.screens.dialogs.modal import Modal


class TextScreen(Modal[None]):
    """A text.  Esc closes it, and so do the keys that open one."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,question_mark,q,space,enter,d,E,shift+e", "dismiss(None)")
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
