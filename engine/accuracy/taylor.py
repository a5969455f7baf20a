"""The pendulum's motion by its Taylor series of order 20, for Numba.

With u = w0² cos theta the motion is theta' = omega, omega'' = -omega u, u' = omega omega'.  The
energy is not used, so nothing cancels near the separatrix.  Bits depend on the machine.
Step size: Jorba & Zou, Exp. Math. 14 (2005) 99.
"""

import math
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
ORDER = 20
MAX_STEPS = 20_000_000  # some seconds
FACTORS = np.array([-1 / ((k + 1) * (k + 2)) for k in range(ORDER - 1)])
RECIPROCALS = np.array([1 / (k + 1) for k in range(ORDER)])


def expand(w0_squared: float, theta: float, omega: float, w: Floats, u: Floats) -> None:
    """Fill w and u with the coefficients of the series of omega and of u.

    The sums of products run from the middle outwards, because the newest coefficients come last.
    """
    w[0] = omega
    w[1] = -w0_squared * math.sin(theta)
    u[0] = w0_squared * math.cos(theta)
    for k in range(ORDER - 1):
        middle = (k + 1) // 2
        if k > 0:
            square = 0.0
            if k % 2 == 0:
                square = w[middle] * w[middle] / 2
            for j in range(middle):
                square += w[j] * w[k - j]
            u[k] = square
        left = 0.0  # two sums: each addition waits for the one before it
        right = 0.0
        if k % 2 == 0:
            left = w[middle] * u[middle]
        for j in range(middle):
            left += w[middle - 1 - j] * u[k + 1 - middle + j]
            right += u[middle - 1 - j] * w[k + 1 - middle + j]
        w[k + 2] = (left + right) * FACTORS[k]


def evaluate(theta: float, w: Floats, t: float) -> tuple[float, float]:
    """Return theta and omega of the series t [s] after its start."""
    turned = w[0] * t
    faster = 0.0
    power = t
    for k in range(1, ORDER):
        faster += w[k] * power
        power *= t
        turned += w[k] * RECIPROCALS[k] * power
    return theta + turned, w[0] + (faster + w[ORDER] * power)


def propagate(
    expand: Any,
    evaluate: Any,
    w0_squared: float,
    theta: float,
    omega: float,
    times: Floats,
    tolerance: float,
    max_steps: int,
    states: Floats,
) -> int:
    """Fill `states` with (theta, omega) at ascending times [s]; return the steps taken."""
    w = np.empty(ORDER + 1)
    u = np.empty(ORDER - 1)
    index = 0
    steps = 0
    t = 0.0
    lost = 0.0  # by rounding, of t: uncompensated, it would be an error of each step
    while index < times.size and steps < max_steps:
        expand(w0_squared, theta, omega, w, u)
        h = min(
            (tolerance / abs(w[ORDER])) ** (1 / ORDER),
            (tolerance / abs(w[ORDER - 1])) ** (1 / (ORDER - 1)),
        )
        while index < times.size and times[index] - t - lost <= h:
            states[index] = evaluate(theta, w, times[index] - t - lost)
            index += 1
        theta, omega = evaluate(theta, w, h)
        steps += 1
        moved = h + lost
        end = t + moved
        lost = moved - (end - t)
        t = end
    return steps


@cache
def compiled() -> Any:
    """Return `propagate` as compiled by Numba.  Raises ImportError without it."""
    njit = import_module("numba").njit(nogil=True, fastmath={"contract"}, error_model="numpy")
    series = njit(expand)
    value = njit(evaluate)
    loop = njit(propagate)

    def run(
        w0_squared: Any,
        theta: Any,
        omega: Any,
        times: Any,
        tolerance: Any,
        max_steps: Any,
        states: Any,
    ) -> Any:
        return loop(series, value, w0_squared, theta, omega, times, tolerance, max_steps, states)

    return njit(run)


def solve(
    w0_squared: float,
    theta: float,
    omega: float,
    times: Floats,
    tolerance: float,
    max_steps: int = MAX_STEPS,
) -> tuple[Floats, int]:
    """Return (theta, omega) at ascending times [s], nan after `max_steps`, and the steps taken.

    The tolerance is that of omega [rad/s].
    """
    states = np.full((len(times), 2), np.nan)
    steps = compiled()(w0_squared, theta, omega, times, tolerance, max_steps, states)
    return states, steps
