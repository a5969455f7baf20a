"""The front of speed against accuracy: the cheapest method at each accuracy.

Costs are interpolated between measured points.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Literal

from engine.accuracy.study import ErrorKind, Point
from engine.methods import Method
from engine.methods.runge_kutta import RK4

Cost = Literal["evaluations", "seconds"]


@dataclass(frozen=True, slots=True)
class Cheapest:
    """The cheapest method at one accuracy."""

    target: float  # of the error
    method: Method
    cost: float  # force evaluations or seconds
    # RK4's force evaluations over this method's; None: one of the two was not measured there
    saves: float | None


def cost_of(point: Point, cost: Cost) -> float:
    """Return the cost of a run; 0 where it is unknown.

    Unknown are the seconds of an untimed run and the force evaluations of a series.
    """
    if cost == "seconds":
        return point.seconds or 0.0
    return point.force_evaluations


def front(points: Iterable[Point], kind: ErrorKind, cost: Cost) -> list[Cheapest]:
    """Return the cheapest method at errors of 0.1, 0.01 and so on, the largest error first.

    Costs are interpolated between a method's points, log over log.  An error is left out where the
    coarsest run of a method is that accurate already, since a coarser one may be cheaper.
    """
    lines: dict[Method, list[Point]] = {}
    for point in points:
        lines.setdefault(point.method, []).append(point)
    found = []
    for decade in range(1, 16):
        target = 10.0**-decade
        if any(
            _usable(line[0], kind) and line[0].error(kind) <= target
            for line in map(_coarsest_first, lines.values())
        ):
            continue
        costs = {
            method: read
            for method, line in lines.items()
            if (read := cost_at(line, kind, cost, target))
        }
        if costs:
            best = min(costs, key=lambda method: costs[method])
            ours = cost_at(lines[best], kind, "evaluations", target)
            rk4 = cost_at(lines.get(RK4, ()), kind, "evaluations", target)
            found.append(Cheapest(target, best, costs[best], ours and rk4 and rk4 / ours))
    return found


def cost_at(line: Sequence[Point], kind: ErrorKind, cost: Cost, target: float) -> float | None:
    """Return the interpolated cost at which the error falls to `target`, or None."""
    line = _coarsest_first(line)
    at = next(
        (n for n, point in enumerate(line) if _usable(point, kind) and point.error(kind) <= target),
        None,
    )
    if at is None or not (dear := cost_of(line[at], cost)):
        return None
    if at == 0 or not (cheap := cost_of(line[at - 1], cost)) or not line[at].error(kind):
        return dear
    above = line[at - 1].error(kind)
    below = line[at].error(kind)
    if not (math.isfinite(above) and above > target):
        return dear
    share = math.log(above / target) / math.log(above / below)
    return float(cheap * (dear / cheap) ** share)


def ranges(found: Sequence[Cheapest]) -> list[tuple[Method, Sequence[Cheapest]]]:
    """The front by method: each with its targets in a row, the largest error first."""
    groups = groupby(found, key=lambda one: one.method)
    return [(method, tuple(some)) for method, some in groups]


def _coarsest_first(line: Sequence[Point]) -> list[Point]:
    return sorted(line, key=lambda point: point.steps)


def _usable(point: Point, kind: ErrorKind) -> bool:
    return point.flaw(kind) in (None, "rounding")
