"""The reference motion where there is no closed form, by a composition of order 8.

It takes a symmetric step of order 2 with 17 fractions of h in turn: Kahan & Li, Math. Comput. 66
(1997) 1089.
"""

import math
from collections.abc import Callable

from pendu_tui.engine.models.model import Force, Phase

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
EVERY = 64  # steps from one kept phase to the next


class Reference:
    """The motion from a start, computed on demand; its bits do not depend on earlier calls."""

    def __init__(self, step: Step, start: Phase, h: float) -> None:
        self._step = step
        self._h = h  # s
        self._kept = {0: start}  # by number of steps, which may be negative
        self._last = 0, start  # the last whole step of the previous call

    def at(self, t: float) -> Phase:
        """Return the phase at a time [s], after whole steps and a shorter one."""
        steps = int(t / self._h)
        way = int(math.copysign(1, steps))
        begin = steps // (way * EVERY) * way * EVERY
        while begin not in self._kept:
            begin -= way * EVERY
        phase = self._kept[begin]
        last, last_phase = self._last
        if begin * way <= last * way <= steps * way:
            begin = last
            phase = last_phase
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
            return phase  # long before the start friction makes it faster than doubles hold


def compose(step: Step) -> Step:
    """Return a step of order 8, composed of a symmetric step of order 2."""

    def composed(phase: Phase, h: float) -> Phase:
        for weight in WEIGHTS:
            phase = step(phase, weight * h)
        return phase

    return composed


def compose_verlet(force: Force, friction: float = 0.0) -> Step:
    """Return the composition of velocity Verlet, or with friction [s⁻¹] of conformal Verlet.

    Adjacent parts share a force.
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
