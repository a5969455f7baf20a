"""What `accuracy --all` says beside the methods' table: the reference lines, and who is ahead at each accuracy."""

import math
from collections.abc import Sequence
from typing import Any

from engine.accuracy.ahead import Ahead, Cost, ranges
from engine.accuracy.front import CLOSED_FORM, TAYLOR_20, TaylorPoint
from engine.accuracy.study import REASONS, ErrorKind, Point
from engine.methods.runge_kutta import RK4
from tui.cli.output import print_table
from tui.views.accuracy.chart import MARKS

TRUTH = "the exact motion, against which errors are taken"
NUMBERS = ("h", "steps", "force_evaluations", "seconds", "spread", "theta_error", "energy_error", "final_error")
WORTH_SAYING = 1.2  # times fewer force evaluations


def length(seconds: float) -> str:
    """A time of computing with its unit."""
    for unit, size in (("µs", 1e-6), ("ms", 1e-3)):
        if seconds < 999.5 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"


def print_references(taylor: Sequence[TaylorPoint], floor: float | None, absent: str | None, kind: ErrorKind) -> None:
    """Print the points of Taylor's series, or why there are none, and the floor."""
    if taylor:
        rows = []
        for point in taylor:
            flaw, seconds = point.flaw(kind), point.seconds or 0.0
            cell = f"{MARKS[flaw] if flaw else ''} {point.error(kind):.1e} in {length(seconds)}"
            rows.append((f"{point.tolerance:.2g}", str(point.steps), cell))
        print()
        print_table("rrr", ("tolerance [rad/s]", "steps", TAYLOR_20.label), rows)
    if absent:
        print(absent)
    if floor:
        print(f"{CLOSED_FORM.label}, the floor: {length(floor)}")


def front_words(found: Sequence[Ahead], cost: Cost, without: Sequence[Ahead]) -> str:
    """Who is ahead in which range of errors; `without`: the same for the methods alone, by force evaluations."""
    if not found:
        return "No power of ten lies between the errors of the coarsest and the finest runs, so nobody is ahead."
    words = f"Ahead in {'force evaluations' if cost == 'evaluations' else cost}: {_spans(found)}"
    if any(one.method is TAYLOR_20 for one in found) and without:
        words += f"; without Numba, in force evaluations: {_spans(without)}"
    return words + "."


def factor_words(found: Sequence[Ahead]) -> str:
    """How many force evaluations the methods ahead save over RK4; empty where none is worth saying."""
    savings = [
        f"{one.method.label} {one.saves:.2g} at {_power(one.target)}"
        for one in found
        if one.saves and one.method is not RK4 and one.saves >= WORTH_SAYING
    ]
    return f"Times fewer force evaluations than RK4: {', '.join(savings)}." if savings else ""


def _spans(found: Sequence[Ahead]) -> str:
    return ", ".join(f"{method.label} {_span(some[0].target, some[-1].target)}" for method, some in ranges(found))


def _span(first: float, last: float) -> str:
    return f"at {_power(first)}" if first == last else f"from {_power(first)} to {_power(last)}"


def _power(target: float) -> str:
    return f"1e{round(math.log10(target))}"


def rows_of(
    points: Sequence[Point], taylor: Sequence[TaylorPoint], floor: float | None, kind: ErrorKind
) -> list[dict[str, Any]]:
    """The points of all lines, in the fields of JSON and CSV."""
    runs: list[Point | TaylorPoint] = [*points, *taylor]
    rows = [_point_fields(point, kind) for point in runs]
    if floor is not None:
        nothing = dict.fromkeys(NUMBERS) | {"seconds": floor, "valid": False, "reason": TRUTH, "tolerance": None}
        rows.append({"method": CLOSED_FORM.key, **nothing})
    return rows


def _point_fields(point: Point | TaylorPoint, kind: ErrorKind) -> dict[str, Any]:
    flaw = point.flaw(kind)
    return {
        "method": point.method.key,
        **{name: getattr(point, name, None) for name in NUMBERS},
        "valid": flaw is None,
        "reason": REASONS[flaw] if flaw else None,
        "tolerance": getattr(point, "tolerance", None),
    }
