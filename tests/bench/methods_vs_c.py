"""One trajectory of each method, plain and compiled, against a C loop of the same operations: one JSON object.

Ratios are of the same run.  `plain_alternatives` is how the plain loop was chosen: what the same explicit
Euler costs in other shapes.
"""

import json
import math
import tempfile
from collections.abc import Callable
from typing import Any, NamedTuple

import numba

from engine.methods import METHODS, Method, explicit_euler
from engine.models.pendulum import acceleration
from engine.run import loops
from engine.run.compiled import _pendulum, compiled
from engine.run.lockstep import Lockstep
from engine.run.loops import Loops, plain
from engine.scenes import DEFAULT_SCENE as SCENE
from tests.bench.lockstep import STEPS, c_rate, rate
from tests.bench.lockstep import compiled as c_library

COMPILED_LIMIT = 0.9  # of C
PLAIN_LIMITS = {"explicit_euler": 1 / 10, "symplectic_euler": 1 / 10, "velocity_verlet": 1 / 10, "rk4": 1 / 14}
LOCKSTEP_LIMIT = 15 / 13  # of C's four loops one after the other, which are without energies
MANY = 40 * STEPS
START, W0_SQUARED, H = (SCENE.theta, SCENE.omega), SCENE.w0_squared, SCENE.h


def travel_rate(loops_of: Callable[[Method], Loops], method: Method, steps: int) -> float:
    """Steps a second, nothing but steps."""
    travel = loops_of(method).travel
    travel(W0_SQUARED, START, H, 1)
    return rate(lambda: travel(W0_SQUARED, START, H, steps), steps)


def fused() -> Callable[[int], Any]:
    """All four methods in one compiled loop, so that their sines overlap; nothing but steps."""
    pendulum = _pendulum(numba)
    first, second, third, fourth = (numba.njit(method.step) for method in METHODS)

    @numba.njit
    def run(w0_squared: float, start: tuple[float, float], h: float, n: int) -> Any:
        force = pendulum(w0_squared).acceleration
        a = b = c = d = start
        for _ in range(n):
            a, b, c, d = first(force, a, h), second(force, b, h), third(force, c, h), fourth(force, d, h)
        return a, b, c, d

    ends = run(W0_SQUARED, START, H, 1000)
    assert list(ends) == [plain(method).travel(W0_SQUARED, START, H, 1000) for method in METHODS]
    return lambda n: run(W0_SQUARED, START, H, n)


class NamedPhase(NamedTuple):
    """A phase with names."""

    theta: float
    omega: float


class Bound:
    """Explicit Euler as a method of an object."""

    def __init__(self) -> None:
        self.force, self.h = acceleration(W0_SQUARED), H

    def step(self, phase: tuple[float, float]) -> tuple[float, float]:
        """One step."""
        theta, omega = phase
        return theta + self.h * omega, omega + self.h * self.force(theta)


def repeated(step: Callable[[Any], Any], start: Any) -> Callable[[int], Any]:
    """A loop over a step that knows its force and h."""

    def run(n: int) -> Any:
        phase = start
        for _ in range(n):
            phase = step(phase)
        return phase

    return run


def loop_inside(n: int) -> tuple[float, float]:
    """Explicit Euler with the loop inside the method, the force passed in."""
    (theta, omega), force, h = START, acceleration(W0_SQUARED), H
    for _ in range(n):
        theta, omega = theta + h * omega, omega + h * force(theta)
    return theta, omega


def plain_alternatives() -> dict[str, float]:
    """Explicit Euler in other shapes [steps a second]."""
    force, bound = acceleration(W0_SQUARED), Bound()

    def default_arguments(theta: float, minus: float = -W0_SQUARED, sin: Callable[[float], float] = math.sin) -> float:
        return minus * sin(theta)

    def named(phase: NamedPhase) -> NamedPhase:
        theta, omega = phase
        return NamedPhase(theta + H * omega, omega + H * force(theta))

    runs: dict[str, Callable[[int], Any]] = {
        "calls; tuple, force is a closure": lambda n: loops.travel(explicit_euler, force, START, H, n),
        "calls; tuple, force with default arguments": lambda n: loops.travel(
            explicit_euler, default_arguments, START, H, n
        ),
        "calls; bound method": repeated(bound.step, START),
        "calls; NamedTuple": repeated(named, NamedPhase(*START)),
        "loop inside the method, force called": loop_inside,
        "written out from the method's source (used)": lambda n: plain(METHODS[0]).travel(W0_SQUARED, START, H, n),
    }
    ends = {tuple(run(1000)) for run in runs.values()}
    assert len(ends) == 1
    return {name: rate(lambda: run(STEPS), STEPS) for name, run in runs.items()}  # noqa: B023


def one_trajectory(library: Any, method: Method) -> dict[str, Any]:
    """C, compiled and plain [steps a second], and their ratios."""
    c = c_rate(library, method, "travel")
    fast, slow = travel_rate(compiled, method, MANY), travel_rate(plain, method, STEPS)
    limits = {"compiled_of_c": COMPILED_LIMIT, "plain_of_c": PLAIN_LIMITS[method.key]}
    ratios = {"compiled_of_c": c and fast / c, "plain_of_c": c and slow / c}
    passed = c and all(ratios[name] >= limit for name, limit in limits.items())
    return {"c": c, "compiled": fast, "plain": slow, **ratios, "limits": limits, "pass": passed}


def lockstep_of_four(library: Any) -> dict[str, Any]:
    """All methods together, compiled [lockstep steps a second], against C's four loops one after the other."""
    one_loop, lockstep = fused(), Lockstep(SCENE, loops=compiled)
    lockstep.advance(1)
    speeds = {
        "steps only, one loop": rate(lambda: one_loop(MANY), MANY),
        "steps only, four loops": 1 / sum(1 / travel_rate(compiled, method, MANY) for method in METHODS),
        "Lockstep, energies at every step": rate(lambda: lockstep.advance(MANY), MANY),
    }
    if library is None:
        return {**speeds, "pass": None}
    c, c_energies = (
        1 / sum(1 / c_rate(library, method, loop) for method in METHODS)  # type: ignore[operator]
        for loop in ("travel", "advance")
    )
    ratio = speeds["steps only, one loop"] / c
    return {
        **speeds,
        "c, steps only": c,
        "c, energies at every step": c_energies,
        "one_loop_of_c": ratio,
        "lockstep_of_c_with_energies": speeds["Lockstep, energies at every step"] / c_energies,
        "limits": {"one_loop_of_c": LOCKSTEP_LIMIT},
        "pass": ratio >= LOCKSTEP_LIMIT,
    }


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        library = c_library(folder)
        methods = {method.key: one_trajectory(library, method) for method in METHODS}
        together = lockstep_of_four(library)
    report = {
        "bench": "methods_vs_c",
        "methods": methods,
        "lockstep_of_four": together,
        "plain_alternatives": plain_alternatives(),
        "pass": all(part["pass"] is not False for part in (*methods.values(), together)),
    }
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
