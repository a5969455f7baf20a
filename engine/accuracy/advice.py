"""The recommendation for one simulated time, by force evaluations or by seconds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

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
from engine.run.loops import LoopsOf, PlainLoops


@dataclass(frozen=True, slots=True)
class Advice:
    """The recommendation for one simulated time, and what was tried for it."""

    time: float  # s
    attempts: Sequence[Attempt]
    point: Point | None  # None: nothing reaches the target
    rk4: Point | None = (
        None  # RK4's cheapest run within the same error; None: not tried, or there is none
    )

    @property
    def saves(self) -> float | None:
        """RK4's force evaluations over those of the recommended method; None where one of them is unknown."""
        if self.rk4 is None or self.point is None:
            return None
        return self.rk4.force_evaluations / self.point.force_evaluations


def least_error(
    study: Study, kind: ErrorKind, budget: int, show: Callable[[float], None]
) -> Advice:
    """The most accurate run within a budget of force evaluations; `show` is given the share of methods tried."""
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
    loops: LoopsOf = PlainLoops,
) -> Advice:
    """The fastest run that reaches a target, timed by `clock` with these loops."""
    attempts: list[Attempt] = []
    for attempt in reach(study, kind, target, budget or MOST_EVALUATIONS, SECONDS_SLACK):
        if attempt.point and attempt.succeeded:
            attempt = replace(attempt, point=timed(attempt.point, study.scene, clock, loops))
        attempts.append(attempt)
        show(len(attempts) / len(study.scene.cast))
    points = [each.point for each in attempts if each.point and each.succeeded]
    best = min(points, key=lambda point: point.seconds or 0.0, default=None)
    return Advice(study.time, attempts, best)


def with_saving_over_rk4(advice: Advice, study: Study, kind: ErrorKind, target: float) -> Advice:
    """The advice with RK4's cheapest run for the target, however many force evaluations that takes."""
    alone = Study(study.scene.altered(cast=(RK4,)), study.time, study.loops)
    return replace(advice, rk4=cheapest(list(reach(alone, kind, target))))
