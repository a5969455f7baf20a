"""Errors that cross: the more accurate of two methods becomes the less accurate, and stays so.

What is compared is the largest error so far, because within a swing the errors of most methods come back to 0.  A
method that gains or loses energy passes one that stays bounded for good; two that are bounded, or two that
are not, may pass each other again and again, which says nothing of either.
"""

from collections.abc import Mapping

from engine.run.bands import FLOOR
from engine.run.judging import Seen

LEAVING = ("grows", "loses")


class Crossings:
    """Watches the methods of a run for errors that cross."""

    def __init__(self) -> None:
        self._below: set[tuple[int, int]] = set()  # methods that leave, and bounded ones that they were below
        self._passed: set[tuple[int, int]] = set()  # once is enough

    def add(self, seen: Mapping[int, Seen]) -> list[tuple[int, int]]:
        """Take in one look at each method; the pairs (passing, passed) that are new since the last look."""
        bounded = [(other, found.peak) for other, found in seen.items() if found.verdict == "bounded"]
        leaving = [(index, found.peak) for index, found in seen.items() if found.verdict in LEAVING]
        pairs = {(index, other): mine - peak for index, mine in leaving for other, peak in bounded if peak > FLOOR}
        passed = [pair for pair in self._below - self._passed if pairs.get(pair, 0.0) > 0]
        self._below |= {pair for pair, ahead in pairs.items() if ahead <= 0}
        self._passed.update(passed)
        return sorted(passed)
