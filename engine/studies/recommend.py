"""Recommend a method and h: the cheapest for a target.

Each recommended run was made, and compared with the exact motion more often than in the search.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.methods import Method
from pendu_tui.engine.run.loops import LoopsOf, PlainLoops
from pendu_tui.engine.scenes import Z_LIMITS
from pendu_tui.engine.studies.accuracy import Clock, ErrorKind, Flaw, Point, Study, timed

MAX_EVALUATIONS = 20_000_000  # of a run: some seconds in plain Python
MAX_TIMES = 300  # force evaluations over the cheapest method's, above which a search ends
TOLERANCE = 0.02  # of the fewest steps
GROWTH: dict[Flaw | None, float] = {"lost": 4.0, "rounding": 2.0}
"""The factor in steps where the order of a method predicts none."""
PREDICTABLE_BELOW = 0.1  # larger errors are not yet proportional to a power of h
CONFIRMING_COMPARISONS = 10_000
REFINED = 1.1  # times the steps must reach the target, too: an error may cross zero by chance


@dataclass(frozen=True, slots=True)
class Attempt:
    """A method's cheapest run that reaches the target, or why none does, with its last."""

    method: Method
    point: Point | None  # None: there was no usable h, or too many steps to try
    why_not: str | None = None
    times: float | None = None  # its cost over the cheapest method's

    @property
    def reached(self) -> Point | None:
        """The run that reaches the target; None if none does."""
        return None if self.why_not else self.point

    @property
    def cost(self) -> float:
        """Seconds if measured, else force evaluations; inf if the target is not reached."""
        if self.reached is None:
            return math.inf
        return self.reached.seconds or self.reached.force_evaluations


def least_cost(
    study: Study,
    kind: ErrorKind,
    target: float,
    show: Callable[[float], None] = lambda share: None,
    clock: Clock | None = None,
    loops: LoopsOf = PlainLoops,
) -> list[Attempt]:
    """Return each method's cheapest run for a target by force evaluations or a clock, best first.

    `show` is called with the share of methods tried.  Raises InputError for a target as large as
    the swing itself.
    """
    size = study.sizes[kind]
    if target >= size:
        raise InputError(
            f"a target of {target:g} is as large as the swing itself; use less than {size:g}."
        )
    attempts: list[Attempt] = []
    for attempt in reach(study, kind, target):
        if clock and attempt.reached:
            attempt = replace(attempt, point=timed(attempt.reached, study.scene, clock, loops))
        attempts.append(attempt)
        show(len(attempts) / len(study.scene.cast))
    attempts.sort(key=lambda attempt: attempt.cost)
    least = attempts[0].cost
    reached = [replace(each, times=each.cost / least) for each in attempts if each.reached]
    return reached + attempts[len(reached) :]


def reach(
    study: Study, kind: ErrorKind, target: float, most: int = MAX_EVALUATIONS
) -> Iterator[Attempt]:
    """Yield each method's cheapest run with an error up to `target`, the highest order first.

    The search for a method ends at `most` evaluations, or at MAX_TIMES those of a previous one.
    """
    for method in sorted(study.scene.cast, key=lambda method: -method.order):
        attempt = _cheapest(study, method, kind, target, most)
        if attempt.reached:
            most = min(most, MAX_TIMES * attempt.reached.steps * _work(method))
        yield attempt


def _affordable(study: Study, method: Method, budget: int) -> int:
    """Return the most steps for so many evaluations; 0 if that leaves no usable h."""
    smallest = REFINED * Z_LIMITS[0] / study.scene.w0
    largest = Z_LIMITS[1] / study.scene.w0
    steps = min((budget - method.first_same_as_last) // _work(method), int(study.time / smallest))
    if steps * largest < study.time:
        return 0
    return steps


def _work(method: Method) -> int:
    """Return the force evaluations of a step; a term of a series takes about as long as one."""
    return method.force_evaluations or method.order


def _cheapest(study: Study, method: Method, kind: ErrorKind, target: float, most: int) -> Attempt:
    """Multiply the steps until the target is reached, then bisect, then confirm."""
    too_dear = f"not within {most:,} evaluations"
    most_steps = _affordable(study, method, most)
    fastest = max(study.scene.w0, abs(study.scene.omega))  # rad/s
    too_few = math.ceil(study.time * fastest / math.pi) - 1  # a step of more than half a swing
    steps = min(most_steps, math.ceil(study.time * fastest))
    if not steps:
        return Attempt(method, None, too_dear)
    best = point = study.run(method, steps)
    in_vain = 0  # times that rounding kept the error from falling
    while (error := point.errors[kind]) > target:
        flaw = point.flaws[kind]
        if error < best.errors[kind]:
            best = point
            in_vain = 0
        elif flaw == "rounding" and point is not best:
            in_vain += 1
        if in_vain == 2 or (in_vain and steps == most_steps):
            return Attempt(method, best, f"rounding stops it at {best.errors[kind]:.1e}")
        factor = GROWTH.get(flaw) or (error / target) ** (1 / max(1, method.order))
        is_hopeless = not flaw and factor * steps > 2 * most_steps and error < PREDICTABLE_BELOW
        if steps == most_steps:
            return Attempt(method, point, too_dear)
        if is_hopeless:
            return Attempt(method, None, too_dear)
        too_few = steps
        steps = min(most_steps, math.ceil(steps * min(max(factor, 1.1), 4.0)))
        point = study.run(method, steps)
    while steps - too_few > max(1, TOLERANCE * steps):
        middle = max(too_few + 1, math.isqrt(too_few * steps))
        if study.run(method, middle).errors[kind] <= target:
            steps = middle
        else:
            too_few = middle
    return _confirmed(
        study, method, kind, target, steps=steps, most_steps=most_steps, too_dear=too_dear
    )


def _confirmed(
    study: Study,
    method: Method,
    kind: ErrorKind,
    target: float,
    *,
    steps: int,
    most_steps: int,
    too_dear: str,
) -> Attempt:
    """Confirm a run with more comparisons, and with slightly more steps; else take more steps."""
    for _ in range(20):
        point = study.run(method, steps, CONFIRMING_COMPARISONS)
        refined = study.run(method, math.ceil(steps * REFINED), CONFIRMING_COMPARISONS)
        if max(point.errors[kind], refined.errors[kind]) <= target:
            return Attempt(method, point)
        if steps == most_steps:
            break
        steps = min(most_steps, math.ceil(steps * (1 + TOLERANCE)))
    return Attempt(method, point, too_dear)
