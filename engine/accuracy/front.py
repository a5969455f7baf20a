"""The front of speed against accuracy: the cheapest method at each accuracy."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Literal

from pendu_tui.engine.accuracy.study import ErrorKind, Point
from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.runge_kutta import RK4

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
        costs = {
            method: known
            for method, line in lines.items()
            if (known := cost_at(line, kind, cost, target))
        }
        if costs:
            best = min(costs, key=lambda method: costs[method])
            own = cost_at(lines[best], kind, "evaluations", target)
            rk4 = cost_at(lines.get(RK4, ()), kind, "evaluations", target)
            cheapest.append(Cheapest(target, best, costs[best], own and rk4 and rk4 / own))
    return cheapest


def cost_at(line: Sequence[Point], kind: ErrorKind, cost: Cost, target: float) -> float | None:
    """Return the interpolated cost at which the error falls to `target`, or None."""
    coarser: Point | None = None
    for finer in sorted(line, key=lambda point: point.steps):
        if _reaches(finer, kind, target):
            return _interpolated(coarser, finer, kind, cost, target)
        coarser = finer
    return None


def _interpolated(
    coarser: Point | None, finer: Point, kind: ErrorKind, cost: Cost, target: float
) -> float | None:
    """Return the cost between two runs of which only the finer reaches the target."""
    high = cost_of(finer, cost)
    below = finer.error(kind)
    if not high:
        return None
    if coarser is None or not below:
        return high
    low = cost_of(coarser, cost)
    above = coarser.error(kind)
    if not low or not (math.isfinite(above) and above > target):
        return high
    share = math.log(above / target) / math.log(above / below)
    return float(low * (high / low) ** share)


def ranges(cheapest: Sequence[Cheapest]) -> list[tuple[Method, Sequence[Cheapest]]]:
    """Return the front by method, each with its consecutive targets, the largest error first."""
    groups = groupby(cheapest, key=lambda entry: entry.method)
    return [(method, tuple(entries)) for method, entries in groups]


def _reaches(point: Point, kind: ErrorKind, target: float) -> bool:
    return point.flaw(kind) in (None, "rounding") and point.error(kind) <= target
