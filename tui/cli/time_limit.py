"""Time limits for a user's own methods, where the platform can interrupt them."""

import math
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from engine.methods.own import OwnMethodError, TooLongError, UserCode

MAX_STEP_TIME = 3.0  # s
LOOK_INTERVAL = 0.2  # s


class _Watch:
    """Compares what a user's code does with what it did at the last look."""

    def __init__(self) -> None:
        self.deadline = math.inf  # s
        self.excess = ""  # what to say after it
        self._steps = -1
        self._since = 0.0  # s, when the current step was seen first

    def look(self, number: int, frame: FrameType | None) -> None:
        """Raise TooLongError in a user's code whose time is over."""
        now = time.monotonic()
        if self._steps != UserCode.steps:
            self._steps = UserCode.steps
            self._since = now
        if not UserCode.is_running:
            return
        longest = MAX_STEP_TIME - LOOK_INTERVAL  # it may have begun so long before it was seen
        if self._steps and now - self._since >= longest:
            raise TooLongError(f"takes more than {MAX_STEP_TIME:g} s for a step")
        if now >= self.deadline:
            raise TooLongError(self.excess)


_watch = _Watch()


@contextmanager
def limited_steps() -> Iterator[None]:
    """Interrupt each step of a user's method in the block that takes too long."""
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "SIGALRM"):
        yield
        return
    handler = signal.signal(signal.SIGALRM, _watch.look)
    timer = signal.setitimer(signal.ITIMER_REAL, LOOK_INTERVAL, LOOK_INTERVAL)
    try:
        yield
    except TooLongError as error:  # raised just when the step was done
        raise OwnMethodError(f"A method of your own {error}.") from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, *timer)
        signal.signal(signal.SIGALRM, handler)


@contextmanager
def limited(what: str, seconds: float | None = None) -> Iterator[None]:
    """Interrupt a user's methods also if the block takes longer, by default than one step may."""
    seconds = seconds or MAX_STEP_TIME
    with limited_steps():
        _watch.excess = f"takes more than {seconds:g} s for {what}"
        _watch.deadline = time.monotonic() + seconds + LOOK_INTERVAL  # a single step is told first
        try:
            yield
        finally:
            _watch.deadline = math.inf
