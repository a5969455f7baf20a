"""How many steps a second the lockstep of four makes, beside C loops compiled in the same run: one JSON object.

The C loops do the same operations in the same order (gcc -O3, libm's sin, no contraction); where no compiler
is found their numbers are null.  Each number is the best of several repeats, taken in turns: the others had company.
"""

import ctypes
import json
import math
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from engine.methods import USUAL_CAST, Method
from engine.run.lockstep import Lockstep
from engine.run.loops import PlainLoops
from engine.scenes import DEFAULT_SCENE

STEPS, REPEATS = 10_000, 30
BUDGET = 250_000  # lockstep steps a second, all four methods, energy extremes taken at every step

C = r"""
#include <math.h>
static double g, sink;
static double a(double theta) { return -g * sin(theta); }
#define EULER double k = a(q); q = q + h * p; p = p + h * k;
#define SYMPLECTIC p = p + h * a(q); q = q + h * p;
#define VERLET double m = p + h / 2 * kept; q = q + h * m; kept = a(q); p = m + h / 2 * kept;
#define RK4 double a1 = a(q), p2 = p + h / 2 * a1, a2 = a(q + h / 2 * p), p3 = p + h / 2 * a2; \
    double a3 = a(q + h / 2 * p2), p4 = p + h * a3, a4 = a(q + h * p3); \
    q = q + h / 6 * (p + 2 * p2 + 2 * p3 + p4); p = p + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
#define LOOP(name, step, energies) \
double name(double w0_squared, double q, double p, double h, long n, double limit) { \
    g = w0_squared; \
    double kept = a(q), low = INFINITY, high = -INFINITY; \
    for (long i = 0; i < n; i++) { \
        step \
        if (energies) { \
            double half = sin(q / 2), now = p * p / 2 + 2 * g * half * half; \
            if (!(now < limit)) break; \
            if (now < low) low = now; \
            if (now > high) high = now; \
        } \
    } \
    sink = low + high; \
    return q; \
}
LOOP(explicit_euler_travel, EULER, 0) LOOP(explicit_euler_advance, EULER, 1)
LOOP(symplectic_euler_travel, SYMPLECTIC, 0) LOOP(symplectic_euler_advance, SYMPLECTIC, 1)
LOOP(velocity_verlet_travel, VERLET, 0) LOOP(velocity_verlet_advance, VERLET, 1)
LOOP(rk4_travel, RK4, 0) LOOP(rk4_advance, RK4, 1)
"""


def compiled(folder: str) -> ctypes.CDLL | None:
    """The C loops, or None without a compiler."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        return None
    source, library = Path(folder, "loops.c"), Path(folder, "loops.so")
    source.write_text(C)
    options = [
        "-O3",
        "-ffp-contract=off",
        "-shared",
        "-fPIC",
        "-o",
        str(library),
        str(source),
        "-lm",
    ]
    subprocess.run([compiler, *options], check=True)
    return ctypes.CDLL(str(library))


def rates(*runs: tuple[Callable[[], object], int]) -> list[float]:
    """Steps a second of runs of so many steps, the best of the repeats, in turns: what slows one slows all."""
    best = [math.inf] * len(runs)
    for _ in range(REPEATS):
        for k, (run, _) in enumerate(runs):
            began = time.perf_counter()
            run()
            best[k] = min(best[k], time.perf_counter() - began)
    return [steps / time for (_, steps), time in zip(runs, best, strict=True)]


def c_loop(library: ctypes.CDLL | None, method: Method, loop: str) -> Callable[[int], float] | None:
    """The C loop of so many steps, which has to end where ours does."""
    if library is None:
        return None
    scene, function = DEFAULT_SCENE, getattr(library, f"{method.key}_{loop}")
    function.restype = ctypes.c_double
    function.argtypes = [ctypes.c_double] * 4 + [ctypes.c_long, ctypes.c_double]

    def run(steps: int) -> float:
        return float(function(scene.w0_squared, scene.theta, scene.omega, scene.h, steps, 1e300))

    assert (
        run(1000)
        == PlainLoops(method, scene.equations).travel((scene.theta, scene.omega), scene.h, 1000)[0]
    )
    return run


def main() -> None:
    """Measure and print."""
    scene = DEFAULT_SCENE
    lockstep, start = Lockstep(scene), (scene.theta, scene.omega)
    methods = {}
    with tempfile.TemporaryDirectory() as folder:
        library = compiled(folder)
        for method in USUAL_CAST:
            travel, advance = PlainLoops(method, scene.equations)
            runs = {
                "without_energies": (
                    partial(travel, start, scene.h, STEPS),
                    c_loop(library, method, "travel"),
                ),
                "with_energies": (
                    partial(advance, start, scene.h, STEPS, 1e300),
                    c_loop(library, method, "advance"),
                ),
            }
            ours, c, of_c = {}, {}, {}
            for name, (run, in_c) in runs.items():
                ours[name], *rest = rates(
                    (run, STEPS), *([(partial(in_c, STEPS), STEPS)] if in_c else [])
                )
                c[name] = rest[0] if rest else None
                of_c[name] = ours[name] / rest[0] if rest else None
            methods[method.key] = {"steps_per_second": ours, "c_steps_per_second": c, "of_c": of_c}
    (together,) = rates((partial(lockstep.advance, STEPS), STEPS))
    bare = 1 / sum(
        1 / method["steps_per_second"]["without_energies"] for method in methods.values()
    )
    report = {
        "bench": "lockstep",
        "lockstep_steps_per_second": together,
        "without_energies": bare,
        "budget": BUDGET,
        "pass": together >= BUDGET,
        "methods": methods,
    }
    if library is not None:
        in_c = {
            name: 1 / sum(1 / method["c_steps_per_second"][name] for method in methods.values())
            for name in ("with_energies", "without_energies")
        }
        report |= {"c_lockstep_steps_per_second": in_c, "of_c": together / in_c["with_energies"]}
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
