"""Which method and which h: the cheapest that reaches a target, or the most accurate within a budget.

Cost is counted in force evaluations.  What is recommended was run, and compared at more times than
the search compares.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from engine.accuracy.study import REASONS, ErrorKind, Point, Study
from engine.methods import Method
from engine.scenes import Z_LIMITS

MOST_EVALUATIONS = 20_000_000  # of a run; some seconds in plain Python
TOLERANCE = 0.02  # to which the fewest steps are found
CONFIRMING_COMPARISONS = 10_000
CONFIRMING_RUNS = 20  # before a method is given up
SECONDS_SLACK = 3.0  # where seconds count: no method's force evaluation takes a third of another's
IN_VAIN = 2  # doublings of the steps that do not lower the error: then rounding stops it
REFINED = 1.1  # times the steps must reach the target, too: an error may happen to cross zero


@dataclass(frozen=True, slots=True)
class Attempt:
    """A method's run that reaches the target, or its last one and why it does not."""

    method: Method
    point: Point | None  # None: there was no usable h
    why_not: str | None = None

    @property
    def succeeded(self) -> bool:
        return self.why_not is None


def reach(
    study: Study,
    kind: ErrorKind,
    target: float,
    most: int = MOST_EVALUATIONS,
    slack: float = 1.0,
) -> Iterator[Attempt]:
    """For each method, from the highest order down, its cheapest run with an error up to `target`.

    A method is given up where it costs more than `most` evaluations or than `slack` times one before it.
    """
    for method in sorted(study.scene.cast, key=lambda method: -method.order):
        attempt = _cheapest(study, method, kind, target, most)
        if attempt.point and attempt.succeeded:
            most = min(most, int(slack * attempt.point.force_evaluations))
        yield attempt


def spend(study: Study, kind: ErrorKind, budget: int) -> Iterator[Attempt]:
    """For each method its run with the smallest error for at most `budget` evaluations."""
    for method in study.scene.cast:
        steps = _affordable(study, method, budget)
        if not steps:
            yield Attempt(method, None, _no_h(budget))
            continue
        point = study.run(method, steps, CONFIRMING_COMPARISONS)
        while point.flaw(kind) == "rounding" and (
            steps := steps // 2
        ):  # fewer steps round less often
            coarser = study.run(method, steps, CONFIRMING_COMPARISONS)
            if coarser.error(kind) > point.error(kind):
                break
            point = coarser
        flaw = point.flaw(kind)
        yield Attempt(method, point, REASONS[flaw] if flaw in ("lost", "diverged") else None)


def cheapest(attempts: Sequence[Attempt]) -> Point | None:
    """The recommendation after `reach`."""
    points = [attempt.point for attempt in attempts if attempt.point and attempt.succeeded]
    return min(points, key=lambda point: point.force_evaluations, default=None)


def most_accurate(attempts: Sequence[Attempt], kind: ErrorKind) -> Point | None:
    """The recommendation after `spend`; of equal errors the cheaper."""
    points = [attempt.point for attempt in attempts if attempt.point and attempt.succeeded]
    return min(points, key=lambda point: (point.error(kind), point.force_evaluations), default=None)


def _affordable(study: Study, method: Method, budget: int) -> int:
    """The most steps for this many evaluations; 0 where that leaves no usable h."""
    smallest, largest = REFINED * Z_LIMITS[0] / study.scene.w0, Z_LIMITS[1] / study.scene.w0
    steps = min(
        (budget - method.first_same_as_last) // method.force_evaluations, int(study.time / smallest)
    )
    return steps if steps * largest >= study.time else 0


def _cheapest(study: Study, method: Method, kind: ErrorKind, target: float, most: int) -> Attempt:
    """Multiply the steps until the target is reached, then halve the gap, then confirm."""
    most_steps = _affordable(study, method, most)
    fastest = max(study.scene.w0, abs(study.scene.omega))  # rad/s
    too_few, steps = 0, min(most_steps, math.ceil(study.time * fastest))
    if not steps:
        return Attempt(method, None, _no_h(most))
    best, in_vain = None, 0
    while (point := study.run(method, steps)).error(kind) > target:
        if best is None or point.error(kind) < best.error(kind):
            best, in_vain = point, 0
        else:
            in_vain += point.flaw(kind) == "rounding"
        if in_vain == IN_VAIN or (in_vain and steps == most_steps):
            return Attempt(method, best, f"rounding stops it at {best.error(kind):.1e}")
        if steps == most_steps:
            return Attempt(method, best, _still(best, kind))
        flaw = point.flaw(kind)
        factor = 2.0 if flaw == "rounding" else 4.0
        if flaw is None:
            factor = min(max((point.error(kind) / target) ** (1 / method.order), 1.1), factor)
        too_few, steps = steps, min(most_steps, math.ceil(steps * factor))
    while steps - too_few > max(1, TOLERANCE * steps):
        middle = max(too_few + 1, math.isqrt(too_few * steps))
        if study.run(method, middle).error(kind) <= target:
            steps = middle
        else:
            too_few = middle
    for _ in range(CONFIRMING_RUNS):
        point = study.run(method, steps, CONFIRMING_COMPARISONS)
        refined = study.run(method, math.ceil(steps * REFINED), CONFIRMING_COMPARISONS)
        if max(point.error(kind), refined.error(kind)) <= target:
            return Attempt(method, point)
        if steps == most_steps:
            break
        steps = min(most_steps, math.ceil(steps * (1 + TOLERANCE)))
    return Attempt(method, point, _still(point, kind))


def _no_h(most: int) -> str:
    return f"no usable h within {most} evaluation{'s' * (most != 1)}"


def _still(point: Point, kind: ErrorKind) -> str:
    return f"still {point.error(kind):.1e} after {point.force_evaluations} evaluations"
