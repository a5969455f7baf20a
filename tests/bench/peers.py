"""Milliseconds to follow a swing for 100 s within 1e-3, 1e-6 and 1e-9 rad, beside other packages: one JSON object.

Each solver gets the loosest tolerance (ours: the fewest steps) whose largest theta error at 400 times is within
the target, and is then timed to the end state alone; the least of several runs, start-up (imports,
compiling) excluded and stated apart.  A package that is not installed is skipped and named.
"""

import json
import math
import time
from collections.abc import Callable, Iterator
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np

from engine.accuracy.recommend import cheapest, reach
from engine.accuracy.study import Study
from engine.methods import METHODS
from engine.run.compiled import compiled
from engine.scenes import Scene

SCENE, TIME = Scene(theta=2.0), 100.0
TARGETS = (1e-3, 1e-6, 1e-9)
TOLERANCES = [10 ** (-power / 4) for power in range(4, 57)]
TIMES = np.linspace(0, TIME, 401)[1:]
EXACT = np.array([SCENE.exact().at(t).theta for t in TIMES])
TOO_LONG = 5.0  # s; a solver that takes longer is not asked for smaller errors
W0_SQUARED, START = SCENE.w0_squared, [SCENE.theta, SCENE.omega]

Run = Callable[[], Any]


class Solver(NamedTuple):
    """Of a tolerance: a run to the end, and a run that gives theta at TIMES."""

    name: str
    to_the_end: Callable[[float], Run]
    at_times: Callable[[float], Any]


def scipy_solvers() -> Iterator[Solver]:
    """solve_ivp with each of its methods; the right-hand side is Python's, as its users write it."""
    solve_ivp = import_module("scipy.integrate").solve_ivp

    def slope(t: float, y: Any) -> list[float]:
        return [y[1], -W0_SQUARED * math.sin(y[0])]

    for method in ("RK23", "RK45", "DOP853", "LSODA", "Radau", "BDF"):

        def solve(tolerance: float, times: Any = None, method: str = method) -> Any:
            return solve_ivp(slope, (0, TIME), START, method, times, rtol=max(tolerance, 3e-14), atol=tolerance).y[0]

        yield Solver(f"scipy {method}", lambda tol, solve=solve: lambda: solve(tol), lambda tol, s=solve: s(tol, TIMES))


def diffrax_solvers() -> Iterator[Solver]:
    """Explicit solvers in double precision, compiled by JAX."""
    jax = import_module("jax")
    jax.config.update("jax_enable_x64", True)
    diffrax, numpy = import_module("diffrax"), import_module("jax.numpy")

    def slope(t: Any, y: Any, arguments: Any) -> Any:
        return numpy.stack([y[1], -W0_SQUARED * numpy.sin(y[0])])

    for name in ("Tsit5", "Dopri5", "Dopri8"):
        solver = getattr(diffrax, name)()

        def solve(tolerance: Any, save: Any, solver: Any = solver) -> Any:
            control = diffrax.PIDController(rtol=tolerance, atol=tolerance)
            term, y = diffrax.ODETerm(slope), numpy.array(START)
            limits = {"saveat": save, "stepsize_controller": control, "max_steps": 1_000_000, "throw": False}
            return diffrax.diffeqsolve(term, solver, 0.0, TIME, 0.01, y, **limits).ys

        end = jax.jit(lambda tol, solve=solve: solve(tol, diffrax.SaveAt(t1=True)))
        path = jax.jit(lambda tol, solve=solve: solve(tol, diffrax.SaveAt(ts=numpy.array(TIMES))))
        yield Solver(
            f"diffrax {name}",
            lambda tol, end=end: lambda: end(tol).block_until_ready(),
            lambda tol, path=path: np.asarray(path(tol))[:, 0],
        )


def numbalsoda_solvers() -> Iterator[Solver]:
    """LSODA and DOP853 from compiled code."""
    numbalsoda, numba = import_module("numbalsoda"), import_module("numba")

    @numba.cfunc(numbalsoda.lsoda_sig)
    def slope(t: float, y: Any, change: Any, parameters: Any) -> None:
        change[0] = y[1]
        change[1] = -W0_SQUARED * math.sin(y[0])

    start, both_ends = np.array(START), np.array([0.0, TIME])
    for name in ("lsoda", "dop853"):

        def solve(tolerance: float, times: Any, name: str = name) -> Any:
            solver = getattr(numbalsoda, name)
            return solver(slope.address, start, times, rtol=tolerance, atol=tolerance)[0][1:, 0]

        yield Solver(
            f"numbalsoda {name}",
            lambda tol, solve=solve: lambda: solve(tol, both_ends),
            lambda tol, solve=solve: solve(tol, np.concatenate([[0.0], TIMES])),
        )


def heyoka_solvers() -> Iterator[Solver]:
    """Taylor's method, its order chosen by the tolerance."""
    heyoka = import_module("heyoka")
    theta, omega = heyoka.make_vars("theta", "omega")
    equations = [(theta, omega), (omega, -W0_SQUARED * heyoka.sin(theta))]

    def prepared(tolerance: float) -> Any:
        return heyoka.taylor_adaptive(equations, START, tol=max(tolerance, 1e-16))

    def to_the_end(tolerance: float) -> Run:
        solver = prepared(tolerance)

        def run() -> None:
            solver.time, solver.state[:] = 0.0, START
            solver.propagate_until(TIME)

        return run

    def at_times(tolerance: float) -> Any:
        return prepared(tolerance).propagate_grid(np.concatenate([[0.0], TIMES]))[-1][1:, 0]

    yield Solver("heyoka Taylor", to_the_end, at_times)


PEERS = {
    "scipy": scipy_solvers,
    "diffrax": diffrax_solvers,
    "numbalsoda": numbalsoda_solvers,
    "heyoka": heyoka_solvers,
}


def milliseconds(run: Run) -> float:
    """The shortest of up to 20 runs within a second or so."""
    run()
    best, began = math.inf, time.perf_counter()
    for _ in range(20):
        start = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - start)
        if time.perf_counter() - began > 1:
            break
    return 1e3 * best


def measured(solver: Solver) -> dict[str, Any]:
    """Start-up [s] and, for each target, milliseconds and the tolerance; null where it is not reached in time."""
    began = time.perf_counter()
    solver.to_the_end(1e-3)()
    solver.at_times(1e-3)
    row: dict[str, Any] = {"startup_seconds": time.perf_counter() - began}
    tolerances, slowest = iter(TOLERANCES), 0.0
    tolerance: float | None = next(tolerances)
    for target in TARGETS:
        while tolerance is not None and slowest < TOO_LONG:
            began = time.perf_counter()
            error = np.max(np.abs(solver.at_times(tolerance) - EXACT))
            slowest = time.perf_counter() - began
            if error <= target:
                break
            tolerance = next(tolerances, None)
        found = tolerance is not None and slowest < TOO_LONG
        row[f"{target:g}"] = {"ms": milliseconds(solver.to_the_end(tolerance)), "tol": tolerance} if found else None
    return row


def ours() -> Iterator[tuple[str, dict[str, Any]]]:
    """The compiled methods that can: RK4 and Verlet."""
    for method in METHODS[2:]:
        began = time.perf_counter()
        travel, start = compiled(method).travel, (SCENE.theta, SCENE.omega)
        travel(W0_SQUARED, start, 0.01, 1)
        row: dict[str, Any] = {"startup_seconds": time.perf_counter() - began}
        for target in TARGETS:
            study = Study(SCENE, TIME, compiled)
            point = cheapest(list(reach(study, "theta", target, 200_000_000, (method,))))
            row[f"{target:g}"] = point and {
                "ms": milliseconds(lambda: travel(W0_SQUARED, start, point.h, point.steps)),  # noqa: B023
                "h": point.h,
            }
        yield f"compiled {method.label}", row


def main() -> None:
    """Measure and print."""
    rows, skipped = dict(ours()), {}
    for package, solvers in PEERS.items():
        try:
            rows |= {solver.name: measured(solver) for solver in solvers()}
        except ImportError as error:
            skipped[package] = str(error)
    rk4, target = rows[f"compiled {METHODS[3].label}"], f"{TARGETS[0]:g}"
    rivals = [
        row[target]["ms"] for name, row in rows.items() if not name.startswith(("compiled", "heyoka")) and row[target]
    ]
    report = {
        "bench": "peers",
        "scene": "theta 2 rad, 100 s, 1 m",
        "solvers": rows,
        "skipped": skipped,
        "limit": "compiled RK4 ahead of every scipy, diffrax and numbalsoda solver at 1e-3",
        "pass": all(rk4[target]["ms"] < rival for rival in rivals) if rivals else None,
    }
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
