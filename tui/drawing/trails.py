"""Trails: where some points have been lately, drawn dot by dot on a ground that does not move."""

from collections import Counter, deque
from collections.abc import Sequence

from tui.drawing.canvas import Canvas


class Trails:
    """A trail for each owner, later owners in front, kept from frame to frame.

    A frame adds a dot to each trail and takes its oldest away, which is less work than to draw hundreds of them anew.
    """

    def __init__(self, ground: Canvas, owners: Sequence[int], length: int) -> None:
        """On a copy of the ground; each trail has so many dots at most."""
        self.canvas = ground.copy()
        self._ground, self._owners, self._length = ground, owners, length
        self._rows: deque[list[int | None]] = deque()  # dots, oldest first
        self._dots = Counter[int]()  # how many points share a dot
        self._shares: dict[int, list[int]] = {}  # of each owner in the dots of a cell

    def add(self, points: Sequence[tuple[float, float]]) -> None:
        """Let each trail go on to a point x, y in dots; one that is outside or not finite leaves no dot."""
        if len(self._rows) == self._length:
            for owner, dot in enumerate(self._rows.popleft()):
                self._count(owner, dot, -1)
        dots = [self.canvas.dot(x, y) for x, y in points]
        for owner, dot in enumerate(dots):
            self._count(owner, dot, 1)
        self._rows.append(dots)

    def _count(self, owner: int, dot: int | None, points: int) -> None:
        """Add points to a dot, or take them away."""
        if dot is None:
            return
        self._dots[dot] += points
        shares = self._shares.setdefault(dot >> 3, [0] * len(self._owners))
        shares[owner] += points
        on, front = self._ground.at(dot)
        for share, one in zip(shares, self._owners, strict=True):
            front = one if share else front
        self.canvas.put(dot, on or self._dots[dot] > 0, front)
