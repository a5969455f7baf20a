"""Handle signals and a lost terminal even while the event loop is stuck."""

import os
import select
import signal
import time
from asyncio import AbstractEventLoop
from collections.abc import Callable
from contextlib import AbstractContextManager, suppress
from threading import Thread

from pendu_tui.tui.cli.errors import Exit
from pendu_tui.tui.cli.files import ENDING
from pendu_tui.tui.cli.time_limit import PLAIN_SCREEN
from pendu_tui.tui.terminal.check import is_gone

MARGIN = 0.1  # s; the order of two signals closer than this is unknown


class Job:
    """The program as a shell's job, which can be stopped and continued."""

    def __init__(self, suspend: Callable[[], AbstractContextManager[None]]) -> None:
        """`suspend` is a context that gives the terminal back."""
        self._suspend = suspend
        self._asked_at = 0.0  # s, to stop
        self._continued_at = 0.0  # s
        self._taken_at = 0.0  # s, the terminal

    def ask(self, *_: object) -> None:
        self._asked_at = time.monotonic()

    def go_on(self, *_: object) -> None:
        self._continued_at = time.monotonic()

    def stop(self) -> None:
        """Stop, unless the program has been continued already, and then take the terminal back."""
        if self._is_due:
            with self._suspend():
                if self._is_due:
                    os.kill(os.getpid(), signal.SIGSTOP)
            self._taken_at = time.monotonic()

    @property
    def _is_due(self) -> bool:
        return self._continued_at + MARGIN < self._asked_at

    def take_terminal(self) -> None:
        """Set the terminal up again after an unannounced stop, as a shell may have used it."""
        if self._continued_at > self._taken_at:
            with self._suspend():
                pass
            self._taken_at = time.monotonic()


class SignalThread(Thread):
    """Passes signals on to the event loop, and ends the program if the loop is stuck.

    Textual's own handlers would run in the middle of whatever Python does.  If that is a write to
    the terminal, their own write would wait for it for ever.
    """

    def __init__(
        self,
        loop: AbstractEventLoop,
        leave: Callable[[], object],
        close: Callable[[], object],
        job: Job | None,
    ) -> None:
        """`leave` ends the program from the loop; `close` ends the recording from any thread."""
        super().__init__(name="signals", daemon=True)
        self._loop = loop
        self._leave = leave
        self._close = close
        self._has_terminal = not is_gone()
        self._server = os.getppid()
        self._pipe, written = os.pipe()
        os.set_blocking(written, False)
        signal.set_wakeup_fd(written, warn_on_full_buffer=False)
        self._handlers: dict[int, Callable[[], object]] = {}
        for number in ENDING:
            if signal.getsignal(number) != signal.SIG_IGN:  # ignored, as under nohup
                self._handlers[number] = leave
                signal.signal(number, lambda *_: None)
        if job is not None:
            self._handlers |= {signal.SIGTSTP: job.stop, signal.SIGCONT: job.take_terminal}
            signal.signal(signal.SIGTSTP, job.ask)
            signal.signal(signal.SIGCONT, job.go_on)

    def run(self) -> None:
        while True:
            # check the terminal each second
            ready, _, _ = select.select([self._pipe], [], [], 1.0)
            numbers = b""
            if ready:
                numbers = os.read(self._pipe, 4096)
            called = [self._handlers[number] for number in numbers if number in self._handlers]
            if is_gone() if self._has_terminal else os.getppid() != self._server:
                called.append(self._leave)
            with suppress(RuntimeError):  # the loop is closed: the program is ending
                for handler in called:
                    self._loop.call_soon_threadsafe(handler)
            if self._leave in called:
                time.sleep(5.0)  # by then the loop has ended the program, or is stuck
                closing = Thread(
                    target=self._end, daemon=True
                )  # it may wait for a lock that the loop holds
                closing.start()
                closing.join(3.0)
                os._exit(Exit.INTERRUPTED)

    def _end(self) -> None:
        """Finish the recording and reset the terminal for the shell."""
        self._close()
        os.system(
            f"stty icrnl ixon echo icanon iexten isig 2>/dev/null && printf '{PLAIN_SCREEN}' >&2"
        )
