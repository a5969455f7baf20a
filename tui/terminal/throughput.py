"""The wire to the terminal: how much it carries, from how long it keeps whoever writes to it waiting."""

import math
from collections import deque

SYSTEMS = 12_000  # bytes that the system takes for a terminal before one has to wait; nobody tells how many wait there
WAIT = 0.03  # s that a write takes on a line that is full; less may be this computer's doing
LEAST = 4_000  # bytes/s; what looks slower has come to a stand
ROOM = 16_000  # bytes that have to go before whoever waits is told that there is room again
SLACK = 0.02  # s of what is on its way that are as good as nothing
CAUTION = 0.8  # of what the line may carry
FORTH = 0.02  # more every second, until one waits again: the line may have become better
TWICE, FORGOTTEN = 1.0, 300.0  # s; one wait alone may be a stall of a fast terminal, and two may be chance


class Throughput:
    """Knows what is on its way.  More than the line carries only makes every frame later by what waits.

    `written` may be called from another thread.
    """

    def __init__(self) -> None:
        self.rate = math.inf  # bytes/s that are safe
        self._sent = self._written = 0  # bytes
        self._on_its_way = 0.0  # bytes, the system's included
        self._waits: deque[tuple[float, float, float, int]] = deque()  # from, to, bytes/s then, bytes so far
        self._full = -math.inf, 0  # when the system was last known to have all it takes, and the bytes so far
        self._seen: float | None = None  # s, the clock

    @property
    def is_slow(self) -> bool:
        """Whether there was too much on it lately."""
        return self.rate < math.inf

    @property
    def is_full(self) -> bool:
        """Whether something has not been written yet."""
        return self._sent > self._written

    def send(self, size: int) -> None:
        """So many bytes are to be written."""
        self._sent += size
        self._on_its_way += size

    def written(self, size: int, began: float, now: float) -> None:
        """So many have been, from one time [s] to another."""
        self._written += size
        if now - began > WAIT and size > LEAST * (now - began):
            self._waits.append((began, now, (size + ROOM) / (now - began), self._written))

    @property
    def is_busy(self) -> bool:
        """Whether something is on its way still."""
        return self.is_full or self._on_its_way > SLACK * self.rate

    def restart(self) -> None:
        """Nothing is waiting: somebody else writes from now on."""
        self._written = self._sent

    def tick(self, now: float) -> None:
        """It is so late [s]."""
        elapsed, self._seen = 0.0 if self._seen is None else now - self._seen, now
        if elapsed:
            self.rate = self.rate * (1 + FORTH * elapsed) if now - self._full[0] < FORGOTTEN else math.inf
            self._on_its_way = max(0.0, self._on_its_way - self.rate * elapsed)
        while self._waits:
            began, at, most, written = (
                self._waits.popleft()
            )  # at most, since some of the write may have found room at once
            (before, so_far), self._full = self._full, (at, written)
            if self.is_slow or began - before < TWICE:
                least = (written - so_far) / (at - before)
                self.rate = CAUTION * max(least, min(self.rate, most))
                self._on_its_way = SYSTEMS + self._sent - self._written
