"""The watch on a user's own methods: a thread interrupts them, another process ends this one."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from itertools import count
from threading import Thread, main_thread
from typing import IO

from pendu_tui.engine.methods.own import USER_CODE, OwnMethodError, TooLongError

MAX_TIME = 3.0  # s, for a step
LOOK_INTERVAL = 0.2  # s
_blocks = count(-1, -1)  # no numbers of steps


def _end(sentence: str) -> None:
    print(f"pendu-tui: {sentence}", file=sys.__stderr__, flush=True)
    os._exit(2)


class Watch(Thread):
    """Looks five times a second whether a user's code is still in the same step."""

    def __init__(self) -> None:
        super().__init__(name="watch", daemon=True)
        self.block = 0  # the number of a block that counts as one step
        self.pulse: IO[bytes] | None = None  # shows the watcher that this process lives
        self.look: Callable[[], object] = bool  # what else to look at
        self.end: Callable[[str], object] = _end

    def run(self) -> None:
        step = looks = 0  # counted, since the clock goes on while the program is stopped
        while True:
            time.sleep(LOOK_INTERVAL)
            now = self.block or USER_CODE.steps
            looks = looks + 1 if now == step and (USER_CODE.is_running or self.block) else 0
            step = now
            if looks * LOOK_INTERVAL >= MAX_TIME and USER_CODE.is_running:
                TooLongError.why = f"takes more than {MAX_TIME:g} s"
                _raise_in_main(TooLongError)
            if looks * LOOK_INTERVAL >= 2 * MAX_TIME and USER_CODE.is_running:
                self.end(f"ended, for your method {TooLongError.why}.")
            self.look()
            if self.pulse:
                with suppress(OSError, ValueError):  # the watcher has ended
                    self.pulse.write(b".")
                    self.pulse.flush()


@cache
def watch() -> Watch:
    """Return the process's only watch, which has begun."""
    thread = Watch()
    thread.start()
    return thread


def _raise_in_main(error: type[BaseException] | None) -> None:
    """Raise an error at the main thread's next line of Python, or drop one not yet raised."""
    import ctypes  # the first paint needs none

    thread = ctypes.c_ulong(main_thread().ident or 0)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, error and ctypes.py_object(error))


@contextmanager
def limited() -> Iterator[None]:
    """Limit the time of a block as that of a step.  Raises OwnMethodError."""
    watch().block = next(_blocks)
    try:
        yield
    except TooLongError as error:  # raised just after the user's code
        raise OwnMethodError(f"A method of your own {error}.") from None
    finally:
        watch().block = 0
        _raise_in_main(None)


@contextmanager
def watched() -> Iterator[None]:
    """Have another process end this one if a call in C keeps the interpreter for itself."""
    watcher = [sys.executable, "-P", "-m", "pendu_tui.tui.terminal.watcher", str(os.getpid())]
    with subprocess.Popen(watcher, stdin=subprocess.PIPE, start_new_session=True) as process:
        assert process.stdin
        watch().pulse = process.stdin  # no number, which another file may get once it is closed
        yield
