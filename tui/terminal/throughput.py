"""Throughput: how many bytes a second the line to the terminal carries, from how long writes are blocked."""

import math
from collections import deque

SYSTEM_BUFFER = 12_000  # bytes held for a terminal before a write blocks; how full it is cannot be queried
WAIT = 0.03  # s that a write takes on a full line; a shorter one may be this computer's doing
LEAST = 4_000  # bytes/s; a line that seems slower has stalled
ROOM = 16_000  # bytes that must drain before a blocked write returns
SLACK = 0.02  # s of bytes on their way that count as none
CAUTION = 0.8  # the share of the estimate that is used
GROWTH = 0.02  # of the rate, every second until a write blocks again: the line may have improved
TWICE, FORGOTTEN = 1.0, 300.0  # s; a single blocked write may be a stall of a fast terminal, and two may be chance


class Throughput:
    """Knows how many bytes are on their way: sending more than the line carries only delays every frame.

    `written` may be called from another thread.
    """

    def __init__(self) -> None:
        self.rate = math.inf  # bytes/s that are safe
        self._sent = self._written = 0  # bytes
        self._on_its_way = 0.0  # bytes, the system's buffer included
        self._waits: deque[tuple[float, float, float, int]] = deque()  # from, to, bytes/s then, bytes so far
        self._full = -math.inf, 0  # when the system's buffer was last known to be full, and the bytes so far
        self._seen: float | None = None  # s, the clock

    @property
    def is_slow(self) -> bool:
        """Whether writes were blocked lately."""
        return self.rate < math.inf

    @property
    def is_full(self) -> bool:
        """Whether bytes wait to be written."""
        return self._sent > self._written

    def send(self, size: int) -> None:
        """Note bytes that are to be written."""
        self._sent += size
        self._on_its_way += size

    def written(self, size: int, began: float, now: float) -> None:
        """Note bytes that were written, between two times [s]."""
        self._written += size
        if now - began > WAIT and size > LEAST * (now - began):
            self._waits.append((began, now, (size + ROOM) / (now - began), self._written))

    @property
    def is_busy(self) -> bool:
        """Whether bytes are still on their way, the system's buffer included."""
        return self.is_full or self._on_its_way > SLACK * self.rate

    def restart(self) -> None:
        """Forget what was not written: another writer takes over."""
        self._written = self._sent

    def tick(self, now: float) -> None:
        """Bring the estimate up to the time `now` [s]."""
        elapsed, self._seen = 0.0 if self._seen is None else now - self._seen, now
        if elapsed:
            self.rate = self.rate * (1 + GROWTH * elapsed) if now - self._full[0] < FORGOTTEN else math.inf
            self._on_its_way = max(0.0, self._on_its_way - self.rate * elapsed)
        while self._waits:
            began, at, most, written = self._waits.popleft()  # most: some of the write may have found room at once
            (before, so_far), self._full = self._full, (at, written)
            if self.is_slow or began - before < TWICE:
                least = (written - so_far) / (at - before)
                self.rate = CAUTION * max(least, min(self.rate, most))
                self._on_its_way = SYSTEM_BUFFER + self._sent - self._written
