"""What is recommended for one time: of the methods alone, or of all there is, by force evaluations or by seconds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from engine.accuracy.front import Reached, TaylorPoint, TaylorStudy
from engine.accuracy.recommend import (
    MOST_EVALUATIONS,
    SECONDS_SLACK,
    Attempt,
    cheapest,
    most_accurate,
    reach,
    spend,
)
from engine.accuracy.study import Clock, ErrorKind, Point, Study, timed
from engine.methods.runge_kutta import RK4
from engine.run.loops import LoopsOf, plain


@dataclass(frozen=True, slots=True)
class Advice:
    """What was recommended for one time."""

    time: float  # s
    attempts: Sequence[Attempt]
    point: Point | TaylorPoint | None  # None: nothing reaches the target
    series: Reached | None = None  # how far Taylor's series got; None: it was not asked
    rk4: Point | None = None  # what RK4 needs for the same; None: it was not asked, or does not get there

    @property
    def saves(self) -> float | None:
        """RK4's force evaluations over those of the recommended method; None where one of them is unknown."""
        if self.rk4 is None or not isinstance(self.point, Point):
            return None
        return self.rk4.force_evaluations / self.point.force_evaluations


def least_error(study: Study, kind: ErrorKind, budget: int, show: Callable[[float], None]) -> Advice:
    """The most accurate within a budget of force evaluations; `show` hears which share of the methods is done."""
    attempts: list[Attempt] = []
    for attempt in spend(study, kind, budget):
        attempts.append(attempt)
        show(len(attempts) / len(study.scene.cast))
    return Advice(study.time, attempts, most_accurate(attempts, kind))


def least_evaluations(
    study: Study, kind: ErrorKind, target: float, budget: int | None, show: Callable[[float], None]
) -> Advice:
    """The method with the fewest force evaluations for a target."""
    attempts: list[Attempt] = []
    for attempt in reach(study, kind, target, budget or MOST_EVALUATIONS):
        attempts.append(attempt)
        show(len(attempts) / len(study.scene.cast))
    return Advice(study.time, attempts, cheapest(attempts))


def least_seconds(
    study: Study,
    kind: ErrorKind,
    target: float,
    budget: int | None,
    show: Callable[[float], None],
    clock: Clock,
    loops: LoopsOf = plain,
    series: bool = False,
) -> Advice:
    """What reaches a target in the shortest time by a clock, run by these loops; `series`: also by Taylor's."""
    attempts: list[Attempt] = []
    for attempt in reach(study, kind, target, budget or MOST_EVALUATIONS, SECONDS_SLACK):
        if attempt.point and attempt.succeeded:
            attempt = replace(attempt, point=timed(attempt.point, study.scene, clock, loops))
        attempts.append(attempt)
        show(len(attempts) / len(study.scene.cast))
    reached = None
    if series:
        taylor = TaylorStudy(study.scene, study.time)
        reached = taylor.reach(kind, target)
        if reached.point:
            reached = replace(reached, point=taylor.timed(reached.point, clock))
    points: list[Point | TaylorPoint] = [each.point for each in attempts if each.point and each.succeeded]
    if reached and reached.point:
        points.append(reached.point)
    best = min(points, key=lambda point: point.seconds or 0.0, default=None)
    return Advice(study.time, attempts, best, reached)


def beside_rk4(advice: Advice, study: Study, kind: ErrorKind, target: float) -> Advice:
    """The same with what RK4 needs for the target, be it ever so much more."""
    alone = Study(study.scene.altered(cast=(RK4,)), study.time, study.loops)
    return replace(advice, rk4=cheapest(list(reach(alone, kind, target))))
