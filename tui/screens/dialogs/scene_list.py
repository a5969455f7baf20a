"""SceneList: the scenes in their groups, to start one."""

from contextlib import suppress
from typing import ClassVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import OptionList
from textual.widgets.option_list import Option

from engine.scenes import GROUPS, SCENES
from tui.screens.dialogs.modal import Form


class _Listed(OptionList):
    """Textual 8.2's knows no pages before its first paint, nor where the terminal is too small for any."""

    def action_page_up(self) -> None:
        with suppress(KeyError):
            super().action_page_up()  # type: ignore[no-untyped-call]

    def action_page_down(self) -> None:
        with suppress(KeyError):
            super().action_page_down()  # type: ignore[no-untyped-call]


class SceneList(Form[str | None]):
    """Returns the name of the scene to start, or None."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,P,shift+p,q", "dismiss(None)", "cancel")]

    def __init__(self, current: str | None) -> None:
        super().__init__()
        self._current = current

    def compose(self) -> ComposeResult:
        listed = _Listed(id="scenes", markup=False)
        listed.border_title = "Scenes, with what to watch"
        listed.border_subtitle = "Enter starts, Esc cancels"
        for group, scenes in GROUPS.items():
            listed.add_option(Option(Text(group.upper(), "bold"), disabled=True))
            listed.add_options(Option(_line(scene.name, scene.watch), scene.name) for scene in scenes)
        if self._current and self._current in SCENES:
            listed.highlighted = listed.get_option_index(self._current)
        yield listed

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(event.option_id)


def _line(name: str, watch: str) -> Table:
    line = Table.grid(padding=(0, 2))
    line.add_column(width=max(map(len, SCENES)))
    line.add_column()
    line.add_row(name, watch)
    return line
