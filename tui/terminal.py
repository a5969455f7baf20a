"""The terminal: whether the lab can be shown on it, and whether it keeps up."""

import os
import signal
import sys
import time
from typing import Any

from tui.errors import Exit, UserError
from tui.lean import lean


def check_terminal() -> None:
    """Raise UserError unless the lab can be shown: Textual itself would print garbage."""
    if not all(stream is not None and stream.isatty() for stream in (sys.__stdin__, sys.__stdout__, sys.__stderr__)):
        raise UserError(
            "this is no terminal: the lab needs one for its input and its output; pendu-tui run needs none,"
            " nor does --plain.",
            Exit.TERMINAL_UNSUITABLE,
        )
    term = os.environ.get("TERM", "")
    if term in ("", "dumb", "unknown"):
        raise UserError(
            f"the terminal (TERM={term}) cannot move its cursor: set TERM to what it is, such as xterm-256color.",
            Exit.TERMINAL_UNSUITABLE,
        )


def is_gone() -> bool:
    """Whether the terminal has been closed: who writes to it then fails, or waits forever."""
    try:
        os.get_terminal_size(0)
    except OSError:
        return True
    return False


def is_behind(app: Any) -> bool:
    """Whether frames are still on their way: on a slow line one more only adds to the delay.

    Textual blocks once 30 writes are waiting, and tells nobody how many there are.
    """
    try:
        waiting = app._driver._writer_thread._queue.qsize() > 0
    except AttributeError:  # another version, or no terminal
        return False
    return app.wire.is_busy(waiting, time.monotonic())  # type: ignore[no-any-return]


def send_less(app: Any) -> None:
    """Leave out colours that are in force already where the line is slow: what is sent is what one waits for.

    It takes a twentieth of a core, so a line that carries all gets all.
    """
    if sys.platform == "win32":  # there Textual cuts what it sends anywhere
        return
    driver = app._driver
    write = driver.write

    def write_less(text: str) -> None:
        sent = lean(text) if app.wire.has_been_slow else text
        app.wire.send(len(sent.encode()))
        write(sent)

    driver.write = write_less


def come_back_whole(app: Any) -> None:
    """Take the terminal again as a whole after a stop that nobody announced (SIGSTOP), as after Ctrl+Z.

    Textual would have two threads read the keys: one that is never joined, so that the program never ends.
    """
    driver = app._driver
    resume = getattr(driver, "_sigcont_application", None)
    if resume is None:  # no terminal, another system, or another version
        return

    def resumed(*_: object) -> None:
        if driver._key_thread is not None and driver._key_thread.is_alive():
            driver.suspend_application_mode()
        driver._must_signal_resume = True
        resume()

    signal.signal(signal.SIGCONT, resumed)
