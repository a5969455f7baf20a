"""What a pendulum-step of the stability map costs, and the whole map, on one core, with NumPy alone and with Numba.

Numba's first map also imports and compiles.  Exit 1 over a limit.
"""

import json
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from engine.methods import GENERAL
from engine.run.compiled import available
from engine.stability.grid import STRIP, default_grid
from engine.stability.outcomes import outcomes

LIMITS = {"numpy": 8.0, "numba": 3.0}  # s, the whole map
NS_LIMITS = {"numpy": 20.0, "numba": 5.0}  # of a Verlet step with its energy
STEPS, REPEATS = 300, 7


def fastest(work: Callable[[], object]) -> float:
    """The least processor time of some repetitions [s]."""

    def once() -> float:
        began = time.process_time()
        work()
        return time.process_time() - began

    return min(once() for _ in range(REPEATS))


def map_seconds(fast: bool) -> tuple[float, int]:
    """Processor time of the whole map [s], and how many steps it took."""
    began = time.process_time()
    cells = np.concatenate(list(replace(default_grid(), fast=fast).compute()))
    return time.process_time() - began, int(cells["steps"].sum())


def kernel(fast: bool, sine: float) -> dict[str, object]:
    """One way's figures."""
    theta, z = (
        np.full(STRIP, 0.5),
        np.full(STRIP, 1e-3),
    )  # small steps: no swing leaves the ensemble
    first, _ = map_seconds(fast)
    steps = {
        m.key: fastest(lambda m=m: outcomes(m, theta, z, STEPS, fast)) / STEPS / STRIP
        for m in GENERAL
    }
    seconds, taken = map_seconds(fast)
    return {
        "ns_per_pendulum_step": {key: value * 1e9 for key, value in steps.items()},
        "ratio_to_numpys_sine": {key: value / sine for key, value in steps.items()},
        "first_map_seconds": first,
        "map_seconds": seconds,
        "map_steps": taken,
    }


def main() -> int:
    """Measure and print."""
    theta = np.full(STRIP, 0.5)
    sine = fastest(lambda: [np.sin(theta) for _ in range(STEPS)]) / STEPS / STRIP
    ways = {
        name: kernel(name == "numba", sine) for name in LIMITS if name == "numpy" or available()
    }
    passed = all(
        way["map_seconds"] <= LIMITS[name]
        and way["ns_per_pendulum_step"]["velocity_verlet"] <= NS_LIMITS[name]  # type: ignore[operator, index]
        for name, way in ways.items()
    )
    answer = {
        "bench": "stability_map",
        "swings_together": STRIP,
        "ns_per_numpy_sine": sine * 1e9,
        **ways,
        "peak_megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        / 1024,  # Linux counts in KiB
        "limits": {"map_seconds": LIMITS, "ns_per_verlet_step": NS_LIMITS},
        "pass": passed,
    }
    print(json.dumps(answer))
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
