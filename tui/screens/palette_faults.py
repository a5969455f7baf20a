"""What is done about the faults of Textual's command palette, in this module only."""

from traceback import walk_tb
from typing import TypeVar

from textual.app import App
from textual.events import Event
from textual.screen import ModalScreen

Result = TypeVar("Result")
FAULTY = {"textual.command", "textual.widgets._option_list"}


class ForgivingApp(App[Result]):
    """Closes a palette or list that raises, where Textual would end the app.

    They raise when keys come faster than they open, fill and close, in Textual 8.2, too:
    https://github.com/Textualize/textual/issues/3714
    """

    async def on_event(self, event: Event) -> None:
        try:
            await super().on_event(event)
        except Exception as error:
            if not is_of_palette(error):
                raise
            self._handle_exception(error)

    def _handle_exception(self, error: Exception) -> None:
        if not is_of_palette(error):
            super()._handle_exception(error)
        elif isinstance(self.screen, ModalScreen):
            self.call_later(self.screen.dismiss)


def is_of_palette(error: BaseException) -> bool:
    """Return whether an error, maybe of a worker, was raised in Textual's palette or list."""
    raised = getattr(error, "error", error)
    modules = {frame.f_globals["__name__"] for frame, _ in walk_tb(raised.__traceback__)}
    return not modules.isdisjoint(FAULTY)
