"""Speed against accuracy: each method's errors and costs over a ladder of h.

Every h is a whole fraction of the time, and errors in theta are taken at whole steps, the same for
all methods, so that nothing is interpolated.  Cost is counted in force evaluations, which are the
same on every machine, or in seconds by a clock that is passed in.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial
from statistics import linear_regression
from typing import Literal, NamedTuple

from engine.accuracy.rounding import rounding_floor
from engine.methods import GENERAL, Cast, Method
from engine.methods.own import OwnMethod
from engine.run.compiled import TieredLoops, available
from engine.run.lockstep import Lockstep
from engine.run.loops import LoopsOf, PlainLoops, count_evaluations
from engine.scenes import Z_LIMITS, Scene

ErrorKind = Literal["theta", "energy", "final"]
Clock = Callable[[], float]  # s
COMPARISONS = 400  # with the exact swing in a run: at least so many, or at every step; below 800
TIMED_STEPS = 20_000  # at least, in each measurement of seconds
Z_LADDER = (0.6, 0.0015, 12)  # about ten steps a small swing, to four thousand
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
    """Why an error does not show how the method depends on h; None where it does."""

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
    seconds: float | None = None  # the shortest of five runs without errors taken
    spread: float | None = None  # by how much the longest took longer, relative
    tolerance: float | None = None  # rad/s, of a series: it has no h and no force evaluations
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
    """A method's order: what theta errors scale with."""

    method: Method
    measured: float | None  # None: fewer than three errors to fit


class Study:
    """Runs of one scene over one time.  They share the exact swing and the rounding floor."""

    def __init__(self, scene: Scene, time: float, loops: LoopsOf = PlainLoops) -> None:
        self.scene = scene
        self.time = time
        self.loops = cache(loops)  # so that the steps of all its runs count
        self.exact = scene.exact()
        self.energy_scale = scene.equations.reference(scene.theta, scene.omega).scale
        self._energy_floor, self._theta_floor = rounding_floor(scene, time)
        times = (time * comparison / COMPARISONS for comparison in range(COMPARISONS + 1))
        self.thetas = [self.exact.at(t).theta for t in times]  # rad
        width = min(math.pi, max(map(abs, self.thetas)))
        self.sizes = {"theta": width, "energy": 1.0, "final": width}
        """Of the swing itself: an error as large says nothing."""

    def run(self, method: Method, steps: int, comparisons: int = COMPARISONS) -> Point:
        """Take this many steps; compare `comparisons` or more, and the last, with the truth.

        An error counts as rounding if it lies below the rounding floor, and if runs with a half and
        a quarter of the steps do not have errors larger by half of what the method's order
        promises.

        Raises SceneError where time/steps is no usable h.
        """
        errors, diverged = self._errors(method, steps, comparisons)
        flaws = Flaws("diverged", "diverged", "diverged")
        counted = None
        if not diverged:
            refines = partial(self._refines, method, steps, comparisons, errors)
            flaws = self.flaws(errors, steps, refines)
            if method.varies:
                counted = self._evaluations(method, steps)
        return Point(method, self.time, self.scene.w0, steps, *errors, flaws=flaws, counted=counted)

    def _refines(
        self, method: Method, steps: int, comparisons: int, errors: Sequence[float]
    ) -> list[bool]:
        """Return which errors still fall with the step, by half of what the order promises."""
        half, quarter = (
            self._errors(method, max(1, steps // part), comparisons)[0] for part in (2, 4)
        )
        least = 2 ** (method.order - 1)
        ladder = zip(errors, half, quarter, strict=True)
        return [a * least <= b and b * least <= c for a, b, c in ladder]

    def flaws(
        self,
        errors: Sequence[float],
        roundings: int,
        refines: Callable[[], Sequence[bool]] = lambda: (False, False, False),
    ) -> Flaws:
        """Return what is wrong with the errors in theta, energy and final theta of a run.

        An error below the floor of so many roundings is rounding, unless a smaller step still
        `refines` it, which is asked only there.
        """
        floors = [
            floor * math.sqrt(roundings)
            for floor in (self._theta_floor, self._energy_floor, self._theta_floor)
        ]
        found: list[Flaw | None] = [None, None, None]
        below = [error <= floor for error, floor in zip(errors, floors, strict=True)]
        if any(below):
            for kind, refined in enumerate(refines()):
                if below[kind] and not refined:
                    found[kind] = "rounding"
        for kind, size in enumerate(self.sizes.values()):
            if errors[kind] >= size:
                found[kind] = "lost"
        return Flaws(*found)

    def _evaluations(self, method: Method, steps: int) -> int:
        """Force evaluations of so many steps: counted, of many as an average of the first."""
        start = self.scene.equations.start(self.scene.theta, self.scene.omega)
        most = min(steps, 2000)
        found = count_evaluations(method, self.scene.equations, start, self.time / steps, most)
        return round(found * steps / most)

    def _errors(
        self, method: Method, steps: int, comparisons: int
    ) -> tuple[tuple[float, float, float], bool]:
        """Largest errors in theta [rad] and energy, last error in theta, whether it overflowed."""
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

    def may_be_rounding(self, point: Point) -> bool:
        """Whether a point's error in theta lies below the rounding floor."""
        return point.theta_error <= self._theta_floor * math.sqrt(point.steps)

    def points(self, ladder: Sequence[int]) -> Iterator[Point]:
        """A point for every number of steps and every method."""
        for steps in ladder:
            for method in self.scene.cast:
                yield self.run(method, steps)


def timed(point: Point, scene: Scene, clock: Clock, loops: LoopsOf = PlainLoops) -> Point:
    """The same point with its seconds: the same steps again, without comparisons and energies."""
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
    """At most `count` numbers of steps, for h from about h_max down to h_min in equal ratios."""
    ratio = (h_min / h_max) ** (1 / max(1, count - 1))
    return sorted({max(1, round(time / (h_max * ratio**rung))) for rung in range(count)})


def usual(scene: Scene, all: bool = False) -> tuple[float, list[int]]:
    """Return a time [s] and a ladder of steps for the usual cast, or for `all` methods.

    The time is that of ten small swings: 20 s for 1 m.
    """
    time = float(f"{10 * math.tau / scene.w0:.2g}")
    largest, smallest, rungs = Z_LADDER
    if all:
        largest, smallest, rungs = ALL_LADDER
    return time, ladder(time, largest / scene.w0, smallest / scene.w0, rungs)


def with_all_methods(scene: Scene) -> Scene:
    """Return the scene with every other method that takes any force after its cast."""
    others = (method for method in GENERAL if method not in scene.cast)
    return scene.altered(cast=(*scene.cast, *others))


def compilable(cast: Cast) -> bool:
    """Return whether to time these methods compiled by Numba.

    If one of them is a user's own, which cannot be compiled, none is: the timing is fair.
    """
    return available() and not any(isinstance(method, OwnMethod) for method in cast)


def measured(scene: Scene, time: float, rungs: Sequence[int]) -> Iterator[Point]:
    """A point for every number of steps and every method.

    For another process, which has only the arguments.
    """
    return Study(scene, time, TieredLoops).points(rungs)


def measured_point(scene: Scene, time: float, loops: LoopsOf, task: tuple[int, int]) -> Point:
    """Return the point of one task, the number of a method in the cast and that of its steps.

    For other processes, which get one task after the other and keep the study between them.
    """
    index, steps = task
    return _cached_study(scene, time, loops).run(scene.cast[index], steps)


@lru_cache(maxsize=1)
def _cached_study(scene: Scene, time: float, loops: LoopsOf) -> Study:
    return Study(scene, time, loops)


def orders(scene: Scene, time: float, loops: LoopsOf = PlainLoops) -> list[Order]:
    """Return each method's order: the slope of log theta error over log h, up to a period.

    Over longer times RK4 reads 5 and more.  Its phase error at the time t is a·h⁴·t, but it also
    loses energy at a rate of b·h⁵, so the frequency drifts and the phase with it by b·h⁵·t²/2,
    which wins in the long run: it reads 5, and more where h is so large that terms of h⁶ count.
    Next to the separatrix, where phase hangs steeply on energy, it reads 5 within the first period.
    Symplectic Euler reads 2 from theta = 0, where its angles are velocity Verlet's.
    """
    study = Study(scene, min(time, scene.exact().period or math.tau / scene.w0), loops)
    usable = [steps for steps in ORDER_STEPS if study.time / steps * scene.w0 >= Z_LIMITS[0]]
    runs = {
        method: [study.run(method, steps, ORDER_STEPS[0]) for steps in usable]
        for method in scene.cast
    }
    return [
        Order(method, _slope([point for point in points if not study.may_be_rounding(point)]))
        for method, points in runs.items()
    ]


def _slope(points: Sequence[Point]) -> float | None:
    """The slope of log theta error over log h, by least squares, of the four smallest h."""
    fitted = [p for p in points if p.flaws.theta is None and p.theta_error < FITTED_BELOW][-4:]
    if len(fitted) < 3:
        return None
    line = linear_regression(
        [math.log(p.h) for p in fitted], [math.log(p.theta_error) for p in fitted]
    )
    return line.slope
