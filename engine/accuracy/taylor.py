"""The pendulum's motion by its Taylor series of order 20, compiled by Numba.

With u = w0² cos theta the motion is theta' = omega, omega'' = -omega u, u' = omega omega'.  The
energy is not used, so nothing cancels near the separatrix.  Bits depend on the machine.
Step size: Jorba & Zou, Exp. Math. 14 (2005) 99.
"""

import math
from typing import Any

import numpy as np
from numba import njit

ORDER = 20
RECIPROCALS = np.array([1 / (k + 1) for k in range(ORDER)])
compiled: Any = njit(nogil=True, fastmath={"contract"}, error_model="numpy")


@compiled
def expand(w0_squared: float, theta: float, omega: float, w: Any, u: Any) -> None:
    """Fill w and u with the coefficients of the series of omega and of u.

    The sums of products run outwards from the middle, so that the newest coefficients come last.
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
        left = 0.0  # two sums, because an addition waits for the previous one of its sum
        right = 0.0
        if k % 2 == 0:
            left = w[middle] * u[middle]
        for j in range(middle):
            left += w[middle - 1 - j] * u[k + 1 - middle + j]
            right += u[middle - 1 - j] * w[k + 1 - middle + j]
        w[k + 2] = (left + right) * (-RECIPROCALS[k] * RECIPROCALS[k + 1])


@compiled
def evaluate(theta: float, w: Any, t: float) -> tuple[float, float]:
    """Return theta and omega of the series t [s] after its start."""
    turned = 0.0
    faster = 0.0
    for k in range(ORDER, 0, -1):
        turned = (turned + w[k - 1] * RECIPROCALS[k - 1]) * t
        faster = (faster + w[k]) * t
    return theta + turned, w[0] + faster


@compiled
def solve(
    w0_squared: float, theta: float, omega: float, times: Any, tolerance: float
) -> tuple[Any, int]:
    """Return (theta, omega) at ascending times [s], and the steps taken; tolerance in rad/s."""
    states = np.empty((times.size, 2))
    w = np.empty(ORDER + 1)
    u = np.empty(ORDER - 1)
    index = 0
    steps = 0
    t = 0.0
    lost = 0.0  # from t by rounding; without compensation each step would err by so much
    while index < times.size:
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
    return states, steps
