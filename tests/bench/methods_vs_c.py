"""One trajectory of each method, plain and compiled, against a C loop of the same operations: one JSON object.

Ratios are of the same run.  Methods that have no C loop here are given in nanoseconds an evaluation of the force.
"""

import json
import math
import tempfile
from typing import Any

from engine.methods import GENERAL, USUAL_CAST, Method
from engine.run.compiled import compiled
from engine.run.lockstep import Lockstep
from engine.run.loops import LoopsOf, plain
from engine.scenes import DEFAULT_SCENE as SCENE
from tests.bench.lockstep import STEPS, c_rate, rate
from tests.bench.lockstep import compiled as c_library

COMPILED_LIMIT = 0.9  # of C
MANY = 40 * STEPS
START = SCENE.theta, SCENE.omega


def our_rate(loops_of: LoopsOf, method: Method, loop: str, steps: int) -> float:
    """Steps a second of travel or advance."""
    loops = loops_of(method, SCENE.equations)
    if loop == "travel":
        loops.travel(START, SCENE.h, 1)
        return rate(lambda: loops.travel(START, SCENE.h, steps), steps)
    loops.advance(START, SCENE.h, 1, math.inf)
    return rate(lambda: loops.advance(START, SCENE.h, steps, math.inf), steps)


def one_loop(library: Any, method: Method, loop: str) -> dict[str, Any]:
    """C, compiled and plain [steps a second], and their ratios."""
    c = c_rate(library, method, loop)
    fast, slow = our_rate(compiled, method, loop, MANY), our_rate(plain, method, loop, STEPS)
    passed = c and fast / c >= COMPILED_LIMIT
    return {
        "c": c,
        "compiled": fast,
        "plain": slow,
        "compiled_of_c": c and fast / c,
        "plain_of_c": c and slow / c,
        "pass": passed,
    }


def ns_per_force(method: Method) -> dict[str, float]:
    """What an evaluation of the force and its share of the step take."""
    each = {"compiled": (compiled, MANY // 8), "plain": (plain, STEPS // 4)}
    return {
        name: 1e9 / our_rate(loops_of, method, "travel", steps) / method.force_evaluations
        for name, (loops_of, steps) in each.items()
    }


def together() -> dict[str, float]:
    """The lockstep of four with energies at every step [lockstep steps a second]."""
    answer = {}
    for name, loops_of, steps in (("compiled", compiled, MANY), ("plain", plain, STEPS)):
        lockstep = Lockstep(SCENE, loops=loops_of)
        lockstep.advance(1)
        answer[name] = rate(lambda: lockstep.advance(steps), steps)  # noqa: B023
    return answer


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        library = c_library(folder)
        loops = {m.key: {loop: one_loop(library, m, loop) for loop in ("travel", "advance")} for m in USUAL_CAST}
    report = {
        "bench": "methods_vs_c",
        "methods": loops,
        "ns_per_force": {method.key: ns_per_force(method) for method in GENERAL},
        "lockstep_of_four": together(),
        "limits": {"compiled_of_c": COMPILED_LIMIT},
        "pass": all(part["pass"] is not False for both in loops.values() for part in both.values()),
    }
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
