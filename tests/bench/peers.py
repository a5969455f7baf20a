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

LIMITS = {"largest_ratio": 1.0}  # of our first to that of the others, at a target
OURS = [
    method for method in (*GENERAL, TAYLOR_20) if method.order > 1 and not method.varies
]  # order 1 takes too long
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
"""To the end."""


class Solver(NamedTuple):
    """A solver, and how to prepare a run with a setting and its largest error of theta [rad]."""

    name: str
    prepare: Callable[[Any], tuple[Run, Callable[[], float]]]
    settings: Sequence[float] = TOLERANCES  # from coarse to fine


def solver(name: str, solve: Callable[[float, Any], Any], end: Any) -> Solver:
    """Return a solver that takes a tolerance and times, and gives theta at them."""
    return Solver(
        name,
        lambda tolerance: (
            partial(solve, tolerance, end),
            lambda: largest_error(solve(tolerance, TIMES)),
        ),
    )


def largest_error(theta: Any) -> float:
    return float(np.max(np.abs(np.asarray(theta)[-len(EXACT) :] - EXACT)))


def method_solvers() -> Iterator[Solver]:
    """The lab's methods, compiled."""
    for method in OURS:
        propagate = compiled(method, SCENE.equations).propagate

        def prepare(steps: int, propagate: Any = propagate) -> tuple[Run, Callable[[], float]]:
            h = END / steps
            stride = steps // 400 or 1

            def error() -> float:
                phase = START
                largest = 0.0
                for done in range(stride, steps + 1, stride):
                    phase = propagate(phase, h, stride)
                    largest = max(largest, abs(phase[0] - MOTION.at(done * h).theta))
                return largest

            return partial(propagate, START, h, steps), error

        yield Solver(method.label, prepare, STEPS)


def scipy_solvers() -> Iterator[Solver]:
    """solve_ivp with its fastest methods here; the right-hand side is Python, as usual."""
    solve_ivp = import_module("scipy.integrate").solve_ivp

    def slope(t: float, y: Any) -> list[float]:
        return [y[1], -W0_SQUARED * math.sin(y[0])]

    def solve(method: str, tolerance: float, times: Any) -> Any:
        tolerances = {"rtol": max(tolerance, 3e-14), "atol": tolerance}
        return solve_ivp(slope, (0, END), START, method, times, **tolerances).y[0]

    for method in ("DOP853", "LSODA"):
        yield solver(f"scipy {method}", partial(solve, method), end=None)


def diffrax_solvers() -> Iterator[Solver]:
    """Explicit solvers in double precision, compiled by JAX."""
    jax = import_module("jax")
    jax.config.update("jax_enable_x64", True)
    diffrax = import_module("diffrax")

    def slope(t: Any, y: Any, arguments: Any) -> Any:
        return jax.numpy.stack([y[1], -W0_SQUARED * jax.numpy.sin(y[0])])

    def solve(name: str, tolerance: Any, times: Any) -> Any:
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

    def finished(jitted: Any, tolerance: float, times: Any) -> Any:
        return jitted(tolerance, times).block_until_ready()

    for name in ("Tsit5", "Dopri8"):
        jitted = jax.jit(partial(solve, name))
        yield solver(f"diffrax {name}", partial(finished, jitted), end=TIMES[-1:])


def heyoka_solvers() -> Iterator[Solver]:
    """Taylor's method, whose order follows from the tolerance."""
    heyoka = import_module("heyoka")
    theta, omega = heyoka.make_vars("theta", "omega")
    equations = [(theta, omega), (omega, -W0_SQUARED * heyoka.sin(theta))]

    def prepare(fast: bool, tolerance: float) -> tuple[Run, Callable[[], float]]:
        tolerance = max(tolerance, 2.3e-16)
        solver = heyoka.taylor_adaptive(equations, list(START), tol=tolerance, fast_math=fast)

        def restart() -> Any:
            solver.time = 0.0
            solver.state[:] = START
            return solver

        def error() -> float:
            return largest_error(restart().propagate_grid(GRID)[-1][:, 0])

        return lambda: restart().propagate_until(END), error

    for name, fast in (("heyoka", False), ("heyoka, fast_math", True)):
        yield Solver(name, partial(prepare, fast))


SOLVERS = {
    "engine": (method_solvers,),
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
                _, error = solver.prepare(solver.settings[at])
                began = time.perf_counter()
                errors.append(error())
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
                solver.prepare(solver.settings[0])[1]()  # compiles
                for target, setting in zip(TARGETS, loosest(solver), strict=True):
                    if setting is not None:
                        runs[solver.name, target], _ = solver.prepare(setting)
        except (ImportError, OSError) as error:  # missing, or without the libraries it needs
            skipped[package] = str(error)
    times = shortest(runs, rounds=max(1, round(200 * share)))
    table: dict[str, dict[str, float]] = {}
    for (name, target), milliseconds in times.items():
        table.setdefault(name, {})[f"{target:g}"] = round(milliseconds, 4)
    ours = {method.label for method in OURS}
    ratios = {}
    for target in map("{:g}".format, TARGETS):
        first = {True: math.inf, False: math.inf}
        for name in table:
            first[name in ours] = min(first[name in ours], table[name].get(target, math.inf))
        ratios[target] = round(first[True] / first[False], 2)
    return {
        "ms": table,
        "skipped": skipped,
        "ratios": ratios,
        "largest_ratio": max(ratios.values()),
    }
