"""What lies over the lab until it is closed, and is closed once, however fast one clicks and types."""

from contextlib import suppress

from textual import work
from textual.await_complete import AwaitComplete
from textual.command import CommandList, CommandPalette
from textual.screen import ModalScreen, Screen, ScreenResultType
from textual.widgets import Input


class _Once(Screen[ScreenResultType]):
    _dismissed = False

    def on_mount(self) -> None:
        """Let no cursor blink where reduced motion is asked for: Textual would."""
        for field in self.query(Input):
            field.cursor_blink = self.app.animation_level != "none"

    def dismiss(self, result: ScreenResultType | None = None) -> AwaitComplete:
        """Close, with a result.  Asked again, or while something lies over it, Textual would close another screen."""
        if self._dismissed or self.app.screen is not self:
            return AwaitComplete()
        self._dismissed = True
        return super().dismiss(result)


class Modal(ModalScreen[ScreenResultType], _Once[ScreenResultType]):
    """A screen over the lab."""


_gather = CommandPalette._gather_commands.__wrapped__  # type: ignore[attr-defined]


class Commands(CommandPalette, _Once[None]):
    """The command palette, without what Textual 8.2 does when keys come faster than it can open and close it."""

    @work(exclusive=True, group=CommandPalette._GATHER_COMMANDS_GROUP)
    async def _gather_commands(self, search_value: str) -> None:
        if self.query(CommandList):  # else it has been closed since
            await _gather(self, search_value)

    def _action_command_list(self, action: str) -> None:
        with suppress(KeyError):  # of a list that is not laid out yet
            super()._action_command_list(action)
