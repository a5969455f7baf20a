"""Handle signals and a lost terminal even while the event loop is stuck."""

import asyncio
import os
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any

from textual.app import App

from pendu_tui.recordings.system import (
    CONTINUE,
    ENDING,
    STOP,
    restore_terminal,
    stop,
    terminal_state,
)
from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.terminal.check import is_gone

MARGIN = 0.1  # s; the order of two signals closer than this is unknown


class Watchdog(Thread):
    """Passes signals on to the event loop, and ends the program if the loop is stuck.

    Textual's own handlers would run in the middle of whatever Python does.  If that is a write to
    the terminal, their own write would wait for it for ever.
    """

    def __init__(self, app: App[Any], close: Callable[[], object]) -> None:
        """`close` ends the recording from any thread."""
        super().__init__(name="watchdog", daemon=True)
        self._app = app
        self._close = close
        self._terminal = terminal_state()
        self._signals: SimpleQueue[int] = SimpleQueue()
        self._heard_at = {STOP: 0.0, CONTINUE: 0.0}  # s
        self._taken_at = 0.0  # s, the terminal

    def hear(self, number: int | None, frame: object = None) -> None:
        """Handle a signal, if this system has it."""
        if number is not None:
            self._heard_at[number] = time.monotonic()
            self._signals.put(number)

    def begin(self, leave: Callable[[], object]) -> None:
        """Handle signals from now on; `leave` ends the program from the loop."""
        heard = [each for each in ENDING if signal.getsignal(each) != signal.SIG_IGN]  # by nohup
        if not self._app.is_web:
            heard += [each for each in (STOP, CONTINUE) if each is not None]
        for number in heard:
            signal.signal(number, self.hear)
        self._leave = leave
        self._loop = asyncio.get_running_loop()
        self._has_terminal = not is_gone()
        self._server = os.getppid()
        self.start()

    def run(self) -> None:
        while True:
            action = None
            with suppress(Empty):
                number = self._signals.get(timeout=1.0)  # s; then look at the terminal
                action = self._leave if number in ENDING else self._suspend
            if is_gone() if self._has_terminal else os.getppid() != self._server:
                action = self._leave
            with suppress(RuntimeError):  # the loop is closed: the program is ending
                if action:
                    self._loop.call_soon_threadsafe(action)
            if action == self._leave:
                time.sleep(5.0)  # by then the loop has ended the program, or is stuck
                self.end()

    def _suspend(self) -> None:
        """Stop, unless it has been continued already, and take the terminal back.

        After an unannounced stop a shell may have used it.
        """
        if self._must_stop or self._heard_at[CONTINUE] > self._taken_at:
            with self._app.suspend():
                if self._must_stop:
                    stop()
            self._taken_at = time.monotonic()

    @property
    def _must_stop(self) -> bool:
        return self._heard_at[CONTINUE] + MARGIN < self._heard_at[STOP]

    def end(self, sentence: str = "", code: Exit = Exit.INTERRUPTED) -> None:
        """End the program though its loop is stuck, maybe with a lock that closing waits for."""
        closing = Thread(target=self._finish, args=(sentence,), daemon=True)
        closing.start()
        closing.join(3.0)
        os._exit(code)

    def _finish(self, sentence: str) -> None:
        self._close()
        restore_terminal(self._terminal)
        if sentence:
            print(f"pendu-tui: {sentence}", file=sys.__stderr__, flush=True)
