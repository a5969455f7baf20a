"""How far two neighbouring starts part: a small displacement, carried along a run by the step's own derivative."""

import cmath
import math

from engine.methods import Method, Step
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


def conserved_ellipse(method: Method, w0_squared: float, h: float) -> tuple[float, float, float] | None:
    """What a symplectic step keeps of small swings: the form -c theta² + (a - d) theta omega + b omega².

    ((a, b), (c, d)) is the step's Jacobian at the bottom, in units where w0 = 1.  None where that is no ellipse.
    """
    if not method.symplectic:
        return None
    w0 = math.sqrt(w0_squared)
    a, c = stretched(method.step, w0_squared, (0.0, 0.0), (1.0, 0.0), h, 1)
    b, d = stretched(method.step, w0_squared, (0.0, 0.0), (0.0, 1.0), h, 1)
    c, b = c / w0, b * w0
    return (-c, a - d, b) if (a - d) ** 2 / 4 + b * c < 0 else None
