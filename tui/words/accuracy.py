"""Which method is the cheapest at each accuracy, in words."""

import math
from collections.abc import Sequence

from pendu_tui.engine.accuracy.front import Cheapest, Cost, ranges
from pendu_tui.engine.accuracy.study import REASONS, ErrorKind, Point
from pendu_tui.engine.methods.runge_kutta import RK4

COSTS: dict[Cost, str] = {"evaluations": "force evaluations", "seconds": "seconds"}


def length(seconds: float) -> str:
    """Write a computing time with its unit."""
    for unit, size in (("µs", 1e-6), ("ms", 1e-3)):
        if seconds < 999.5 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"


def few(number: float) -> str:
    """Write a number with three digits, or all digits of a whole number."""
    if number >= 100:
        return f"{number:.0f}"
    return f"{number:.3g}"


def point_words(point: Point, kind: ErrorKind, note: str) -> str:
    """Write a point's method, h, error and force evaluations, and a note."""
    error = f"{kind} error {point.error(kind):.1e}"
    if flaw := point.flaw(kind):
        error += f" ({REASONS[flaw]})"
    swing = f"z {point.z:.3g}, {few(point.steps_per_swing)} steps a small swing"
    text = f"{point.method.label} at h {point.h:.4g} s ({swing}): {error}"
    return "; ".join(
        filter(None, [f"{text} for {point.force_evaluations} force evaluations", note])
    )


def front_words(found: Sequence[Cheapest], cost: Cost) -> str:
    """Name the cheapest method in each range of errors."""
    if not found:
        return "No power of ten lies between the errors of the coarsest and finest runs."
    return f"Cheapest in {COSTS[cost]}: {_spans(found)}."


def factor_words(found: Sequence[Cheapest]) -> str:
    """Say how much the cheapest methods save over RK4; "" if it is little."""
    savings = [
        f"{one.method.label} {one.saves:.2g} at {_power(one.target)}"
        for one in found
        if one.saves and one.method is not RK4 and one.saves >= 1.2
    ]
    if not savings:
        return ""
    return f"Times fewer force evaluations than RK4: {', '.join(savings)}."


def _spans(found: Sequence[Cheapest]) -> str:
    spans = []
    for method, some in ranges(found):
        first, last = _power(some[0].target), _power(some[-1].target)
        if first == last:
            spans.append(f"{method.label} at {first}")
        else:
            spans.append(f"{method.label} from {first} to {last}")
    return ", ".join(spans)


def _power(target: float) -> str:
    return f"1e{round(math.log10(target))}"
