"""Compute the fate of each method by start and h·w0, tests/engine/run/truths.txt.  Needs Numba.

Each cell is a run of a million steps, judged by its whole course and without the reasoning of the
verdicts: by the lowest and highest energy error in windows that double the run, and for symplectic
methods by the logarithm of the distance between neighbouring orbits.  Takes some minutes.
"""

import cmath
import math
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from typing import Any

import numba
import numpy as np

from pendu_tui.engine.methods import USUAL_CAST, Method
from pendu_tui.engine.methods.method import compilable
from pendu_tui.engine.run.loops import compiled
from pendu_tui.engine.scenes import Scene
from tests.truths import FILE, STARTS, Z, scene_at

ENDS = np.array([1 << power for power in range(4, 20)] + [3 << 18, 1 << 20])  # of windows, steps
W0 = math.sqrt(9.81)


def windows(method: Method, scene: Scene) -> Any:
    """Return the lowest and the highest energy error in each window, nan after an overflow."""
    loops = compiled(method, scene.equations)
    phase = (scene.theta, scene.omega)
    start = scene.equations.energy()(phase)
    rows = np.full((len(ENDS), 2), math.nan)
    for row, (begin, end) in zip(rows, pairwise([0, *ENDS.tolist()]), strict=True):
        advanced = loops.advance(phase, scene.h, end - begin, 1e280 * start)
        if advanced.done < end - begin:
            break
        row[:] = advanced.low, advanced.high
        phase = advanced.phase
    return (rows - start) / start


@numba.njit
def force(theta):  # type: ignore[no-untyped-def]
    return -9.81 * cmath.sin(theta)


@cache
def stretched(method: Method) -> Any:
    """Return a loop that finds by what logarithm neighbours have parted at the end of each window.

    The neighbour is the imaginary part of the phase.
    """
    phases = numba.njit(compilable(method.phases))

    @numba.njit
    def step(theta, omega, h):  # type: ignore[no-untyped-def]
        for phase in phases(force, (theta, omega), h):
            return phase
        return theta, omega

    @numba.njit(nogil=True)
    def run(theta, omega, h, ends):  # type: ignore[no-untyped-def]
        theta = complex(theta, 1e-100)
        omega = complex(omega, 0.0)
        logarithm = 0.0
        found = []
        done = 0
        for end in ends:
            for n in range(done, end):
                theta, omega = step(theta, omega, h)
                if n % 8 == 7:
                    length = math.hypot(theta.imag, omega.imag / W0) * 1e100
                    theta = complex(theta.real, theta.imag / length)
                    omega = complex(omega.real, omega.imag / length)
                    logarithm += math.log(length)
            found.append(logarithm)
            done = end
        return found

    return run


def letter(method: Method, scene: Scene) -> str:
    """Return the letter of a run, a key of tests.truths.ALLOWED."""
    if not method.symplectic:
        return course(scene.z, *windows(method, scene).T)
    found = stretched(method)(scene.theta, scene.omega, scene.h, ENDS)
    if found[-1] < 16:  # neighbours part in proportion to time: ln 10⁶ = 14
        return "b"
    return "s" if found[-1] < 40 or found[ENDS.searchsorted(8192)] < 20 else "c"


def course(z: float, low: Any, high: Any) -> str:
    """Return the letter of the lowest and highest energy errors."""
    if not np.isfinite(high).all():
        return "g"
    thrown = z > 1.5  # then the orbits of explicit Euler jump by many turns
    middle = (low + high) / 2
    width = max(high[16:].max() - low[16:].min(), 1e-13)
    if np.abs(middle).max() < 1e-10:
        return "B"
    if middle[17] < -1 + 1e-6:
        return "d"
    late = slice(14 if thrown else 16, 18)
    ends = np.ptp(low[late]), np.ptp(high[late]), abs(middle[17] - middle[15]) / 2
    if max(ends) < 0.1 * width + 0.01 * abs(middle[17]):
        # a ragged edge may miss the start for a whole window, and come back
        return "K" if low[late].min() <= 0 <= high[late].max() else "k"
    if thrown:
        return "w"
    moves = np.diff(middle[8:])
    if (moves > 0).all() and low[17] > high[13]:
        return "g"
    if (moves < 0).all():
        return "d"
    return "w" if np.ptp(middle[8:]) > np.median((high - low)[8:]) / 4 else "B"


def main() -> None:
    """Run the grid and write the file, a line for each method and start."""
    lines = []
    with ThreadPoolExecutor() as executor:
        for method in USUAL_CAST:
            for start in STARTS:
                scenes = [scene_at(start, z) for z in Z]
                letters = executor.map(letter, [method] * len(Z), scenes)
                lines.append(f"{method.key} {start} {''.join(letters)}\n")
                print(lines[-1], end="")
    FILE.write_text("".join(lines))


if __name__ == "__main__":
    main()
