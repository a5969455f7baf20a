"""The wire to the terminal: how much it carries, as far as one can tell from how often one has to wait for it."""

import math

SYSTEMS = 12_000  # bytes that the system takes for a terminal before one has to wait; nobody tells how many wait there
LEAST = 4_000  # bytes/s; what looks slower has come to a stand
LONGEST = 0.1  # s of waiting that one look at it can tell of: after Ctrl+Z nobody had looked
SLACK = 0.02  # s of what is on its way that are as good as nothing
BACK = 0.7  # of what was too much
FORTH = 0.03  # more every second where it is not


class Wire:
    """Knows what is on its way.  Where one always waits, one has sent too much: every frame comes late by what waits.

    So less is sent than has been carried, and a little more again with time: the line may have become better.
    """

    def __init__(self) -> None:
        self.rate = math.inf  # bytes/s, at most
        self._on_its_way = self._last_second = 0.0  # bytes
        self._waits = 0.0  # share of the time
        self._tried = False  # whether anything has been sent since less is sent
        self._seen: float | None = None  # s, the clock

    @property
    def has_been_slow(self) -> bool:
        """Whether there was ever too much on it."""
        return self.rate < math.inf

    def send(self, size: int) -> None:
        """So many bytes are sent."""
        self._on_its_way += size
        self._last_second += size
        self._tried = True

    def is_busy(self, waiting: bool, now: float) -> bool:
        """Whether something is on its way at a time [s], when something is waiting to be sent or not."""
        elapsed, self._seen = 0.0 if self._seen is None else now - self._seen, now
        self._waits += (waiting - self._waits) * (1 - math.exp(-min(elapsed, LONGEST) / 0.3))
        self._last_second *= math.exp(-elapsed)
        self.rate *= 1 + FORTH * elapsed
        self._on_its_way = max(0.0, self._on_its_way - self.rate * elapsed) if elapsed else self._on_its_way
        if self._waits > 1 / 3 and self._tried:
            self._tried, self._waits = False, 0.0
            self.rate = max(LEAST, BACK * min(self.rate, self._last_second))
            self._on_its_way = SYSTEMS
        return waiting or self._on_its_way > SLACK * self.rate
