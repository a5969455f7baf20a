"""Screens over the lab, each of which closes once, however fast the clicks and keys come."""

from textual import events
from textual.await_complete import AwaitComplete
from textual.command import CommandPalette
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


class Commands(CommandPalette, _Once[None]):
    """The command palette; the app ignores its errors, which come of fast keys."""
