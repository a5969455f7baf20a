"""The reference lines on the chart of error against cost: Taylor's series, and the closed form.

Neither has a step size h or force evaluations to count, so both are shown only where cost is counted in seconds.
Taylor's series is set by a tolerance, and needs Numba.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.accuracy.closed_form import closed_form_seconds
from engine.accuracy.rounding import rounding_floor
from engine.accuracy.study import COMPARISONS, TIMED_STEPS, Clock, ErrorKind, Flaw, Flaws, Point, compilable, measured
from engine.accuracy.taylor import MOST_STEPS, Floats, follow
from engine.accuracy.timing import shortest
from engine.methods import METHODS
from engine.run.compiled import available
from engine.scenes import Scene

LOOSEST = 0.1  # tolerance, relative to the fastest of w0 and the start
TIGHTEST = 1e-16  # relative to the loosest: below the rounding of omega
RUNGS = 16
FINER = 10 ** (1 / 8)  # from one tolerance to the next that is tried for a target
CONFIRMING = 6
CONFIRMING_COMPARISONS = 10_000
ABSENT = "Taylor's series needs Numba, the extra `fast`."
UNFAIR = "Taylor's series is compiled by Numba, and these seconds are without it."
OTHER_MODEL = "Taylor's series is that of the pendulum, and of no other model."


@dataclass(frozen=True, slots=True)
class Reference:
    """A line on the chart that is not a method of the lockstep."""

    key: str  # in JSON and on the command line
    label: str  # for people
    letter: str  # its mark on charts
    reference: str


TAYLOR_20 = Reference("taylor_20", "Taylor, order 20", "t", "Jorba & Zou, Exp. Math. 14 (2005) 99")
CLOSED_FORM = Reference("closed_form", "Closed form", "c", "Bulirsch, Numer. Math. 7 (1965) 78")


@dataclass(frozen=True, slots=True)
class TaylorPoint:
    """One run of Taylor's series: its errors and its cost."""

    time: float  # s, simulated
    tolerance: float  # rad/s
    steps: int
    theta_error: float  # rad, the largest of those compared
    energy_error: float  # relative, the largest of those compared
    final_error: float  # rad, in theta at the end
    flaws: Flaws
    seconds: float | None = None  # the shortest of REPEATS runs to the end alone
    spread: float | None = None  # by how much the longest took longer, relative

    @property
    def method(self) -> Reference:
        return TAYLOR_20

    def error(self, kind: ErrorKind) -> float:
        return {"theta": self.theta_error, "energy": self.energy_error, "final": self.final_error}[kind]

    def flaw(self, kind: ErrorKind) -> Flaw | None:
        return {"theta": self.flaws.theta, "energy": self.flaws.energy, "final": self.flaws.final}[kind]


AnyPoint = Point | TaylorPoint


@dataclass(frozen=True, slots=True)
class Reached:
    """The loosest run that reaches a target, or the best one and why it does not."""

    point: TaylorPoint | None
    why_not: str | None = None


class TaylorStudy:
    """Runs of Taylor's series from one start over one time.  They need Numba: see `available`."""

    def __init__(self, scene: Scene, time: float) -> None:
        self.scene, self.time = scene, time
        self._exact = scene.exact()
        self._energy_floor, self._theta_floor = rounding_floor(scene, time)
        self._compared: dict[int, Floats] = {}  # theta at so many times
        self._width = min(math.pi, float(np.max(np.abs(self._truth(COMPARISONS)))))

    def run(self, tolerance: float, comparisons: int = COMPARISONS) -> TaylorPoint | None:
        """The run with this tolerance [rad/s], errors taken at so many times; None where it takes MOST_STEPS.

        An error counts as rounding if it lies below the rounding floor and does not double with 16 times the tolerance.
        """
        errors, steps = self._errors(tolerance, comparisons)
        if steps == MOST_STEPS:
            return None
        floors = [floor * math.sqrt(steps) for floor in (self._theta_floor, self._energy_floor, self._theta_floor)]
        sizes = self._width, 1.0, self._width
        flaws: list[Flaw | None] = [
            "lost" if error >= size else None for error, size in zip(errors, sizes, strict=True)
        ]
        if any(error <= floor for error, floor in zip(errors, floors, strict=True)):
            looser, _ = self._errors(16 * tolerance, comparisons)
            for kind, (error, floor) in enumerate(zip(errors, floors, strict=True)):
                if flaws[kind] is None and error <= floor and looser[kind] < 2 * error:
                    flaws[kind] = "rounding"
        return TaylorPoint(self.time, tolerance, steps, *errors, Flaws(*flaws))

    def points(self, count: int = RUNGS) -> Iterator[TaylorPoint]:
        """Points for tolerances in equal ratios, the loosest first, as long as runs end."""
        for rung in range(count):
            point = self.run(self._loosest * TIGHTEST ** (rung / max(1, count - 1)))
            if point is None:
                return
            yield point

    def reach(self, kind: ErrorKind, target: float) -> Reached:
        """The loosest tolerance with an error up to `target` that CONFIRMING finer ones reach as well.

        A single tolerance may reach it by chance, as errors of the steps cancel.
        """
        tolerance, best = self._loosest, math.inf
        while (point := self.run(tolerance, CONFIRMING_COMPARISONS)) and point.error(kind) > target:
            best, tolerance = min(best, point.error(kind)), tolerance / 10
            if tolerance < self._loosest * TIGHTEST:
                return Reached(None, f"rounding stops it at {best:.1e}")
        row: list[TaylorPoint] = []
        tolerance = min(self._loosest, 10 * tolerance)
        while len(row) <= CONFIRMING:
            if (point := self.run(tolerance, CONFIRMING_COMPARISONS)) is None:
                return Reached(None, f"more than {MOST_STEPS} steps")
            if tolerance < self._loosest * TIGHTEST:
                return Reached(None, f"rounding stops it at {min(best, point.error(kind)):.1e}")
            row = [*row, point] if point.error(kind) <= target else []
            tolerance /= FINER
        return Reached(row[0])

    def timed(self, point: TaylorPoint, clock: Clock) -> TaylorPoint:
        """The same point with its seconds: the same steps again, computing only the state at the end."""
        end = np.array([self.time])
        seconds, spread = shortest(
            lambda: self._follow(end, point.tolerance), max(1, TIMED_STEPS // point.steps), clock
        )
        return replace(point, seconds=seconds, spread=spread)

    @property
    def _loosest(self) -> float:
        return LOOSEST * max(self.scene.w0, abs(self.scene.omega))

    def _follow(self, times: Floats, tolerance: float) -> tuple[Floats, int]:
        return follow(self.scene.w0_squared, self.scene.theta, self.scene.omega, times, tolerance)

    def _truth(self, comparisons: int) -> Floats:
        if comparisons not in self._compared:
            times = np.linspace(0, self.time, comparisons + 1)
            self._compared[comparisons] = np.array([self._exact.at(float(t)).theta for t in times])
        return self._compared[comparisons]

    def _errors(self, tolerance: float, comparisons: int) -> tuple[tuple[float, float, float], int]:
        """The largest errors in theta [rad] and energy, the last in theta; and the steps."""
        states, steps = self._follow(np.linspace(0, self.time, comparisons + 1), tolerance)
        theta, omega = states.T
        model = self.scene.equations
        reference = model.reference(self.scene.theta, self.scene.omega)
        energies = (model.energy(np.sin)((theta, omega)) - reference.start) / reference.scale
        off = np.abs(theta - self._truth(comparisons))
        return (float(np.max(off)), float(np.max(np.abs(energies))), float(off[-1])), steps


@dataclass(frozen=True, slots=True)
class References:
    """The reference lines."""

    floor: float  # s, of the closed form
    taylor: Sequence[TaylorPoint] = ()
    absent: str | None = None  # the reason why there is no Taylor series


def references(scene: Scene, time: float, clock: Clock, fast: bool) -> References:
    """Time the closed form and Taylor's series over `time` [s]; `fast`: next to methods that Numba compiles, too."""
    floor = closed_form_seconds(scene, time, clock, fast)
    if scene.model != "pendulum":
        return References(floor, absent=OTHER_MODEL)
    if not fast:
        return References(floor, absent=UNFAIR if available() else ABSENT)
    series = TaylorStudy(scene, time)
    return References(floor, [series.timed(point, clock) for point in series.points()])


def with_all_methods(scene: Scene) -> Scene:
    """The scene with its cast and, after them, all other methods that take any force."""
    return scene.altered(cast=(*scene.cast, *(m for m in METHODS if m.general and m not in scene.cast)))


def measured_front(scene: Scene, time: float, rungs: Sequence[int], clock: Clock) -> Iterator[Point | References]:
    """Timed points of every method of the cast, then the reference lines; for another process."""
    yield from measured(scene, time, rungs, clock)
    yield references(scene, time, clock, compilable(scene.cast))
