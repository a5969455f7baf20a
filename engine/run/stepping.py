"""Stepping: converts between the lockstep's step size and each method's own.

At equal cost a method that needs fewer force evaluations takes a step of the lockstep in equal
parts, so that all methods need about as many: RK4 one step of h, the others four of h/4.

The parts hang on the cast alone, so that a step size and a switch say how a run goes on.  Of a
method whose cost varies, the usual cost counts: measured at each h and phase it would change the
steps of all the others on the way.
"""

import math
from bisect import bisect_left
from collections.abc import Sequence
from functools import cache
from operator import attrgetter
from typing import NamedTuple, Self

from engine.methods import USUAL_CAST, Cast, Method
from engine.scenes import check_h


class Stepping(NamedTuple):
    """How a run steps: its step size, whether at equal cost, and the methods that share it."""

    # s, of the lockstep, and so of the method that is not cut; negative: time runs backwards
    h: float
    equal_cost: bool = False
    cast: Cast = USUAL_CAST

    @property
    def parts(self) -> tuple[int, ...]:
        """Parts that each method divides a step into: at equal cost 4, 4, 4, 1 as a rule."""
        if self.equal_cost:
            return _parts(self.cast)
        return (1,) * len(self.cast)

    @property
    def own(self) -> tuple[float, ...]:
        """Each method's own step size [s], with its sign."""
        return tuple(self.h / part for part in self.parts)

    @property
    def smallest(self) -> float:
        """The smallest own step size, without its sign [s]: a scene's `h` at equal cost."""
        return min(map(abs, self.own))

    def with_own(self, method: Method, h: float) -> Self:
        """With |h| [s] as this method's step in the same direction; as h if it is not cast."""
        parts = self.parts[self.cast.index(method)] if method in self.cast else 1
        return self._replace(h=math.copysign(h * parts, self.h))

    def next(self, up: bool) -> Self:
        """With the smallest own step size on the next or previous rung of 1, 2, 5, 10, …"""
        return self.with_smallest(_next_rung(self.smallest, up))

    def with_smallest(self, h: float) -> Self:
        """With |h| [s] as the smallest own step size, in the same direction."""
        return self._replace(h=math.copysign(h * max(self.parts), self.h))

    def reversed(self) -> Self:
        """With time running the other way."""
        return self._replace(h=-self.h)

    def toggled(self) -> Self:
        """With equal cost switched on, or off; the smallest own step size stays."""
        return self._replace(equal_cost=not self.equal_cost).with_smallest(self.smallest)

    def check(self, w0: float) -> None:
        """Raise SceneError unless each method's own step suits the frequency w0 [rad/s]."""
        for h in dict.fromkeys((self.h, *self.own)):
            check_h(h, w0)


@cache
def _parts(cast: Cast) -> tuple[int, ...]:
    dearest = max((method.force_evaluations for method in cast), default=1)
    return tuple(max(1, round(dearest / method.force_evaluations)) for method in cast)


class SteppingChange(NamedTuple):
    """A change of how a run steps; the first of a run is its start's."""

    step: int  # before which it applies
    t: float  # s, simulated time there
    stepping: Stepping


def change_before(changes: Sequence[SteppingChange], step: int) -> SteppingChange:
    """The change that was in force on the way to a step."""
    return changes[max(bisect_left(changes, step, key=attrgetter("step")), 1) - 1]


def _next_rung(size: float, up: bool) -> float:
    """The next of 1, 2, 5, 10, … above a size, or below it."""
    decade = math.floor(math.log10(size))
    ladder = [
        digit * 10.0**power for power in (decade - 1, decade, decade + 1) for digit in (1, 2, 5)
    ]
    if up:
        rung = min(rung for rung in ladder if rung > size * (1 + 1e-9))
    else:
        rung = max(rung for rung in ladder if rung < size * (1 - 1e-9))
    return float(f"{rung:.1g}")
