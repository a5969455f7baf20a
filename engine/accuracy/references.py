"""Reference lines on the chart of error against seconds: a Taylor series, and the closed form.

Neither has a step size h or force evaluations, so both are compared in seconds only.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any, ClassVar

import numpy as np

from engine.accuracy.rounding import rounding_floor
from engine.accuracy.study import (
    COMPARISONS,
    TIMED_STEPS,
    Clock,
    ErrorKind,
    Flaw,
    Flaws,
    Point,
    compilable,
    measured,
    shortest,
)
from engine.accuracy.taylor import MAX_STEPS, solve
from engine.methods import METHODS
from engine.models.exact_pendulum import exact_pendulum
from engine.run.compiled import available
from engine.scenes import Scene

TOLERANCES = tuple(0.1 * 10.0**-n for n in range(17))
"""Of omega, relative to the fastest of w0 and the start; the last ones are below rounding."""
ROUNDING = 4  # times the rounding floor of one force evaluation a step
ABSENT = "Taylor's series needs Numba, the extra `fast`."
UNFAIR = "Taylor's series is compiled by Numba, and these seconds are without it."
OTHER_MODEL = "Taylor's series is that of the pendulum, and of no other model."


@dataclass(frozen=True, slots=True)
class Reference:
    """A line on the chart that is not a method of the lockstep."""

    key: str  # in JSON
    label: str
    letter: str  # its mark on charts


TAYLOR_20 = Reference("taylor_20", "Taylor, order 20", "t")
CLOSED_FORM = Reference("closed_form", "Closed form", "c")


@dataclass(frozen=True, slots=True)
class TaylorPoint:
    """One run of Taylor's series: its errors at COMPARISONS times, and its cost."""

    method: ClassVar[Reference] = TAYLOR_20
    tolerance: float  # rad/s
    steps: int
    theta_error: float  # rad, the largest
    energy_error: float  # relative, the largest
    final_error: float  # rad, in theta at the end
    flaws: Flaws
    seconds: float  # to the end alone, the shortest of several runs
    spread: float  # by how much the longest took longer, relative

    def error(self, kind: ErrorKind) -> float:
        return {
            "theta": self.theta_error,
            "energy": self.energy_error,
            "final": self.final_error,
        }[kind]

    def flaw(self, kind: ErrorKind) -> Flaw | None:
        flaw: Flaw | None = getattr(self.flaws, kind)
        return flaw


AnyPoint = Point | TaylorPoint


@dataclass(frozen=True, slots=True)
class References:
    """The reference lines."""

    floor: float  # s, of COMPARISONS + 1 states by the closed form
    taylor: Sequence[TaylorPoint] = ()
    absent: str | None = None  # the reason why there is no Taylor series


def references(scene: Scene, time: float, clock: Clock, fast: bool) -> References:
    """Time the reference lines over `time` [s]; `fast`: compiled, next to compiled methods."""
    if not scene.equations.has_separatrix:
        return References(closed_form_seconds(scene.exact().at, time, clock), absent=OTHER_MODEL)
    if not fast:
        seconds = closed_form_seconds(scene.exact().at, time, clock)
        return References(seconds, absent=UNFAIR if available() else ABSENT)
    njit = import_module("numba").njit
    motion = exact_pendulum(scene.w0_squared, scene.theta, scene.omega, compile=njit).at
    seconds = closed_form_seconds(motion, time, clock, compile=njit)
    return References(seconds, tuple(taylor_points(scene, time, clock)))


def closed_form_seconds(
    motion: Any, time: float, clock: Clock, compile: Any = lambda function: function
) -> float:
    """Return the seconds of an exact motion at COMPARISONS + 1 times."""
    times = np.linspace(0, time, COMPARISONS + 1)
    states = compile(_states)
    return shortest(lambda: states(motion, times), 20, clock)[0]


def _states(motion: Any, times: Any) -> Any:
    return [motion(t) for t in times]


def taylor_points(scene: Scene, time: float, clock: Clock) -> Iterator[TaylorPoint]:
    """Yield timed points, the loosest first, as long as runs end.

    An error is rounding if it is below the rounding floor and no tighter tolerance halves it.
    """
    times = np.linspace(0, time, COMPARISONS + 1)
    start = (scene.w0_squared, scene.theta, scene.omega)
    exact = scene.exact()
    truth = np.array([exact.at(float(t)).theta for t in times])
    energy_floor, theta_floor = rounding_floor(scene, time)
    floors = ROUNDING * np.array([theta_floor, energy_floor, theta_floor])
    width = min(math.pi, float(np.max(np.abs(truth))))
    sizes = np.array([width, 1.0, width])
    looser = np.full(3, math.inf)
    for relative in TOLERANCES:
        tolerance = relative * max(scene.w0, abs(scene.omega))
        states, steps = solve(*start, times, tolerance)
        if steps == MAX_STEPS:
            return
        errors = _errors(scene, states, truth)
        rounded = (errors <= floors * math.sqrt(steps)) & (looser < 2 * errors)
        flaws = np.where(errors >= sizes, "lost", np.where(rounded, "rounding", ""))
        seconds, spread = shortest(
            lambda tolerance=tolerance: solve(*start, times[-1:], tolerance),  # type: ignore[misc]
            max(1, TIMED_STEPS // steps),
            clock,
        )
        named = Flaws(*(flaw or None for flaw in flaws.tolist()))
        theta_error, energy_error, final_error = errors.tolist()
        yield TaylorPoint(
            tolerance=tolerance,
            steps=steps,
            theta_error=theta_error,
            energy_error=energy_error,
            final_error=final_error,
            flaws=named,
            seconds=seconds,
            spread=spread,
        )
        looser = errors


def _errors(scene: Scene, states: Any, truth: Any) -> Any:
    """Return the largest errors in theta [rad] and in energy, and the last one in theta."""
    theta, omega = states.T
    model = scene.equations
    reference = model.reference(scene.theta, scene.omega)
    energies = (model.energy(np.sin)((theta, omega)) - reference.start) / reference.scale
    errors = np.abs(theta - truth)
    return np.array([np.max(errors), np.max(np.abs(energies)), errors[-1]])


def with_all_methods(scene: Scene) -> Scene:
    """Return the scene with every other method that takes any force after its cast."""
    others = (method for method in METHODS if method.general and method not in scene.cast)
    return scene.altered(cast=(*scene.cast, *others))


def measured_front(
    scene: Scene, time: float, rungs: Sequence[int], clock: Clock
) -> Iterator[Point | References]:
    """Yield timed points of every method of the cast, then the reference lines."""
    yield from measured(scene, time, rungs, clock)
    yield references(scene, time, clock, compilable(scene.cast))
