"""The driver: Textual's, which also measures how fast the line is, and stops and continues safely."""

import asyncio
import os
import signal
import time
from collections.abc import Callable
from typing import IO, Any

from textual.drivers.linux_driver import LinuxDriver

from tui.terminal.sgr import without_repeated_colours
from tui.terminal.throughput import Throughput
from tui.terminal.watchdog import watch


def _size(text: str) -> int:
    """Bytes; a file name may hold some that are not text."""
    return len(text.encode(errors="backslashreplace"))


class _Metered:
    """A file that reports how long each write took."""

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
    """Sends what Textual sends; over a slow line without the colours that are in force already.

    A signal may arrive while the writer's queue is locked, so nothing is written and no thread joined in a signal's
    handler: the event loop gives the terminal back for SIGTSTP (Ctrl+Z) and takes it again after SIGCONT.
    """

    def __init__(self, app: Any, **options: Any) -> None:
        super().__init__(app, **options)
        self._throughput: Throughput = app.throughput
        self._file: Any = _Metered(self._file, self._throughput)
        self._loop = asyncio.get_running_loop()
        self._continued = False  # since the last SIGTSTP
        self._stopped_itself = False  # and took the terminal again: the loop is still to hear of that SIGCONT
        self._takes_again = False  # soon
        self._loop.add_signal_handler(signal.SIGTSTP, self._stop_asked)
        self._loop.add_signal_handler(signal.SIGCONT, self._continue_heard)
        signal.signal(signal.SIGCONT, self._sigcont_application)  # sets a flag at once, and the loop hears of it, too

        self._leave: Callable[[], None] = app.interrupt
        watch(self._loop, self._leave, app.finish)

    def run_input_thread(self) -> None:
        """Read keys; a terminal that is at its end has none."""
        try:
            super().run_input_thread()
        except OSError:
            self._loop.call_soon_threadsafe(self._leave)

    def start_application_mode(self) -> None:
        """Take the terminal, with another thread that writes."""
        self._throughput.restart()
        super().start_application_mode()  # type: ignore[no-untyped-call]
        resized = signal.getsignal(signal.SIGWINCH)  # Textual's
        if callable(resized):
            self._loop.add_signal_handler(signal.SIGWINCH, resized, signal.SIGWINCH, None)

    def write(self, data: str) -> None:
        """Send this.  Leaving out colours takes a twentieth of a core, so a line that carries all gets all."""
        if self._writer_thread is None or not self._writer_thread.is_alive():
            return  # the terminal is not ours now; all is painted when it is again
        sent = without_repeated_colours(data) if self._throughput.is_slow else data
        self._throughput.send(_size(sent))
        super().write(sent)

    def _sigtstp_application(self, *_: object) -> None:
        """Textual's handler, which the event loop's replaces."""

    def _sigcont_application(self, *_: object) -> None:
        self._continued = True

    def _stop_asked(self) -> None:
        self._continued = False
        self._loop.call_soon(self._stop)  # not before the loop has heard of a SIGCONT that came right behind

    def _stop(self) -> None:
        """Give the terminal back and stop; where this returns, somebody has continued the program."""
        if self._continued:
            return
        self.suspend_application_mode()
        if not self._continued:
            os.kill(os.getpid(), signal.SIGSTOP)
        self._take_again()
        self._stopped_itself = True

    def _continue_heard(self) -> None:
        self._continued = True
        if self._stopped_itself:
            self._stopped_itself = False
        elif not self._takes_again:
            self._takes_again = True
            self._loop.call_soon(self._take_back)

    def _take_back(self) -> None:
        """Take the terminal as a whole after a stop that nobody announced (SIGSTOP): a shell may have used it."""
        self._takes_again = False
        if self._key_thread is not None and self._key_thread.is_alive():
            self.suspend_application_mode()  # or two threads would read the keys, one of which never ends
        self._take_again()

    def _take_again(self) -> None:
        self._must_signal_resume = True
        self.resume_application_mode()
