"""The driver: Textual's, with an eye on how fast the line is, and whole again after any stop."""

import time
from typing import IO, Any

from textual.drivers.linux_driver import LinuxDriver

from tui.terminal.sgr import lean
from tui.terminal.throughput import Throughput


def _size(text: str) -> int:
    """Bytes; the name of a file may hold some that are no text."""
    return len(text.encode(errors="backslashreplace"))


class _Metered:
    """A file that tells how long writing took."""

    def __init__(self, file: IO[str], throughput: Throughput) -> None:
        self._file, self._throughput = file, throughput

    def write(self, text: str) -> None:
        began = time.monotonic()
        self._file.write(text)
        self._file.flush()
        self._throughput.written(_size(text), began, time.monotonic())

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)


class LabDriver(LinuxDriver):
    """Sends what Textual sends; over a slow line without the colours that are in force already."""

    def __init__(self, app: Any, **options: Any) -> None:
        super().__init__(app, **options)
        self._throughput: Throughput = app.throughput
        self._file: Any = _Metered(self._file, self._throughput)

    def start_application_mode(self) -> None:
        """Take the terminal, with another thread that writes."""
        self._throughput.restart()
        super().start_application_mode()  # type: ignore[no-untyped-call]

    def write(self, data: str) -> None:
        """Send this.  Leaving out colours takes a twentieth of a core, so a line that carries all gets all."""
        sent = lean(data) if self._throughput.is_slow else data
        self._throughput.send(_size(sent))
        super().write(sent)

    def _sigcont_application(self, *_: object) -> None:
        """Take the terminal again as a whole after a stop that nobody announced (SIGSTOP), as after Ctrl+Z.

        Textual would have two threads read the keys: one that is never joined, so that the program never ends.
        """
        if self._key_thread is not None and self._key_thread.is_alive():
            self.suspend_application_mode()
        self._must_signal_resume = True
        super()._sigcont_application()
