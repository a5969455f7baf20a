"""Handle signals and a lost terminal even while the event loop is stuck."""

import asyncio
import os
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from threading import Thread
from typing import Any

from textual.app import App

from pendu_tui.recordings import system
from pendu_tui.tui.cli.time_limit import watch
from pendu_tui.tui.terminal.check import is_gone

MARGIN = 0.1  # s; the order of two signals closer than this is unknown
MAX_STUCK = 5.0  # s from a request to end


class Watchdog:
    """Passes signals on to the event loop, and ends the program if the loop is stuck.

    Textual's own handlers would run in the middle of whatever Python does.  If that is a write to
    the terminal, their own write would wait for it for ever.
    """

    def __init__(self, app: App[Any], leave: Callable[[], object], close: Callable[[], object]):
        """`leave` ends the program from the loop; `close` ends the recording from any thread."""
        self._app = app
        self._actions = dict.fromkeys(system.ENDING, leave)
        self._close = close
        self._terminal = system.terminal_state()
        self._heard_at = {system.STOP: 0.0, system.CONTINUE: 0.0}  # s
        self._taken_at = 0.0  # s, the terminal
        self._left_at = 0.0  # s

    def begin(self) -> None:
        """Handle signals, and look at the terminal, from now on."""
        self._loop = asyncio.get_running_loop()
        if not self._app.is_web:
            self._actions |= {n: self._suspend for n in self._heard_at if n is not None}
        for number in self._actions:
            if signal.getsignal(number) != signal.SIG_IGN:  # as under nohup
                signal.signal(number, self.hear)
        self._has_terminal = not is_gone()
        self._server = os.getppid()
        watch().look = self._look
        watch().end = self.end

    def hear(self, number: int | None, frame: object = None) -> None:
        """Have the loop handle a signal, if this system has it."""
        if number is None:
            return
        self._heard_at[number] = time.monotonic()
        if number in system.ENDING:
            self._left_at = self._left_at or time.monotonic()
        with suppress(RuntimeError):  # the loop is closed: the program is ending
            self._loop.call_soon_threadsafe(self._actions[number])

    def _look(self) -> None:
        if is_gone() if self._has_terminal else os.getppid() != self._server:
            self.hear(signal.SIGTERM)
        if self._left_at and time.monotonic() > self._left_at + MAX_STUCK:
            self.end()

    def _suspend(self) -> None:
        """Stop, unless it has been continued already, and take the terminal back.

        After an unannounced stop a shell may have used it.
        """
        if self._must_stop or self._heard_at[system.CONTINUE] > self._taken_at:
            with self._app.suspend():
                if self._must_stop:
                    system.stop()
            self._taken_at = time.monotonic()

    @property
    def _must_stop(self) -> bool:
        return self._heard_at[system.CONTINUE] + MARGIN < self._heard_at[system.STOP]

    def end(self, sentence: str = "") -> None:
        """End the program though its loop is stuck, maybe with a lock that closing waits for."""
        finish = Thread(target=self._finish, args=(sentence,), daemon=True)
        finish.start()
        finish.join(3.0)
        os._exit(2 if sentence else 130)

    def _finish(self, sentence: str) -> None:
        self._close()
        system.restore_terminal(self._terminal)
        if sentence:
            print(f"pendu-tui: {sentence}", file=sys.__stderr__, flush=True)
