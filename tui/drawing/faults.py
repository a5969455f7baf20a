"""Guarded: a widget whose faults are told instead of ending the lab."""

from dataclasses import dataclass

from textual.message import Message
from textual.message_pump import MessagePump

from engine.methods.own import OwnMethodError

LOG = "faults.log"
"""Where the app writes what failed, next to the recordings."""


def sentence(error: BaseException) -> str:
    """What failed, for people: of a user's own method just that."""
    if isinstance(error, OwnMethodError):
        return f"{error} The run stands still; p starts another."
    what = f"{type(error).__name__}: {error}".strip(": ")
    return f"An error in this program ({what}); the lab goes on, and {LOG} next to the recordings has the details."


@dataclass
class Fault(Message):
    """Something failed that must not."""

    error: BaseException
    shown: bool = False  # where it failed, so that no notice need say it


class Guarded(MessagePump):
    """Textual ends the program with the first exception in a handler; here it costs no more than that message."""

    async def _dispatch_message(self, message: Message) -> None:
        try:
            await super()._dispatch_message(message)
        except Exception as error:
            self.fail(error)

    def fail(self, error: BaseException) -> None:
        """Tell the app what failed."""
        self.app.post_message(Fault(error))
