"""The loops that carry one trajectory of the pendulum."""

import math
from collections.abc import Callable
from functools import cache
from math import sin
from typing import NamedTuple

from engine.methods import Method, Step
from engine.models.pendulum import acceleration
from engine.models.state import Acceleration, Phase
from engine.run.inline import NotInlinableError, written_out

Advanced = tuple[int, Phase, float, float, float]
"""Steps done, phase and energy there, lowest and highest energy on the way [s⁻²]."""

Travel = Callable[[float, Phase, float, int], Phase]
"""(w0_squared, phase, h, n) -> phase."""

Advance = Callable[[float, Phase, float, int, float], Advanced]
"""(w0_squared, phase, h, n, limit) -> Advanced."""


class Loops(NamedTuple):
    """One method's loops on the pendulum."""

    travel: Travel
    advance: Advance


def travel(step: Step, acceleration: Acceleration, phase: Phase, h: float, n: int) -> Phase:
    """The phase after n steps of size h, and nothing else."""
    theta, omega = phase
    for _ in range(n):
        theta, omega = step(acceleration, (theta, omega), h)
    return theta, omega


def advance(
    step: Step, acceleration: Acceleration, w0_squared: float, phase: Phase, h: float, n: int, limit: float
) -> Advanced:
    """Advance by n steps of size h, or to the last one whose energy is below `limit`.

    The energy is written out because it is half of this loop's cost; a call would double it.
    """
    theta, omega = phase
    low, high, value = math.inf, -math.inf, math.nan
    for done in range(n):
        before = theta, omega
        theta, omega = step(acceleration, before, h)
        half = sin(theta / 2)
        now = omega * omega / 2 + 2 * w0_squared * half * half
        if not now < limit:  # catches nan, too
            return done, before, value, low, high
        value = now
        if now < low:
            low = now
        if now > high:
            high = now
    return n, (theta, omega), value, low, high


@cache
def plain(method: Method) -> Loops:
    """The loops in Python: written out where the method's source allows, else with calls.  Same bits."""
    try:
        return Loops(written_out(travel, method), _finite(written_out(advance, method)))
    except NotInlinableError:
        return Loops(
            lambda w0_squared, *rest: travel(method.step, acceleration(w0_squared), *rest),
            _finite(lambda w0_squared, *rest: advance(method.step, acceleration(w0_squared), w0_squared, *rest)),
        )


def _finite(loop: Advance) -> Advance:
    """The same loop for steps that overflow: math.sin raises at inf, and this finds the step before, by halving."""

    def guarded(w0_squared: float, phase: Phase, h: float, n: int, limit: float) -> Advanced:
        try:
            return loop(w0_squared, phase, h, n, limit)
        except ValueError:
            if n == 1:
                return 0, phase, math.nan, math.inf, -math.inf
        half = n // 2
        done, phase, value, low, high = guarded(w0_squared, phase, h, half, limit)
        if done < half:
            return done, phase, value, low, high
        more, phase, later, later_low, later_high = guarded(w0_squared, phase, h, n - half, limit)
        return done + more, phase, later if more else value, min(low, later_low), max(high, later_high)

    return guarded
