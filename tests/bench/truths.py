"""Compute the fate of each method by start and h·w0, tests/engine/run/truths.txt.  Needs Numba.

Each cell is a run of a million steps, judged by its whole course and without the reasoning of the
verdicts: by the lowest and highest energy error in windows that double the run, and for symplectic
methods by the logarithm of the distance between neighbouring orbits.  Takes some minutes.
"""

import cmath
import math
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numba
import numpy as np

from pendu_tui.engine.methods import USUAL_CAST, Method
from pendu_tui.engine.methods.method import COMPILABLE
from tests.truths import ALLOWED, FILE, STARTS, Z, scene_at

WINDOWS = [1 << power for power in range(4, 20)] + [3 << 18, 1 << 20]  # steps at their ends


@numba.njit
def acceleration(theta):  # type: ignore[no-untyped-def]
    return -9.81 * math.sin(theta)


@numba.njit
def complex_acceleration(theta):  # type: ignore[no-untyped-def]
    return -9.81 * cmath.sin(theta)


def runner(method: Method):  # type: ignore[no-untyped-def]
    """Return a loop that fills in a row for each window: the lowest and highest energy error, the
    logarithm of the stretching, and the lowest and highest omega.
    """
    compilable = COMPILABLE.get(method.phases)
    phases = numba.njit(compilable() if compilable else method.phases)
    w0 = math.sqrt(9.81)

    @numba.njit
    def step(force, phase, h):  # type: ignore[no-untyped-def]
        for following in phases(force, phase, h):
            return following
        return phase

    @numba.njit
    def alone(theta, omega, along, across, h):  # type: ignore[no-untyped-def]
        theta, omega = step(acceleration, (theta, omega), h)
        return theta, omega, along, across

    @numba.njit
    def with_a_neighbour(theta, omega, along, across, h):  # type: ignore[no-untyped-def]
        phase = complex(theta, 1e-100 * along), complex(omega, 1e-100 * across)
        theta, omega = step(complex_acceleration, phase, h)
        return theta.real, omega.real, theta.imag * 1e100, omega.imag * 1e100

    advance = with_a_neighbour if method.symplectic else alone

    @numba.njit(nogil=True)
    def run(theta, omega, h, windows, rows):  # type: ignore[no-untyped-def]
        start = omega * omega / 2 + 2 * 9.81 * math.sin(theta / 2) ** 2
        along = 1.0
        across = 0.0
        stretching = 0.0
        done = 0
        for index, end in enumerate(windows):
            low, high = math.inf, -math.inf
            slowest, fastest = math.inf, -math.inf
            for n in range(done, end):
                theta, omega, along, across = advance(theta, omega, along, across, h)
                if n % 8 == 7:
                    length = math.sqrt(along * along + (across / w0) ** 2)
                    along /= length
                    across /= length
                    stretching += math.log(length)
                error = (omega * omega / 2 + 2 * 9.81 * math.sin(theta / 2) ** 2 - start) / start
                if not abs(error) < 1e280:
                    return
                low = min(low, error)
                high = max(high, error)
                slowest = min(slowest, omega)
                fastest = max(fastest, omega)
            rows[index] = low, high, stretching, slowest, fastest
            done = end

    return run


def letter(method: Method, h: float, rows: np.ndarray) -> str:
    """Return the letter of a run, a key of tests.truths.ALLOWED."""
    if not np.isfinite(rows).all():
        return "g"
    low, high, stretching, slowest, fastest = rows.T
    if method.symplectic:
        if stretching[-1] < 16:  # neighbours part in proportion to time: ln 10⁶ = 14
            return "b"
        if stretching[-1] < 40 or stretching[WINDOWS.index(8192)] < 20:
            return "s"
        return "w" if (fastest.max() - slowest.min()) * h > math.tau else "c"
    thrown = h * math.sqrt(9.81) > 1.5  # then the orbits of explicit Euler jump by many turns
    middle = (low + high) / 2
    width = max(high[16:].max() - low[16:].min(), 1e-13)
    if np.abs(middle).max() < 1e-10:
        return "B"
    if middle[17] < -1 + 1e-6:
        return "d"
    late = slice(14 if thrown else 16, 18)
    ends = np.ptp(low[late]), np.ptp(high[late]), abs(middle[17] - middle[15]) / 2
    if max(ends) < 0.1 * width + 0.01 * abs(middle[17]):
        return "K" if low[17] <= 0 <= high[17] else "k"
    if thrown:
        return "w"
    moves = np.diff(middle[8:])
    if (moves > 0).all() and low[17] > high[13]:
        return "g"
    if (moves < 0).all():
        return "d"
    return "w" if np.ptp(middle[8:]) > np.median((high - low)[8:]) / 4 else "B"


def cell(method: Method, run: Callable[..., None], start: str, z: float) -> str:
    """Return the letter of a cell."""
    scene = scene_at(start, z)
    rows = np.full((len(WINDOWS), 5), np.nan)
    run(scene.theta, scene.omega, scene.h, np.array(WINDOWS), rows)
    return letter(method, scene.h, rows)


def main() -> None:
    """Run the grid and write the file, a line for each method and start."""
    lines = []
    with ThreadPoolExecutor() as executor:
        for method in USUAL_CAST:
            run = runner(method)
            for start in STARTS:
                letters = "".join(executor.map(partial(cell, method, run, start), Z))
                assert set(letters) <= set(ALLOWED)
                lines.append(f"{method.key} {start} {letters}")
                print(lines[-1], file=sys.stderr)
    Path(FILE).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
