"""Time limits for a user's own methods: a thread interrupts them, or another process this one."""

import ctypes
import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache

from pendu_tui.engine.methods.own import USER_CODE, OwnMethodError, TooLongError
from pendu_tui.tui.cli.errors import Exit

MAX_TIME = 3.0  # s
LOOK_INTERVAL = 0.2  # s
STEP = "a step"


class Watch(threading.Thread):
    """Looks from time to time whether a user's code is still in the same step, or in the block."""

    @staticmethod
    def end(sentence: str, code: Exit) -> None:
        """End the program, whose user's code cannot be interrupted."""
        print(f"pendu-tui: {sentence}", file=sys.__stderr__, flush=True)
        os._exit(code)

    def __init__(self) -> None:
        super().__init__(name="time limit", daemon=True)
        self.guard = threading.Lock()
        self.what = STEP  # what must not take long
        self.pulse = -1  # the descriptor of the watcher's stdin
        self.looks = 0  # counted, since the clock goes on while the program is stopped

    def begin(self, what: str) -> None:
        with self.guard:
            self.what = what
            self.looks = 0
            _raise_in_main(None)

    def run(self) -> None:
        steps = 0
        while True:
            time.sleep(LOOK_INTERVAL)
            if self.pulse >= 0:
                with suppress(OSError):  # somebody killed it
                    os.write(self.pulse, b".")
            with self.guard:
                self.looks += 1
                if self.what == STEP and (steps != USER_CODE.steps or not USER_CODE.is_running):
                    self.looks = 0
                steps = USER_CODE.steps
                if self.looks * LOOK_INTERVAL >= MAX_TIME and USER_CODE.is_running:
                    TooLongError.why = f"takes more than {MAX_TIME:g} s for {self.what}"
                    _raise_in_main(TooLongError)
            if self.looks * LOOK_INTERVAL >= 2 * MAX_TIME and USER_CODE.is_running:
                Watch.end(f"ended, for your method {TooLongError.why}.", Exit.USAGE)


@cache
def watch() -> Watch:
    """Return the process's only watch, which has begun."""
    thread = Watch()
    thread.start()
    return thread


def _raise_in_main(error: type[BaseException] | None) -> None:
    """Raise an error in the main thread's next line of Python, or drop one not yet raised."""
    thread = ctypes.c_ulong(threading.main_thread().ident or 0)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, error and ctypes.py_object(error))


@contextmanager
def limited(what: str = STEP) -> Iterator[None]:
    """Interrupt a user's methods if the block takes too long, by default if a step does.

    Raises OwnMethodError then.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = watch().what
    watch().begin(what)
    try:
        yield
    except TooLongError as error:  # raised just after the step
        raise OwnMethodError(f"A method of your own {error}.") from None
    finally:
        watch().begin(before)


@contextmanager
def watched() -> Iterator[None]:
    """Have another process end this one if a call in C keeps the interpreter for itself."""
    watcher = [sys.executable, "-P", "-m", "pendu_tui.tui.terminal.watcher", str(os.getpid())]
    with subprocess.Popen(watcher, stdin=subprocess.PIPE, start_new_session=True) as process:
        assert process.stdin
        watch().pulse = process.stdin.fileno()
        try:
            yield
        finally:
            watch().pulse = -1
