"""The watchdog: a thread that interrupts a user's method, or ends a program that is stuck.

A call in C may keep the interpreter and stop this thread, too: another process notices that.
"""

import os
import signal
import sys
import time
from _thread import interrupt_main
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from threading import Thread, Timer, main_thread
from traceback import walk_stack
from typing import Any

from pendu_tui.engine.methods.own import MAX_TIME, USER_CODE, OwnMethodError, TooLongError, place
from pendu_tui.recordings import system

LOOK_INTERVAL = 0.2  # s
MAX_LOOKS = round(MAX_TIME / LOOK_INTERVAL)  # counted, since a stopped program's clock goes on
MAX_STUCK = 5.0  # s, the event loop after a signal, or the whole process
ALARM = signal.SIGABRT  # an abort() in C still ends the process


class Watchdog(Thread):
    """Looks five times a second at the user's code, and at a lab's event loop and terminal."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.pulse: Callable[[None], object] = bool  # to the other process
        self.close: Callable[[], object] = bool  # called before the program is ended
        self.tell: Callable[[str], object] = _tell  # called with the reason
        self._look: Callable[[], object] = bool
        self._terminal = system.terminal_state()
        self._asked_at = 0.0  # s, to end

    def run(self) -> None:
        step = looks = 0
        while True:
            time.sleep(LOOK_INTERVAL)
            looks = looks + 1 if USER_CODE.depth and USER_CODE.count == step else 0
            step = USER_CODE.count
            if looks == MAX_LOOKS:
                interrupt_main(ALARM)
            elif looks == MAX_LOOKS + 3:  # it sleeps, or catches everything
                self.end(3, f"{_place_in_main()} {TooLongError()}.")
            self._look()
            with suppress(OSError):  # the other process has ended
                self.pulse(None)

    def guard(self, loop: Any, leave: Callable[[], object], close: Callable[[], object]) -> None:
        """Have a lab leave when a signal asks for it, or when its terminal or its server is gone.

        `leave` is called in the event loop; `close` ends the recording from any thread.
        """

        def surroundings() -> tuple[bool, int]:
            return system.is_gone(), os.getppid()

        def ask(*_: object) -> None:
            self._asked_at = self._asked_at or time.monotonic()
            with suppress(RuntimeError):  # the loop is closed: the program is ending
                loop.call_soon_threadsafe(leave)

        def look() -> None:
            if surroundings() != before:
                ask()
            if self._asked_at and time.monotonic() > self._asked_at + MAX_STUCK:
                self.end(130)

        before = surroundings()
        for number in system.ENDING:
            if signal.getsignal(number) != signal.SIG_IGN:  # as under nohup
                signal.signal(number, ask)
        self.close = close
        self._look = look

    def end(self, code: int, sentence: str = "") -> None:
        """End the program, after 3 s even if a disk or the terminal blocks."""
        Timer(3.0, os._exit, (code,)).start()
        self.close()
        system.restore_terminal(self._terminal)
        if sentence:
            self.tell(sentence)
        os._exit(code)


def _tell(sentence: str) -> None:
    print(f"pendu-tui: {sentence}", file=sys.__stderr__, flush=True)


@cache
def watchdog() -> Watchdog:
    """Return the process's only watchdog, which has begun."""
    with suppress(ValueError):  # another thread, of a Dask worker, which will be ended
        signal.signal(ALARM, _interrupt)
    thread = Watchdog()
    thread.start()
    return thread


def _interrupt(*_: object) -> None:
    if USER_CODE.depth:  # or the step has just ended
        raise TooLongError


def _place_in_main() -> str:
    """Return the line of the user's file that the main thread executes."""
    for frame, line in walk_stack(sys._current_frames().get(main_thread().ident or 0)):
        if frame.f_globals.get("__name__") == "own_method":
            return place(frame.f_code.co_filename, line)
    return "your method"


@contextmanager
def limited() -> Iterator[None]:
    """Limit the time of a block as that of a step.  Raises OwnMethodError."""
    watchdog()
    try:
        with USER_CODE:
            yield
    except TooLongError as error:  # raised between steps
        raise OwnMethodError(f"A method of your own {error}.") from None
    finally:
        USER_CODE.depth = 0


def watch_calls_in_c() -> None:
    """Have another process end this one if a call in C keeps the interpreter."""
    from pendu_tui.tui.cli.workers import started  # multiprocessing takes 15 ms

    _, connection = started(_end_if_silent, os.getpid())
    watchdog().pulse = connection.send


def _end_if_silent(pulse: Any, process: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    terminal = system.terminal_state()
    silence = 0  # s
    with suppress(EOFError, OSError):  # it has ended
        while silence < MAX_STUCK:
            if pulse.poll(1.0):
                pulse.recv()
                silence = 0
            elif not system.is_stopped(process):
                silence += 1
        system.restore_terminal(terminal)
        why = "a call in C in your method does not return; a recording is kept as a .part"
        _tell(f"ended: {why}.")
        system.kill(process, 3)
