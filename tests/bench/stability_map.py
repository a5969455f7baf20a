"""What a pendulum-step of the stability map costs, and the whole map, on one core.  Exit 1 over a limit."""

import json
import resource
import sys
import time
from collections.abc import Callable

import numpy as np

from engine.methods import METHODS
from engine.stability.grid import STRIP, default_grid
from engine.stability.outcomes import outcomes

LIMITS = {"map_seconds": 30.0, "peak_megabytes": 200.0}
STEPS, REPEATS = 300, 7


def fastest(work: Callable[[], object]) -> float:
    """The least processor time of some repetitions [s]."""

    def once() -> float:
        began = time.process_time()
        work()
        return time.process_time() - began

    return min(once() for _ in range(REPEATS))


def main() -> int:
    """Measure and print."""
    theta, z = np.full(STRIP, 0.5), np.full(STRIP, 1e-3)  # small steps: no swing leaves the ensemble
    sines = fastest(lambda: [np.sin(theta) for _ in range(STEPS)]) / STEPS / STRIP
    steps = {m.key: fastest(lambda m=m: outcomes(m, theta, z, STEPS)) / STEPS / STRIP for m in METHODS}

    grid = default_grid()
    began = time.process_time()
    cells = np.concatenate(list(grid.compute()))
    measured = {
        "map_seconds": time.process_time() - began,
        "peak_megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,  # Linux counts in KiB
    }
    passed = all(measured[name] <= limit for name, limit in LIMITS.items())
    answer = {
        "bench": "stability_map",
        "swings_together": STRIP,
        "ns_per_sine": sines * 1e9,
        "ns_per_pendulum_step": {key: seconds * 1e9 for key, seconds in steps.items()},
        "ratio_to_sine": {key: seconds / sines for key, seconds in steps.items()},
        "map_cells": cells.size,
        "map_steps_each": grid.steps,
        "map_steps_done": int(cells["steps"].sum()),
        **measured,
        "limits": LIMITS,
        "pass": passed,
    }
    print(json.dumps(answer))
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
