"""The watchdog: ends a lab whose terminal is gone, whatever its event loop does."""

import os
import time
from asyncio import AbstractEventLoop
from collections.abc import Callable
from contextlib import suppress
from threading import Event, Thread

from tui.cli.errors import Exit
from tui.terminal.check import is_gone

LOOK_EVERY = 1.0  # s
PATIENCE = 5.0  # s for the event loop to turn, and for the recording to be closed without it


def watch(loop: AbstractEventLoop, leave: Callable[[], object], close: Callable[[], object]) -> None:
    """Start a thread that calls `leave` in the loop once the terminal is gone.

    If the loop does not turn it calls `close` instead, to finish the recording, and ends the process.
    """
    Thread(target=_watch, args=(loop, leave, close), name="watchdog", daemon=True).start()


def _watch(loop: AbstractEventLoop, leave: Callable[[], object], close: Callable[[], object]) -> None:
    while not is_gone():
        time.sleep(LOOK_EVERY)
    turned = Event()
    with suppress(RuntimeError):  # the loop is closed: the program is leaving
        loop.call_soon_threadsafe(turned.set)
        loop.call_soon_threadsafe(leave)
        if not turned.wait(PATIENCE):
            closing = Thread(target=close, daemon=True)  # which may need what the loop holds
            closing.start()
            closing.join(PATIENCE)
            os._exit(Exit.INTERRUPTED)
