"""Guarded: a widget whose errors are reported instead of ending the lab."""

from dataclasses import dataclass

from textual.events import Resize
from textual.message import Message
from textual.message_pump import MessagePump
from textual.screen import Screen

LOG = "faults.log"
"""Where the app writes what failed, next to the recordings."""


def sentence(error: BaseException) -> str:
    """The error as a sentence."""
    from engine.methods.own import OwnMethodError  # not before there is an error

    if isinstance(error, OwnMethodError):
        return f"{error} The run stands still; p starts another."
    what = f"{type(error).__name__}: {error}".strip(": ")
    return f"An error in this program ({what}); the lab goes on, and {LOG} next to the recordings has the details."


@dataclass
class Fault(Message):
    """An error that did not end the lab."""

    error: BaseException
    shown: bool = False  # in the widget already: no notice is needed


class Guarded(MessagePump):
    """Textual ends the program at the first exception in a handler; here only that message is lost.

    A size that the terminal no longer has is left out, too.
    """

    async def _dispatch_message(self, message: Message) -> None:
        if isinstance(self, Screen) and isinstance(message, Resize) and message.size != self.app.size:
            return  # the terminal has another size by now; two such could call each other up for ever
        try:
            await super()._dispatch_message(message)
        except Exception as error:
            self.fail(error)

    def fail(self, error: BaseException) -> None:
        self.app.post_message(Fault(error))
