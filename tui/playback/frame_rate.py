"""FrameTimer: as many frames a second as are wanted, or as few as the machine can paint evenly."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

SLOWER = (20, 15, 10)  # frames a second, where the wanted ones come late
LATE, ON_TIME = 1.2, 1.07  # times the interval that is due, over a second
ROOM = 0.6  # of a core, which frames at the next higher rate may take
PATIENCE, AGAIN, MOST_PATIENCE = 4.0, 10.0, 64.0  # s on time before a higher rate; twice that if it was too high
RESTING = 4  # frames a second while nothing moves
GAP = 1.0  # s; a longer one was a stop, and no frame was late


class _Window(NamedTuple):
    """A second or so that frames are counted in."""

    began: float  # s, of the clock
    processor: float  # s, used up to then
    frames: int = 0


class FrameRate:
    """Judges a second's frames at a time.  The clock and the processor time used so far are passed in."""

    def __init__(self, wanted: int) -> None:
        self.rate = wanted
        """Frames a second."""
        self._rates = [wanted, *(rate for rate in SLOWER if rate < wanted)]
        self._window = _Window(0.0, 0.0)
        self._seen: float | None = None
        self._fine = 0.0  # s on time
        self._patience = PATIENCE
        self._raised: float | None = None  # when it was last raised

    @property
    def is_slow(self) -> bool:
        """Whether there are fewer frames than wanted."""
        return self.rate < self._rates[0]

    def frame(self, now: float, processor: float) -> bool:
        """Count a frame; whether the rate has changed."""
        if self._seen is None or now - self._seen > GAP:
            self._window = _Window(now, processor)
        else:
            self._window = self._window._replace(frames=self._window.frames + 1)
        self._seen, before, at = now, self.rate, self._rates.index(self.rate)
        elapsed = now - self._window.began
        if self._window.frames < self.rate or elapsed <= 0:
            return False
        late, share = elapsed * self.rate / self._window.frames, (processor - self._window.processor) / elapsed
        self._window = _Window(now, processor)
        self._fine = self._fine + elapsed if late < ON_TIME else 0.0
        if late > LATE and at + 1 < len(self._rates):
            too_high = self._raised is not None and now - self._raised < AGAIN
            self._patience = min(2 * self._patience, MOST_PATIENCE) if too_high else PATIENCE
            self.rate = self._rates[at + 1]
        elif at and self._fine >= self._patience and share * self._rates[at - 1] / self.rate < ROOM:
            self.rate, self._raised, self._fine = self._rates[at - 1], now, 0.0
        return self.rate != before


class Timer(Protocol):
    """What calls for frames."""

    def stop(self) -> None:
        """Call no more."""


class FrameTimer:
    """Calls for frames at the rate that is right, and for few of them while only a key can change what is shown."""

    def __init__(self, start: Callable[[float], Timer]) -> None:
        """`start` has a timer call every so many seconds."""
        self._start, self._resting = start, False
        self._rate = FrameRate(1)
        self._timer: Timer | None = None

    def begin(self, wanted: int) -> None:
        """Call for so many frames a second, if possible."""
        self._rate = FrameRate(wanted)
        self._timer = self._start(1 / wanted)

    @property
    def lowered(self) -> int | None:
        """The frames a second, where there are fewer than wanted."""
        return self._rate.rate if self._rate.is_slow else None

    def is_turn(self, frames: int, times: int) -> bool:
        """Whether it is this frame's turn to do what is done so many times a second."""
        return frames % max(self._rate.rate // times, 1) == 0

    def frame(self, now: float, processor: float) -> bool:
        changed = not self._resting and self._timer is not None and self._rate.frame(now, processor)
        if changed:
            self._restart()
        return changed

    def rest(self, resting: bool) -> None:
        """Nothing moves from now on, or something does."""
        if resting != self._resting and self._timer is not None:
            self._resting = resting
            self._restart()

    def _restart(self) -> None:
        self.stop()
        self._timer = self._start(1 / (RESTING if self._resting else self._rate.rate))

    def stop(self) -> None:
        if self._timer is not None:
            self._timer.stop()
