"""Speed against accuracy: each method's errors and costs over a ladder of h.

Every h is a whole fraction of the time, and errors in theta are taken at whole steps, so nothing is
interpolated.  Cost is counted in force evaluations, or in seconds by a clock that is passed in.
"""

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial
from itertools import groupby, product
from statistics import fmean, linear_regression
from typing import Literal, NamedTuple

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
from pendu_tui.engine.scenes import Z_LIMITS, Scene

ErrorKind = Literal["theta", "energy", "final"]
Clock = Callable[[], float]  # s
COMPARISONS = 400  # with the exact swing in a run: at least so many (below 800), or every step
TIMED_STEPS = 20_000  # at least, in each measurement of seconds
Z_LADDER = (0.6, 0.0015, 12)  # from about ten to four thousand steps a small swing
ALL_LADDER = (2.4, 0.0015, 14)  # for BM4 and BM6, too, which are stable up to 3
ORDER_STEPS = tuple(2**power for power in range(4, 15))
FITTED_BELOW = 0.1  # rad; larger errors are not yet proportional to a power of h


Flaw = Literal["lost", "rounding", "diverged"]
REASONS: dict[Flaw, str] = {
    "lost": "as far off as the swing is wide, or as the energy is large",
    "rounding": "made of rounding: a smaller h no longer reduces it",
    "diverged": "the numbers overflowed",
}


class Flaws(NamedTuple):
    """Why an error says nothing about the method and h; None if it does."""

    theta: Flaw | None
    energy: Flaw | None
    final: Flaw | None


@dataclass(frozen=True, slots=True)
class Point:
    """One run of one method: its errors and its cost."""

    method: Method
    time: float  # s, simulated
    w0: float  # rad/s
    steps: int
    theta_error: float  # rad, the largest against the exact swing
    energy_error: float  # relative, the largest of all steps
    final_error: float  # rad, in theta at the end
    flaws: Flaws
    seconds: float | None = None  # the shortest of five runs without comparisons
    spread: float | None = None  # relative excess of the longest
    counted: int | None = None  # force evaluations, where they vary

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
        """How many steps a small swing takes."""
        return math.tau / self.z

    @property
    def force_evaluations(self) -> int:
        if self.counted is not None:
            return self.counted
        return self.method.evaluations(self.steps)

    def error(self, kind: ErrorKind) -> float:
        error: float = getattr(self, f"{kind}_error")
        return error

    def flaw(self, kind: ErrorKind) -> Flaw | None:
        flaw: Flaw | None = getattr(self.flaws, kind)
        return flaw


class Order(NamedTuple):
    """A method's order, measured by its theta errors."""

    method: Method
    measured: float | None  # None: fewer than three errors to fit


class Study:
    """Runs of one scene over one time, compared with the same exact swing."""

    def __init__(self, scene: Scene, time: float, loops: LoopsOf = PlainLoops) -> None:
        self.scene = scene
        self.time = time
        self.loops = cache(loops)  # so that the steps of all its runs count
        self.exact = scene.exact()
        energy, theta = rounding_floor(scene, time)
        self._floors = (theta, energy, theta)
        times = (time * comparison / COMPARISONS for comparison in range(COMPARISONS + 1))
        width = min(math.pi, max(abs(self.exact.at(t).theta) for t in times))
        self.sizes = {"theta": width, "energy": 1.0, "final": width}
        """The sizes of the swing itself: an error as large says nothing."""

    def run(self, method: Method, steps: int, comparisons: int = COMPARISONS) -> Point:
        """Take so many steps; compare `comparisons` or more, and the last, with the exact swing.

        An error counts as rounding if it lies below the rounding floor and does not fall with h.
        Raises InputError if time/steps is no usable h.
        """
        errors, diverged = self._errors(method, steps, comparisons)
        flaws = Flaws("diverged", "diverged", "diverged")
        counted = None
        if not diverged:
            refines = partial(self._refines, method, steps, comparisons, errors)
            flaws = self.flaws(errors, steps, refines)
            if method.varies:  # extrapolated from the first 2000
                model = self.scene.equations
                start = model.start(self.scene.theta, self.scene.omega)
                first = min(steps, 2000)
                count = count_evaluations(method, model, start, self.time / steps, first)
                counted = round(count * steps / first)
        return Point(method, self.time, self.scene.w0, steps, *errors, flaws=flaws, counted=counted)

    def _errors(
        self, method: Method, steps: int, comparisons: int
    ) -> tuple[tuple[float, float, float], bool]:
        """Return the largest errors in theta and energy, the last in theta, and if it diverged."""
        lockstep = Lockstep(
            self.scene.altered(h=self.time / steps, cast=(method,)), loops=self.loops
        )
        stride = max(1, steps // comparisons)
        theta_error = final_error = 0.0
        while lockstep.step < steps:
            lockstep.advance(min(stride, steps - lockstep.step))
            (reading,) = lockstep.sample().readings
            final_error = abs(reading.theta - self.exact.at(lockstep.t).theta)
            theta_error = max(theta_error, final_error)
        return (theta_error, reading.max_energy_error, final_error), reading.diverged_at is not None

    def _refines(
        self, method: Method, steps: int, comparisons: int, errors: Sequence[float]
    ) -> list[bool]:
        """Return which errors fall with h, from a quarter of the steps on.

        Doubling the steps must reduce an error by at least half of what the order promises.
        """
        half, _ = self._errors(method, max(1, steps // 2), comparisons)
        quarter, _ = self._errors(method, max(1, steps // 4), comparisons)
        factor = 2 ** (method.order - 1)
        ladder = zip(quarter, half, errors, strict=True)
        return [fine * factor <= mid and mid * factor <= coarse for coarse, mid, fine in ladder]

    def flaws(
        self, errors: Sequence[float], steps: int, refines: Callable[[], Sequence[bool]]
    ) -> Flaws:
        """Return what is wrong with the errors in theta, energy and final theta of a run.

        An error below the floor of so many roundings is rounding unless it falls with h.  Only then
        `refines` is called, for that is slow.
        """
        flaws: list[Flaw | None] = [None, None, None]
        floors = [floor * math.sqrt(steps) for floor in self._floors]
        below = [error <= floor for error, floor in zip(errors, floors, strict=True)]
        if any(below):
            for kind, refined in enumerate(refines()):
                if below[kind] and not refined:
                    flaws[kind] = "rounding"
        for kind, size in enumerate(self.sizes.values()):
            if errors[kind] >= size:
                flaws[kind] = "lost"
        return Flaws(*flaws)

    def may_be_rounding(self, point: Point) -> bool:
        """Whether a point's error in theta lies below the rounding floor."""
        return point.theta_error <= self._floors[0] * math.sqrt(point.steps)


def timed(point: Point, scene: Scene, clock: Clock, loops: LoopsOf = PlainLoops) -> Point:
    """Return the point with the seconds of the same steps without comparisons and energies."""
    propagate = loops(point.method, scene.equations).propagate
    start = (scene.theta, scene.omega)
    propagate(start, point.h, 1)  # may have to be compiled
    runs = max(1, TIMED_STEPS // point.steps)
    seconds, spread = shortest(lambda: propagate(start, point.h, point.steps), runs, clock)
    return replace(point, seconds=seconds, spread=spread)


def shortest(work: Callable[[], object], runs: int, clock: Clock) -> tuple[float, float]:
    """Return the shortest of five timings [s], and the relative excess of the longest."""
    work()  # may have to be compiled
    lengths = []
    for _ in range(5):
        began = clock()
        for _ in range(runs):
            work()
        lengths.append((clock() - began) / runs)
    return min(lengths), max(lengths) / min(lengths) - 1


def ladder(time: float, h_max: float, h_min: float, count: int) -> list[int]:
    """Return up to `count` numbers of steps, for h from h_max to h_min in equal ratios."""
    ratio = (h_min / h_max) ** (1 / max(1, count - 1))
    return sorted({max(1, round(time / (h_max * ratio**rung))) for rung in range(count)})


def usual(scene: Scene, all: bool = False, time: float | None = None) -> tuple[float, list[int]]:
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


def measured(scene: Scene, time: float, rungs: Sequence[int]) -> Iterator[Point]:
    """Yield a point for every number of steps and every method; for another process."""
    study = Study(scene, time, TieredLoops)
    for steps, method in product(rungs, scene.cast):
        yield study.run(method, steps)


def measured_point(scene: Scene, time: float, loops: LoopsOf, task: tuple[int, int]) -> Point:
    """Return the point of a task: the index of a method in the cast, and a number of steps.

    For other processes, which keep the study between tasks.
    """
    index, steps = task
    return _cached_study(scene, time, loops).run(scene.cast[index], steps)


_cached_study = lru_cache(maxsize=1)(Study)


def orders(scene: Scene, time: float, loops: LoopsOf = PlainLoops) -> list[Order]:
    """Return each method's order: the slope of log theta error over log h, up to a period.

    Over longer times RK4 reads 5 and more: its phase error a·h⁴·t is overtaken by b·h⁵·t²/2, since
    it loses energy at a rate of h⁵ and the frequency depends on energy.  Near the separatrix, where
    it does so steeply, RK4 reads 5 within a period.  Symplectic Euler reads 2 from theta = 0, where
    its angles are velocity Verlet's.
    """
    study = Study(scene, min(time, scene.exact().period or math.tau / scene.w0), loops)
    usable = [steps for steps in ORDER_STEPS if study.time / steps * scene.w0 >= Z_LIMITS[0]]
    return [Order(method, _order(study, method, usable)) for method in scene.cast]


def _order(study: Study, method: Method, ladder: Sequence[int]) -> float | None:
    """Return the least-squares slope of log theta error over log h, of the four smallest h."""
    points = [study.run(method, steps, ORDER_STEPS[0]) for steps in ladder]
    fitted = [
        (math.log(point.h), math.log(point.theta_error))
        for point in points
        if not study.may_be_rounding(point)
        and point.flaws.theta is None
        and point.theta_error < FITTED_BELOW
    ][-4:]
    if len(fitted) < 3:
        return None
    return linear_regression(*zip(*fitted, strict=True)).slope


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
            best = min(known, key=lambda method: known[method])
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
    below = line[first].error(kind)
    if not first or not below:
        return high
    low = cost_of(line[first - 1], cost)
    above = line[first - 1].error(kind)
    if not low or not target < above < math.inf:
        return high
    share = math.log(above / target) / math.log(above / below)
    return float(low * (high / low) ** share)


def ranges(cheapest: Sequence[Cheapest]) -> list[tuple[Method, Sequence[Cheapest]]]:
    """Return the front by method, each with its consecutive targets, the largest error first."""
    groups = groupby(cheapest, key=lambda entry: entry.method)
    return [(method, tuple(entries)) for method, entries in groups]


def _reaches(point: Point, kind: ErrorKind, target: float) -> bool:
    return point.flaw(kind) in (None, "rounding") and point.error(kind) <= target


NUDGE = 1e-9  # relative; small even near the separatrix, but far above the exact swing's error


def rounding_floor(scene: Scene, time: float) -> tuple[float, float]:
    """Return the rounding error of energy (relative) and theta [rad] per square root of steps.

    A step changes the energy at random by a relative epsilon (Brouwer, Astron. J. 46 (1937) 149),
    or by more where theta has grown by many turns and its last digit is coarse.  Theta responds to
    a change of energy as the exact swing to passing the bottom a little slower: the more the later,
    and steeply near the separatrix.  The floor is an upper estimate: RK4 at tiny steps errs by
    0.005 to 0.6 times it.
    """
    epsilon = sys.float_info.epsilon
    exact = scene.exact()
    if exact.regime == "equilibrium":
        return epsilon, epsilon
    swing = ((exact.period or time) * sample / 400 for sample in range(401))
    start = max(map(exact.at, swing), key=lambda state: abs(state.omega))
    moving = scene.altered(theta=start.theta, omega=start.omega).exact()
    slower = scene.altered(theta=start.theta, omega=start.omega * (1 - NUDGE)).exact()
    times = [time * sample / 400 for sample in range(401)]
    widest = max(abs(exact.at(t).theta) for t in times)
    fastest = max(abs(exact.at(t).omega) for t in times)
    # not the root of a square, which underflows for 1e-170
    pace = scene.w0 * math.sqrt(widest) * math.sqrt(min(widest, 1.0)) / fastest
    # twice, so that nearly all errors above the floor are due to the method
    energy = 2 * epsilon * max(1.0, pace * pace)
    response = [(moving.at(t).theta - slower.at(t).theta) / NUDGE for t in times]
    # energy changes at any time of the run
    return energy, energy * math.sqrt(fmean(r * r for r in response))
