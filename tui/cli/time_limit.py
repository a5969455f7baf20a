"""Time limits for a user's own methods, where the platform can interrupt them.

SIGPROF ends the program if a call in C does not return.
"""

import faulthandler
import math
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from pendu_tui.engine.methods.own import OwnMethodError, TooLongError, UserCode

MAX_STEP_TIME = 3.0  # s
MAX_CALL_TIME = 5.0  # s of processor time for a call in C, which cannot be interrupted
LOOK_INTERVAL = 0.2  # s, between checks
PLAIN_SCREEN = "\x1b[<u\x1b[?1000;1003;1004;1006;2004l\x1b[?7;25h\x1b[?1049l"
"""Escape sequences that leave the alternate screen and stop mouse reports."""
_END_STUCK = f"""exec 3>&2 2>/dev/null
trap "" HUP INT TERM TSTP TTOU
state=$(stty -g </dev/tty)
read -r _ || exit
if [ "$(stty -g </dev/tty)" != "$state" ]
then stty "$state" </dev/tty; printf '{PLAIN_SCREEN}' >/dev/tty
fi
echo "pendu-tui: ended, for your method's call in C did not return; the recording is kept\
 as a .part." >&3
kill -KILL $PPID
"""


class _Watch:
    """Checks from time to time whether a user's code is still in the same step."""

    def __init__(self) -> None:
        self.deadline = math.inf  # s
        self.excess = ""  # the message after the deadline
        self._steps = -1
        self._since = 0.0  # s, when the current step was first seen

    def look(self, number: int, frame: FrameType | None) -> None:
        """Raise TooLongError in a user's code that takes too long."""
        signal.setitimer(signal.ITIMER_PROF, MAX_CALL_TIME)
        now = time.monotonic()
        if self._steps != UserCode.steps:
            self._steps = UserCode.steps
            self._since = now
        if not UserCode.is_running:
            return
        longest = MAX_STEP_TIME - LOOK_INTERVAL  # it may have begun up to an interval earlier
        if self._steps and now - self._since >= longest:
            raise TooLongError(f"takes more than {MAX_STEP_TIME:g} s for a step")
        if now >= self.deadline:
            raise TooLongError(self.excess)


_watch = _Watch()


@contextmanager
def limited_calls() -> Iterator[None]:
    """Have a shell end the program if a call in C does not return."""
    if not hasattr(signal, "SIGALRM"):
        yield
        return
    import subprocess

    with subprocess.Popen(["sh", "-c", _END_STUCK], stdin=subprocess.PIPE) as shell:
        assert shell.stdin
        faulthandler.register(signal.SIGPROF, shell.stdin, all_threads=False)
        try:
            yield
        finally:
            faulthandler.unregister(signal.SIGPROF)
            shell.kill()


@contextmanager
def limited_steps() -> Iterator[None]:
    """Interrupt any step of a user's method in the block that takes too long."""
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "SIGALRM"):
        yield
        return
    handler = signal.signal(signal.SIGALRM, _watch.look)
    timer = signal.setitimer(signal.ITIMER_REAL, LOOK_INTERVAL, LOOK_INTERVAL)
    calls = signal.setitimer(signal.ITIMER_PROF, MAX_CALL_TIME)
    try:
        yield
    except TooLongError as error:  # raised just after the step
        raise OwnMethodError(f"A method of your own {error}.") from None
    finally:
        signal.setitimer(signal.ITIMER_PROF, *calls)
        signal.setitimer(signal.ITIMER_REAL, *timer)
        signal.signal(signal.SIGALRM, handler)


@contextmanager
def limited(what: str, seconds: float | None = None) -> Iterator[None]:
    """Interrupt a user's methods if the whole block takes too long, by default as for one step."""
    seconds = seconds or MAX_STEP_TIME
    with limited_steps():
        _watch.excess = f"takes more than {seconds:g} s for {what}"
        _watch.deadline = (
            time.monotonic() + seconds + LOOK_INTERVAL
        )  # a single slow step is reported first
        try:
            yield
        finally:
            _watch.deadline = math.inf
