"""Clock readings -> how far to go.  Pure: the clock's readings are passed in."""

import math
from typing import NamedTuple


class Playhead(NamedTuple):
    """How far playback has come, in seconds of what is played."""

    position: float = 0.0  # s
    speed: float = 1.0  # seconds played per second of clock
    paused: bool = False
    seen: float | None = None  # s, the last clock reading

    def at(self, now: float) -> "Playhead":
        """Return the playhead at `now` [s] of a clock, which moves nothing by going back."""
        elapsed = 0.0 if self.seen is None or self.paused else max(0.0, now - self.seen)
        return Playhead(self.position + elapsed * self.speed, self.speed, self.paused, now)

    def moved_to(self, position: float) -> "Playhead":
        return self._replace(position=position)


class Pace(NamedTuple):
    """How much of what was due has been done, over about the last second of clock."""

    due: float = 0.0
    done: float = 0.0

    def after(self, elapsed: float, due: float, done: float) -> "Pace":
        """The pace `elapsed` seconds later, when so much more was due and so much of it done."""
        kept = math.exp(-elapsed)
        return Pace(self.due * kept + due, self.done * kept + done)

    @property
    def share(self) -> float:
        """1: in real time; below, the processor cannot follow."""
        return self.done / self.due if self.due > 0 else 1.0


SPEED_LIMITS = (2.0**-10, 2.0**20)


def doubled(speed: float, times: int) -> float:
    """The speed doubled so many times, halved if negative, within SPEED_LIMITS; its sign stays."""
    low, high = SPEED_LIMITS
    return math.copysign(min(max(abs(speed) * 2.0**times, low), high), speed)
