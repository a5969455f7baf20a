"""A reference where there is no closed form: Kahan and Li's order 8 in its own steps.

Kahan & Li, Math. Comput. 66 (1997) 1089: a symmetric step of order 2 with 17 fractions of h in
turn.
"""

import math
from collections.abc import Callable

from engine.models.model import Force, Phase

Step = Callable[[Phase, float], Phase]
"""(phase, h) -> the phase after h [s]."""

_HALF = (
    0.13020248308889008088,
    0.56116298177510838456,
    -0.38947496264484728641,
    0.15884190655515560090,
    -0.39590389413323757734,
    0.18453964097831570709,
    0.25837438768632204729,
    0.29501172360931029887,
)
WEIGHTS = (*_HALF, -0.60550853383003451170, *_HALF[::-1])
ACCURACY = 1e-10  # rad, of theta, with the steps that the models give it
EVERY = 64  # steps from one that is kept to the next


class Reference:
    """The motion from a start, computed on demand.

    Its bits do not depend on the order in which times are requested.
    """

    def __init__(self, step: Step, start: Phase, h: float) -> None:
        """In steps of h [s]."""
        self._step = step
        self._h = h
        self._kept = {0: start}  # by number of steps, negative ones included
        self._last = 0, start  # the last whole step that was asked for

    def at(self, t: float) -> Phase:
        """The phase at a time [s]; whole steps to just before it, and one of what is left."""
        steps = int(t / self._h)
        way = int(math.copysign(1, steps))
        at = steps // (way * EVERY) * way * EVERY
        begin = at
        while begin not in self._kept:
            begin -= way * EVERY
        phase = self._kept[begin]
        last, there = self._last
        if begin * way <= last * way <= steps * way:
            begin = last
            phase = there
        try:
            for n in range(begin + way, steps + way, way):
                phase = self._step(phase, way * self._h)
                if n % EVERY == 0:
                    self._kept[n] = phase
            self._last = steps, phase
            rest = t - steps * self._h
            if rest:
                return self._step(phase, rest)
            return phase
        except (ValueError, ArithmeticError):
            return phase  # far back, where friction has made it faster than doubles hold


def compose(step: Step) -> Step:
    """Return a step of order 8 that takes WEIGHTS of h by a symmetric step of order 2 in turn."""

    def composed(phase: Phase, h: float) -> Phase:
        for weight in WEIGHTS:
            phase = step(phase, weight * h)
        return phase

    return composed


def compose_verlet(force: Force, friction: float = 0.0) -> Step:
    """Return the composition of velocity Verlet; adjacent parts share a force.

    With friction [s⁻¹] each part is a conformal step, which damps before and after; parts that go
    backwards undo it exactly.
    """

    def composed(phase: Phase, h: float) -> Phase:
        position, velocity = phase
        a = force(position)
        for weight in WEIGHTS:
            part = weight * h
            damping = math.exp(-friction * part / 2)
            velocity = velocity * damping + part / 2 * a
            position = position + part * velocity
            a = force(position)
            velocity = (velocity + part / 2 * a) * damping
        return position, velocity

    return composed
