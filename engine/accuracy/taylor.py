"""The motion by its Taylor series of order 20, for Numba: the fastest at every accuracy, and no method of the lockstep.

With u = w0² cos theta the motion is theta' = omega, omega'' = -omega u, u' = omega omega'.  No energy enters, so
nothing cancels near the separatrix.  The sums of products are written out, twice as fast as loops, with the newest
coefficients last, as a sum waits for them.  In plain Python every method is faster, so without Numba it is absent.
Its bits depend on the machine.  Step size: Jorba & Zou, Exp. Math. 14 (2005) 99.
"""

from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
MOST_STEPS = 20_000_000  # some seconds
TEXT = """
def motion(w0_squared, theta, omega, times, tolerance, most_steps, states):
    i, steps, t, lost = 0, 0, 0.0, 0.0
    while i < times.size and steps < most_steps:
        w0, w1, u0 = omega, -w0_squared * sin(theta), w0_squared * cos(theta)
        {coefficients}
        h = min((tolerance / abs(w20)) ** (1 / 20), (tolerance / abs(w19)) ** (1 / 19))
        while i < times.size and times[i] - t - lost <= h:
            d = times[i] - t - lost
            states[i, 0], states[i, 1] = {theta}, {omega}
            i += 1
        d = h
        theta, omega = {theta}, {omega}
        steps, moved = steps + 1, h + lost
        t, lost = t + moved, moved - (t + moved - t)  # what rounding takes from t would be an error of each step
    return steps
"""


@cache
def _compiled() -> Any:
    w, lines = [f"w{k}" for k in range(21)], ["w2 = -w0 * u0 / 2"]  # the coefficients of omega's series
    for k in range(1, 19):
        outwards = sorted(range(k + 1), key=lambda j: abs(2 * j - k))
        half = [f"w{k // 2} * w{k // 2} / 2"] * (k % 2 == 0) + [f"w{j} * w{k - j}" for j in outwards if 2 * j < k]
        lines.append(f"u{k} = {' + '.join(half)}")
        lines.append(f"w{k + 2} = ({' + '.join(f'w{j} * u{k - j}' for j in outwards)}) * {-1 / ((k + 1) * (k + 2))}")
    theta = _series(["theta", *(f"{w[k]} * {1 / (k + 1)}" for k in range(20))])
    numba, names = import_module("numba"), {"sin": np.sin, "cos": np.cos}
    exec(TEXT.format(coefficients="\n        ".join(lines), theta=theta, omega=_series(w)), names)
    return numba.njit(nogil=True, fastmath={"contract"}, error_model="numpy")(names["motion"])


def _series(c: list[str]) -> str:
    """A power series in d by Horner, even and odd powers apart: two chains of half the length."""
    even, odd = ("(" * len(part) + ") * (d * d) + ".join(part[::-1]) + ")" for part in (c[::2], c[1::2]))
    return f"({even} + {odd} * d)"


def follow(w0_squared: float, theta: float, omega: float, times: Floats, tolerance: float) -> tuple[Floats, int]:
    """(theta, omega) at ascending times [s], nan after MOST_STEPS, and the steps taken; tolerance of omega [rad/s]."""
    states = np.full((len(times), 2), np.nan)
    return states, _compiled()(w0_squared, theta, omega, times, tolerance, MOST_STEPS, states)
