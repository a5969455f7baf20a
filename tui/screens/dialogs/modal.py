"""Screens over the lab, each of which closes once, however fast the clicks and keys come."""

from contextlib import suppress

from textual import events, work
from textual.await_complete import AwaitComplete
from textual.command import CommandList, CommandPalette
from textual.css.query import NoMatches
from textual.screen import ModalScreen, Screen, ScreenResultType
from textual.widgets import Input


class _Once(Screen[ScreenResultType]):
    _dismissed = False

    def on_mount(self) -> None:
        """With reduced motion no cursor blinks; Textual lets it."""
        for field in self.query(Input):
            field.cursor_blink = self.app.animation_level != "none"

    def on_resize(self, event: events.Resize) -> None:
        """Leave out a size that the terminal has no longer: two could evoke each other for ever."""
        if event.size != self.app.size:
            event.prevent_default()

    def dismiss(self, result: ScreenResultType | None = None) -> AwaitComplete:
        """Close with a result, once; a second call would close the screen below."""
        if self._dismissed or self.app.screen is not self:
            return AwaitComplete()
        self._dismissed = True
        return super().dismiss(result)


class Modal(ModalScreen[ScreenResultType], _Once[ScreenResultType]):
    """A screen over the lab."""


class Form(Modal[ScreenResultType]):
    """A modal that asks for something; a click beside it cancels."""

    def on_click(self, event: events.Click) -> None:
        if event.widget is self:
            self.dismiss(None)


_gather = CommandPalette._gather_commands.__wrapped__  # type: ignore[attr-defined]


class Commands(CommandPalette, _Once[None]):
    """The command palette; Textual 8.2's raises errors if keys come faster than it opens."""

    @work(exclusive=True, group=CommandPalette._GATHER_COMMANDS_GROUP)
    async def _gather_commands(self, search_value: str) -> None:
        if self.query(CommandList):  # else it was closed meanwhile
            await _gather(self, search_value)

    def _watch__list_visible(self) -> None:
        with suppress(NoMatches):  # it was closed while it searched
            super()._watch__list_visible()

    async def _watch__show_busy(self) -> None:
        with suppress(NoMatches):
            await super()._watch__show_busy()

    def _action_command_list(self, action: str) -> None:
        with suppress(KeyError):  # the list is not laid out yet
            super()._action_command_list(action)
