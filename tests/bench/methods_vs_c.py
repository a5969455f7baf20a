"""One trajectory of each method, plain and compiled, against a C loop of the same operations: one JSON object.

Ratios are of the same run.  Methods that have no C loop here are given in nanoseconds an evaluation of the force.
"""

import json
import math
import tempfile
from collections.abc import Callable
from functools import partial
from typing import Any

from engine.methods import GENERAL, USUAL_CAST, Method
from engine.run.compiled import compiled
from engine.run.lockstep import Lockstep
from engine.run.loops import LoopsOf, PlainLoops
from engine.scenes import DEFAULT_SCENE as SCENE
from tests.bench.lockstep import STEPS, c_loop, rates
from tests.bench.lockstep import compiled as c_library

COMPILED_LIMIT = 0.9  # of C
MANY = 10 * STEPS
START = SCENE.theta, SCENE.omega


def our_loop(
    loops_of: LoopsOf, method: Method, loop: str, steps: int
) -> tuple[Callable[[], object], int]:
    """Travel or advance by so many steps, compiled if it is."""
    loops = loops_of(method, SCENE.equations)
    go = loops.travel if loop == "travel" else partial(loops.advance, limit=math.inf)
    go(START, SCENE.h, n=1)
    return partial(go, START, SCENE.h, n=steps), steps


def one_loop(library: Any, method: Method, loop: str) -> dict[str, Any]:
    """C, compiled and plain [steps a second], and their ratios."""
    in_c = c_loop(library, method, loop)
    ours = our_loop(compiled, method, loop, MANY), our_loop(PlainLoops, method, loop, STEPS)
    fast, slow, *c = rates(*ours, *([(partial(in_c, MANY), MANY)] if in_c else []))
    return {
        "c": c[0] if c else None,
        "compiled": fast,
        "plain": slow,
        "compiled_of_c": fast / c[0] if c else None,
        "plain_of_c": slow / c[0] if c else None,
        "pass": fast / c[0] >= COMPILED_LIMIT if c else None,
    }


def ns_per_force(method: Method) -> dict[str, float]:
    """What an evaluation of the force and its share of the step take."""
    each = {"compiled": (compiled, MANY), "plain": (PlainLoops, STEPS // 4)}
    return {
        name: 1e9 / rates(our_loop(loops_of, method, "travel", steps))[0] / method.force_evaluations
        for name, (loops_of, steps) in each.items()
    }


def together() -> dict[str, float]:
    """The lockstep of four with energies at every step [lockstep steps a second]."""
    answer = {}
    for name, loops_of, steps in (("compiled", compiled, MANY), ("plain", PlainLoops, STEPS)):
        lockstep = Lockstep(SCENE, loops=loops_of)
        lockstep.advance(1)
        (answer[name],) = rates((partial(lockstep.advance, steps), steps))
    return answer


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        library = c_library(folder)
        loops = {
            m.key: {loop: one_loop(library, m, loop) for loop in ("travel", "advance")}
            for m in USUAL_CAST
        }
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
