"""Who is ahead at each accuracy: the cheapest way to an error, read off between the points of a ladder."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from engine.accuracy.front import Reference, TaylorPoint
from engine.accuracy.study import ErrorKind, Point
from engine.methods import Method
from engine.methods.runge_kutta import RK4

Cost = Literal["evaluations", "seconds"]
DECADES = range(-1, -16, -1)  # powers of ten, the errors that are asked about


@dataclass(frozen=True, slots=True)
class Ahead:
    """The cheapest at one accuracy."""

    target: float  # of the error
    method: Method | Reference
    cost: float  # force evaluations or seconds
    saves: float | None  # RK4's force evaluations over its own; None: one of the two was not measured there


def cost_of(point: Point | TaylorPoint, cost: Cost) -> float:
    """What the run cost; zero where it was not measured: seconds untimed, or the force evaluations of a series."""
    if cost == "seconds":
        return point.seconds or 0.0
    return point.force_evaluations if isinstance(point, Point) else 0.0


def ahead(points: Iterable[Point | TaylorPoint], kind: ErrorKind, cost: Cost) -> list[Ahead]:
    """The cheapest for each power of ten that is reached, the loosest first.

    Costs are interpolated along each line, log over log.  A target is left out where the coarsest run of a method
    reaches it already: a coarser one may be cheaper.
    """
    lines: dict[Method | Reference, list[Point | TaylorPoint]] = {}
    for point in points:
        lines.setdefault(point.method, []).append(point)
    found = []
    for decade in DECADES:
        target = 10.0**decade
        if any(
            _usable(line[0], kind) and line[0].error(kind) <= target for line in map(_coarsest_first, lines.values())
        ):
            continue
        costs = {method: read for method, line in lines.items() if (read := cost_at(line, kind, cost, target))}
        if costs:
            best = min(costs, key=lambda method: costs[method])
            ours, rk4 = (
                cost_at(lines[method], kind, "evaluations", target) if method in lines else None
                for method in (best, RK4)
            )
            found.append(Ahead(target, best, costs[best], rk4 / ours if ours and rk4 else None))
    return found


def cost_at(line: Sequence[Point | TaylorPoint], kind: ErrorKind, cost: Cost, target: float) -> float | None:
    """The cost of an error, between the first point of a line that reaches it and the one before; None: none does."""
    line = _coarsest_first(line)
    at = next((n for n, point in enumerate(line) if _usable(point, kind) and point.error(kind) <= target), None)
    if at is None or not (dear := cost_of(line[at], cost)):
        return None
    if at == 0 or not (cheap := cost_of(line[at - 1], cost)) or not line[at].error(kind):
        return dear
    above, below = line[at - 1].error(kind), line[at].error(kind)
    if not (math.isfinite(above) and above > target):
        return dear
    share = math.log(above / target) / math.log(above / below)
    return float(cheap * (dear / cheap) ** share)


def ranges(found: Sequence[Ahead]) -> list[tuple[Method | Reference, Sequence[Ahead]]]:
    """The same by method: each with the targets in a row at which it is ahead, the loosest first."""
    starts = [0, *(n for n, (one, other) in enumerate(pairwise(found), 1) if one.method != other.method), len(found)]
    return [(found[start].method, found[start:end]) for start, end in pairwise(starts) if end > start]


def _coarsest_first(line: Sequence[Point | TaylorPoint]) -> list[Point | TaylorPoint]:
    return sorted(line, key=lambda point: point.steps)


def _usable(point: Point | TaylorPoint, kind: ErrorKind) -> bool:
    return point.flaw(kind) in (None, "rounding")
