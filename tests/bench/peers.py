"""Milliseconds to follow a swing for 100 s within 1e-3 to 1e-12 rad, beside other packages.

Each solver gets the coarsest setting (a tolerance, or a number of steps) whose largest theta error
at 400 times is within the target, as are those of the six next finer settings: errors that cancel
by chance do not count.  The time is that to the end state alone, the shortest of many runs, with
all solvers in turns; start-up (imports, compiling) is excluded.  A package that cannot be imported
is skipped and named.  Takes two minutes.
"""

import math
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from importlib import import_module
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from pendu_tui.engine.methods import GENERAL, TAYLOR_20
from pendu_tui.engine.run.loops import compiled
from pendu_tui.engine.scenes import Scene

LIMITS = {"targets_behind": 0}
SCENE = Scene(theta=2.0)
W0_SQUARED = SCENE.w0_squared
START = (SCENE.theta, SCENE.omega)
END = 100.0  # s
GRID = np.linspace(0, END, 401)
TIMES = GRID[1:]
MOTION = SCENE.exact()
EXACT = np.array([MOTION.at(float(t)).theta for t in TIMES])
TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)
FINER = 6  # settings that must reach the target as well
TOLERANCES = [10 ** (-power / 8) for power in range(8, 126)]
STEPS = sorted({round(200 * 1.03**n) for n in range(330)})  # to 3.3 million
MAX_SECONDS = 0.4  # a solver that takes longer gets no finer setting
ENOUGH = 0.5  # s spent on a solver, after which it is left out
IN_A_ROW = 3  # runs in each turn, as the first one finds the caches of another solver

Run = Callable[[], Any]


class Solver(NamedTuple):
    """A solver with functions of a setting."""

    name: str
    to_the_end: Callable[[Any], Run]
    error: Callable[[Any], float]  # rad, the largest in theta at some 400 times
    settings: Sequence[float] = TOLERANCES  # from coarse to fine


def solver(name: str, solve: Callable[[float, Any], Any], end: Any, path: Any) -> Solver:
    """Return a solver that takes a tolerance and times, and gives theta at them."""
    return Solver(
        name,
        lambda tolerance: partial(solve, tolerance, end),
        lambda tolerance: largest_error(solve(tolerance, path)),
    )


def largest_error(theta: Any) -> float:
    return float(np.max(np.abs(np.asarray(theta)[-len(EXACT) :] - EXACT)))


def closed_form_solvers() -> Iterator[Solver]:
    """The exact motion itself, in Python: the floor."""
    yield Solver("closed form", lambda _: partial(MOTION.at, END), lambda _: 0.0, range(FINER + 1))


def method_solvers() -> Iterator[Solver]:
    """The lab's methods, compiled; order 1 takes too long."""
    for method in (*GENERAL, TAYLOR_20):
        if method.order == 1 or method.varies:
            continue
        propagate = compiled(method, SCENE.equations).propagate

        def to_the_end(steps: int, propagate: Any = propagate) -> Run:
            return partial(propagate, START, END / steps, steps)

        def error(steps: int, propagate: Any = propagate) -> float:
            stride = steps // 400 or 1
            phase = START
            largest = 0.0
            for done in range(stride, steps + 1, stride):
                phase = propagate(phase, END / steps, stride)
                largest = max(largest, abs(phase[0] - MOTION.at(done * END / steps).theta))
            return largest

        yield Solver(method.label, to_the_end, error, STEPS)


def scipy_solvers() -> Iterator[Solver]:
    """solve_ivp with its fastest methods here; the right-hand side is Python, as usual."""
    solve_ivp = import_module("scipy.integrate").solve_ivp

    def slope(t: float, y: Any) -> list[float]:
        return [y[1], -W0_SQUARED * math.sin(y[0])]

    for method in ("DOP853", "LSODA"):

        def solve(tolerance: float, times: Any, method: str = method) -> Any:
            tolerances = {"rtol": max(tolerance, 3e-14), "atol": tolerance}
            return solve_ivp(slope, (0, END), START, method, times, **tolerances).y[0]

        yield solver(f"scipy {method}", solve, end=None, path=TIMES)


def diffrax_solvers() -> Iterator[Solver]:
    """Explicit solvers in double precision, compiled by JAX."""
    jax = import_module("jax")
    jax.config.update("jax_enable_x64", True)
    diffrax = import_module("diffrax")

    def slope(t: Any, y: Any, arguments: Any) -> Any:
        return jax.numpy.stack([y[1], -W0_SQUARED * jax.numpy.sin(y[0])])

    for name in ("Tsit5", "Dopri8"):

        def solve(tolerance: Any, times: Any, name: str = name) -> Any:
            return diffrax.diffeqsolve(
                diffrax.ODETerm(slope),
                getattr(diffrax, name)(),
                t0=0.0,
                t1=END,
                dt0=0.01,
                y0=jax.numpy.array(START),
                saveat=diffrax.SaveAt(ts=times),
                stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
                max_steps=1_000_000,
                throw=False,
            ).ys[:, 0]

        def finished(compiled: Any, tolerance: float, times: Any) -> Any:
            return compiled(tolerance, times).block_until_ready()

        yield solver(f"diffrax {name}", partial(finished, jax.jit(solve)), GRID[-1:], TIMES)


def heyoka_solvers() -> Iterator[Solver]:
    """Taylor's method, whose order follows from the tolerance."""
    heyoka = import_module("heyoka")
    theta, omega = heyoka.make_vars("theta", "omega")
    equations = [(theta, omega), (omega, -W0_SQUARED * heyoka.sin(theta))]

    def prepared(tolerance: float, fast: bool) -> Any:
        tolerance = max(tolerance, 2.3e-16)
        return heyoka.taylor_adaptive(equations, list(START), tol=tolerance, fast_math=fast)

    def to_the_end(tolerance: float, fast: bool) -> Run:
        solver = prepared(tolerance, fast)

        def run() -> None:
            solver.time = 0.0
            solver.state[:] = START
            solver.propagate_until(END)

        return run

    def error(tolerance: float, fast: bool) -> float:
        return largest_error(prepared(tolerance, fast).propagate_grid(GRID)[-1][:, 0])

    for name, fast in (("heyoka", False), ("heyoka, fast_math", True)):
        yield Solver(name, partial(to_the_end, fast=fast), partial(error, fast=fast))


SOLVERS = {
    "engine": (closed_form_solvers, method_solvers),
    "heyoka": (heyoka_solvers,),
    "diffrax": (diffrax_solvers,),
    "scipy": (scipy_solvers,),
}


def loosest(solver: Solver) -> Iterator[float | None]:
    """Yield the coarsest setting that reaches each target, as do FINER more, or None."""
    errors: list[float] = []
    seconds = 0.0
    first = 0
    for target in TARGETS:
        at = first
        while at <= first + FINER:
            if at == len(errors):
                if at == len(solver.settings) or seconds > MAX_SECONDS:
                    break
                began = time.perf_counter()
                errors.append(solver.error(solver.settings[at]))
                seconds = time.perf_counter() - began
            at += 1
            if errors[at - 1] > target:
                first = at
        if at > first + FINER:
            yield solver.settings[first]
        else:
            yield None


def shortest(runs: dict[tuple[str, float], Run], rounds: int) -> dict[tuple[str, float], float]:
    """Return the milliseconds of each run, the shortest of many that take turns."""
    best = dict.fromkeys(runs, math.inf)
    spent: Counter[tuple[str, float]] = Counter()
    for _ in range(rounds):
        for name, run in runs.items():
            if spent[name] >= ENOUGH:
                continue
            for _ in range(IN_A_ROW):
                began = time.perf_counter()
                run()
                seconds = time.perf_counter() - began
                best[name] = min(best[name], seconds)
                spent[name] += seconds
    return {name: 1e3 * seconds for name, seconds in best.items()}


def measure(share: float) -> dict[str, Any]:
    runs: dict[tuple[str, float], Run] = {}
    skipped = {}
    for package, families in SOLVERS.items():
        try:
            for solver in chain.from_iterable(family() for family in families):
                solver.error(solver.settings[0])  # compiles
                for target, setting in zip(TARGETS, loosest(solver), strict=True):
                    if setting is not None:
                        runs[solver.name, target] = solver.to_the_end(setting)
        except (ImportError, OSError) as error:  # missing, or without the libraries it needs
            skipped[package] = str(error)
    times = shortest(runs, rounds=max(1, round(200 * share)))
    table: dict[str, dict[str, float]] = {}
    for (name, target), milliseconds in times.items():
        table.setdefault(name, {})[f"{target:g}"] = round(milliseconds, 4)
    ours = {method.label for method in (*GENERAL, TAYLOR_20)}
    integrated = {run: ms for run, ms in times.items() if run[0] != "closed form"}
    first = {
        target: min((ms, name) for (name, at), ms in integrated.items() if at == target)[1]
        for target in TARGETS
    }
    behind = [f"{target:g}: {name}" for target, name in first.items() if name not in ours]
    return {"ms": table, "skipped": skipped, "behind": behind, "targets_behind": len(behind)}
