"""Speed against accuracy: each method's errors and costs over a ladder of h.

Every h is a whole fraction of the time, and errors in theta are taken at whole steps, so nothing is
interpolated.  Cost is counted in force evaluations, or in seconds by a clock that is passed in.
"""

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache, partial
from itertools import product
from statistics import fmean
from typing import Literal

from pendu_tui.engine.methods import GENERAL, Cast, Method
from pendu_tui.engine.methods.own import OwnMethod
from pendu_tui.engine.methods.runge_kutta import RK4
from pendu_tui.engine.run.lockstep import Lockstep
from pendu_tui.engine.run.loops import (
    LoopsOf,
    PlainLoops,
    TieredLoops,
    available,
    count_evaluations,
)
from pendu_tui.engine.scenes import Scene

ErrorKind = Literal["theta", "energy", "final"]
Clock = Callable[[], float]  # s
COMPARISONS = 400  # with the exact swing in a run: at least so many (below 800), or every step
TIMED_STEPS = 20_000  # at least, in each measurement of seconds
Z_LADDER = (0.6, 0.0015, 12)  # from about ten to four thousand steps a small swing
ALL_LADDER = (2.4, 0.0015, 14)  # for BM4 and BM6, too, which are stable up to 3

Flaw = Literal["lost", "rounding"]
REASONS: dict[Flaw, str] = {
    "lost": "no correct digit",
    "rounding": "rounding error: a smaller h no longer reduces it",
}
Errors = Mapping[ErrorKind, float]
"""The largest errors in theta [rad] against the exact swing, and in energy, relative, of all steps;
and the last in theta [rad]."""


@dataclass(frozen=True, slots=True)
class Point:
    """One run of one method: its errors and its cost."""

    method: Method
    time: float  # s, simulated
    w0: float  # rad/s
    steps: int
    errors: Errors = field(hash=False)
    # why an error says nothing about the method and h
    flaws: Mapping[ErrorKind, Flaw | None] = field(hash=False, repr=False)
    force_evaluations: int
    seconds: float | None = None  # the shortest of five runs without comparisons
    spread: float | None = None  # relative excess of the longest

    @property
    def h(self) -> float:
        """The step size [s]."""
        return self.time / self.steps

    @property
    def z(self) -> float:
        """The step in the system's own unit of time."""
        return self.h * self.w0

    @property
    def steps_per_swing(self) -> float:
        """Steps per small-amplitude period."""
        return math.tau / self.z


class Study:
    """Runs of one scene over one time, compared with the same exact swing."""

    def __init__(self, scene: Scene, time: float, loops: LoopsOf = PlainLoops) -> None:
        self.scene = scene
        self.time = time
        self.loops = cache(loops)  # so that the steps of all its runs count
        self.exact = scene.exact()
        energy, theta = rounding_floor(scene, time)
        self._floors: Errors = {"theta": theta, "energy": energy, "final": theta}
        times = (time * comparison / COMPARISONS for comparison in range(COMPARISONS + 1))
        width = min(math.pi, max(abs(self.exact.at(t).theta) for t in times))
        self.sizes: Errors = {"theta": width, "energy": 1.0, "final": width}
        """The sizes of the swing itself: an error as large says nothing."""

    def run(self, method: Method, steps: int, comparisons: int = COMPARISONS) -> Point:
        """Take so many steps; compare `comparisons` or more, and the last, with the exact swing.

        An error counts as rounding if it lies below the rounding floor and does not fall with h.
        Raises InputError if time/steps is no usable h.
        """
        errors, overflowed = self._errors(method, steps, comparisons)
        flaws = {kind: self.flaw(kind, error, steps) for kind, error in errors.items()}
        if overflowed:
            flaws = dict.fromkeys(errors, "lost")
        if "rounding" in flaws.values():
            falling = self._falling(method, steps, comparisons, errors)
            flaws |= {kind: None for kind in falling if flaws[kind] == "rounding"}
        evaluations = method.evaluations(steps)
        if method.varies and not overflowed:  # extrapolated from the first 2000
            model = self.scene.equations
            start = model.start(self.scene.theta, self.scene.omega)
            first = min(steps, 2000)
            count = count_evaluations(method, model, start, self.time / steps, first)
            evaluations = round(count * steps / first)
        return Point(method, self.time, self.scene.w0, steps, errors, flaws, evaluations)

    def _errors(self, method: Method, steps: int, comparisons: int) -> tuple[Errors, bool]:
        """Return the errors of a run, and whether its numbers overflowed."""
        lockstep = Lockstep(
            self.scene.altered(h=self.time / steps, cast=(method,)), loops=self.loops
        )
        stride = max(1, steps // comparisons)
        largest = final = 0.0
        while lockstep.step < steps:
            lockstep.advance(min(stride, steps - lockstep.step))
            (reading,) = lockstep.sample().readings
            final = abs(reading.theta - self.exact.at(lockstep.t).theta)
            largest = max(largest, final)
        errors: Errors = {"theta": largest, "energy": reading.max_energy_error, "final": final}
        return errors, reading.diverged_at is not None

    def flaw(self, kind: ErrorKind, error: float, steps: int) -> Flaw | None:
        """Return whether an error is as large as the swing, or below the floor of its roundings."""
        if error >= self.sizes[kind]:
            return "lost"
        if error <= self._floors[kind] * math.sqrt(steps):
            return "rounding"
        return None

    def _falling(
        self, method: Method, steps: int, comparisons: int, errors: Errors
    ) -> list[ErrorKind]:
        """Return which errors fall with h, from a quarter of the steps on.

        Doubling the steps must reduce an error by at least half of what the order promises.
        """
        half, _ = self._errors(method, max(1, steps // 2), comparisons)
        quarter, _ = self._errors(method, max(1, steps // 4), comparisons)
        factor = 2 ** (method.order - 1)
        return [
            kind
            for kind, error in errors.items()
            if error * factor <= half[kind] and half[kind] * factor <= quarter[kind]
        ]


def timed(point: Point, scene: Scene, clock: Clock, loops: LoopsOf = PlainLoops) -> Point:
    """Return the point with the seconds of the same steps without comparisons and energies."""
    propagate = partial(
        loops(point.method, scene.equations).propagate,
        (scene.theta, scene.omega),
        point.h,
        point.steps,
    )
    propagate()  # may have to be compiled
    runs = max(1, TIMED_STEPS // point.steps)
    lengths = []
    for _ in range(5):
        began = clock()
        for _ in range(runs):
            propagate()
        lengths.append((clock() - began) / runs)
    return replace(point, seconds=min(lengths), spread=max(lengths) / min(lengths) - 1)


def ladder(time: float, h_max: float, h_min: float, count: int) -> list[int]:
    """Return up to `count` numbers of steps, for h from h_max to h_min in equal ratios."""
    ratio = (h_min / h_max) ** (1 / max(1, count - 1))
    return sorted({max(1, round(time / (h_max * ratio**rung))) for rung in range(count)})


def usual(scene: Scene, all: bool, time: float | None = None) -> tuple[float, list[int]]:
    """Return a time [s], by default ten small swings, and a ladder for the usual cast or `all`."""
    time = time or float(f"{10 * math.tau / scene.w0:.2g}")
    largest, smallest, rungs = Z_LADDER
    if all:
        largest, smallest, rungs = ALL_LADDER
    return time, ladder(time, min(largest / scene.w0, time), smallest / scene.w0, rungs)


def with_all_methods(scene: Scene) -> Scene:
    """Return the scene with its cast and then every other general method."""
    others = (method for method in GENERAL if method not in scene.cast)
    return scene.altered(cast=(*scene.cast, *others))


def compilable(cast: Cast) -> bool:
    """Return whether to time these methods compiled by Numba: all of them, or for fairness none."""
    return available() and not any(isinstance(method, OwnMethod) for method in cast)


_cached_study = lru_cache(maxsize=1)(Study)


def measured_point(scene: Scene, time: float, loops: LoopsOf, task: tuple[int, Method]) -> Point:
    """Return the point of a number of steps and a method.

    For other processes, which keep the study between tasks.
    """
    steps, method = task
    return _cached_study(scene, time, loops).run(method, steps)


def measured(scene: Scene, time: float, rungs: Sequence[int]) -> Iterator[Point]:
    """Yield a point for every number of steps and every method; for another process."""
    for task in product(rungs, scene.cast):
        yield measured_point(scene, time, TieredLoops, task)


Cost = Literal["evaluations", "seconds"]


@dataclass(frozen=True, slots=True)
class Cheapest:
    """The cheapest method at one accuracy."""

    target: float  # of the error
    method: Method
    cost: float  # force evaluations or seconds
    saves: float | None  # RK4's force evaluations over this method's; None: one is not known


def cost_of(point: Point, cost: Cost) -> float:
    """Return the cost of a run; 0 if it is not timed, or has no force evaluations."""
    if cost == "seconds":
        return point.seconds or 0.0
    return point.force_evaluations


def front(points: Iterable[Point], kind: ErrorKind, cost: Cost) -> list[Cheapest]:
    """Return the cheapest method at errors of 0.1, 0.01 and so on, the largest error first.

    Costs are interpolated between a method's points, log over log.  An error is left out if the
    coarsest run of a method is that accurate, since a coarser one may be cheaper.
    """
    lines: dict[Method, list[Point]] = {}
    for point in sorted(points, key=lambda point: point.steps):
        lines.setdefault(point.method, []).append(point)
    cheapest = []
    for decade in range(1, 16):
        target = 10.0**-decade
        if any(_reaches(line[0], kind, target) for line in lines.values()):
            continue
        costs = {method: cost_at(line, kind, cost, target) for method, line in lines.items()}
        known = {method: found for method, found in costs.items() if found}
        if known:
            best = min(known, key=known.__getitem__)
            own = cost_at(lines[best], kind, "evaluations", target)
            rk4 = cost_at(lines.get(RK4, ()), kind, "evaluations", target)
            cheapest.append(Cheapest(target, best, known[best], own and rk4 and rk4 / own))
    return cheapest


def cost_at(line: Sequence[Point], kind: ErrorKind, cost: Cost, target: float) -> float | None:
    """Return the interpolated cost at which the error falls to `target`, or None.

    `line` are the points of a method, from coarse to fine.
    """
    reached = (place for place, point in enumerate(line) if _reaches(point, kind, target))
    first = next(reached, None)
    if first is None or not (high := cost_of(line[first], cost)):
        return None
    below = line[first].errors[kind]
    above = line[first - 1].errors[kind]
    if not first or not below or not target < above < math.inf:
        return high
    low = cost_of(line[first - 1], cost)
    share = math.log(above / target) / math.log(above / below)
    return float(low * (high / low) ** share)


def _reaches(point: Point, kind: ErrorKind, target: float) -> bool:
    return point.flaws[kind] != "lost" and point.errors[kind] <= target


NUDGE = 1e-9  # relative; small even near the separatrix, but far above the exact swing's error


def rounding_floor(scene: Scene, time: float) -> tuple[float, float]:
    """Return the rounding error of energy (relative) and theta [rad] per square root of steps.

    A step changes the energy at random by a relative epsilon (Brouwer, Astron. J. 46 (1937) 149).
    Theta responds to a change of energy as the exact swing to passing the bottom a little slower:
    the more the later, and steeply near the separatrix.  The floor is an upper estimate: RK4 at
    tiny steps errs by 0.005 to 0.6 times it.
    """
    epsilon = sys.float_info.epsilon
    exact = scene.exact()
    swing = ((exact.period or time) * sample / 400 for sample in range(401))
    start = max(map(exact.at, swing), key=lambda state: abs(state.omega))
    moving = scene.altered(theta=start.theta, omega=start.omega).exact()
    slower = scene.altered(theta=start.theta, omega=start.omega * (1 - NUDGE)).exact()
    times = [time * sample / 400 for sample in range(401)]
    # twice, so that nearly all errors above the floor are due to the method
    energy = 2 * epsilon
    response = [(moving.at(t).theta - slower.at(t).theta) / NUDGE for t in times]
    # energy changes at any time of the run
    return energy, energy * math.sqrt(fmean(r * r for r in response))
