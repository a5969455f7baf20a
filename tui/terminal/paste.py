"""A paste whose end is lost: Textual would take all keys after it for pasted text, for ever."""

import sys
import time
from collections.abc import Iterable

from textual._xterm_parser import XTermParser
from textual.message import Message

BEGIN = "\x1b[200~"
END = "\x1b[201~"
MAX_SECONDS = 2.0


class PatientParser(XTermParser):
    """A parser of what the terminal sends, in which a paste ends after two seconds at most."""

    _began: float | None = None  # s, the paste
    _before = ""

    def feed(self, data: str) -> Iterable[Message]:
        text = self._before + data
        began, ended = text.rfind(BEGIN), text.rfind(END)
        if began > ended:
            self._began = time.monotonic()
        elif began < ended:
            self._began = None
        self._before = text[1 - len(END) :]
        return super().feed(data)

    def tick(self) -> Iterable[Message]:
        yield from super().tick()
        if self._began is not None and time.monotonic() > self._began + MAX_SECONDS:
            yield from self.feed(END)


def limit_pastes() -> None:
    """Have it read the keys in all drivers that Textual has loaded."""
    for name in ("linux_driver", "web_driver", "win32"):
        if driver := sys.modules.get(f"textual.drivers.{name}"):
            vars(driver)["XTermParser"] = PatientParser
