"""How far two neighbouring starts part: a small displacement, carried along a run by the step's own derivative."""

import cmath
import math

from engine.methods import Step
from engine.models.pendulum import acceleration
from engine.models.state import Phase

TINY = 1e-100  # a complex step has no subtraction, so it may be as small as one likes


def stretched(step: Step, w0_squared: float, phase: Phase, along: Phase, h: float, steps: int) -> Phase:
    """What the displacement `along` of a phase becomes in some steps of h [s].

    By complex steps: step(x + i·tiny·v) = step(x) + i·tiny·J v + O(tiny²).  Squire & Trapp, SIAM Review 40
    (1998) 110.
    """
    force = acceleration(w0_squared, cmath.sin)
    theta, omega = complex(phase[0], TINY * along[0]), complex(phase[1], TINY * along[1])
    for _ in range(steps):
        theta, omega = step(force, (theta, omega), h)
    return theta.imag / TINY, omega.imag / TINY


class Stretching:
    """The logarithm of how much longer a displacement has become since the start of a run."""

    def __init__(self, step: Step, w0_squared: float, h: float) -> None:
        self._step, self._w0_squared, self._h = step, w0_squared, h
        self._w0 = math.sqrt(w0_squared)
        self._along: Phase = (1.0, 0.0)
        self.log = 0.0
        self.steps = 0

    def carry(self, phase: Phase, steps: int) -> None:
        """Carry it on, from this phase, by some steps; few enough that its length stays a double."""
        theta, omega = stretched(self._step, self._w0_squared, phase, self._along, self._h, steps)
        length = math.hypot(theta, omega / self._w0)
        if 0 < length < math.inf:
            self._along = theta / length, omega / length
            self.log += math.log(length)
            self.steps += steps
