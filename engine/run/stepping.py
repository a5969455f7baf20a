"""Stepping: the lockstep's step size, and each method's own.

At equal cost a method that needs fewer force evaluations takes a step of the lockstep in equal
parts, so that all methods need about as many: RK4 one step of h, the others four of h/4.

The parts depend on the cast alone.  A method whose cost varies counts with its usual cost; the
actual one would change the steps of all other methods on the way.
"""

import math
from bisect import bisect_left
from collections.abc import Sequence
from functools import cache
from operator import attrgetter
from typing import NamedTuple, Self

from pendu_tui.engine.methods import USUAL_CAST, Cast, Method
from pendu_tui.engine.scenes import check_h


class Stepping(NamedTuple):
    """How a run steps: its step size, whether at equal cost, and the methods that share it."""

    h: float  # s, of the lockstep; negative: time runs backwards
    equal_cost: bool = False
    cast: Cast = USUAL_CAST

    @property
    def parts(self) -> tuple[int, ...]:
        """The parts into which each method divides a step."""
        if self.equal_cost:
            return _parts(self.cast)
        return (1,) * len(self.cast)

    @property
    def own(self) -> tuple[float, ...]:
        """Each method's own step size [s], signed."""
        return tuple(self.h / part for part in self.parts)

    @property
    def symbol(self) -> str:
        """The symbol of `h`; at equal cost, it is the largest of the methods."""
        return "max " * self.equal_cost + "h"

    @property
    def smallest(self) -> float:
        """The smallest own |step size| [s]: a scene's `h` at equal cost."""
        return min(map(abs, self.own))

    def with_own(self, method: Method, h: float) -> Self:
        """Return the stepping in which this method's own |h| [s] is the given one."""
        parts = self.parts[self.cast.index(method)] if method in self.cast else 1
        return self._replace(h=math.copysign(h * parts, self.h))

    def next(self, up: bool) -> Self:
        """Return the stepping whose smallest own |h| is the next or previous of 1, 2, 5, 10, …"""
        size = self.smallest
        decade = math.floor(math.log10(size))
        powers = (decade - 1, decade, decade + 1)
        ladder = [digit * 10.0**power for power in powers for digit in (1, 2, 5)]
        if up:
            rung = min(rung for rung in ladder if rung > size * (1 + 1e-9))
        else:
            rung = max(rung for rung in ladder if rung < size * (1 - 1e-9))
        return self.with_smallest(float(f"{rung:.1g}"))

    def with_smallest(self, h: float) -> Self:
        """Return the stepping whose smallest own |h| [s] is the given one."""
        return self._replace(h=math.copysign(h * max(self.parts), self.h))

    def reversed(self) -> Self:
        """Return the stepping with time running the other way."""
        return self._replace(h=-self.h)

    def toggled(self) -> Self:
        """Return the stepping with equal cost switched; the smallest own |h| stays."""
        return self._replace(equal_cost=not self.equal_cost).with_smallest(self.smallest)

    def check(self, w0: float) -> None:
        """Raise InputError unless each own step suits the frequency w0 [rad/s]."""
        for h in dict.fromkeys((self.h, *self.own)):
            check_h(h, w0)


@cache
def _parts(cast: Cast) -> tuple[int, ...]:
    dearest = max(method.force_evaluations for method in cast)
    return tuple(round(dearest / method.force_evaluations) for method in cast)


class SteppingChange(NamedTuple):
    """A change of a run's stepping; the first is that of its start."""

    step: int  # it applies from here on
    t: float  # s, simulated
    stepping: Stepping
    x: float = 0.0  # s, the simulated time covered so far, which grows even while t goes back

    def x_at(self, t: float) -> float:
        """Return the simulated time [s] covered up to t, before the next change."""
        return self.x + abs(t - self.t)


def change_before(changes: Sequence[SteppingChange], step: int) -> SteppingChange:
    """Return the change that was in force on the way to a step."""
    return changes[max(bisect_left(changes, step, key=attrgetter("step")), 1) - 1]
