"""The reference lines, as `accuracy --all --cost seconds` prints them, and the points of all lines as JSON and CSV."""

from collections.abc import Sequence
from typing import Any

from engine.accuracy.references import CLOSED_FORM, TAYLOR_20, AnyPoint, References
from engine.accuracy.study import REASONS, ErrorKind, Point
from tui.cli.report import print_table
from tui.views.accuracy.chart import MARKS
from tui.words.accuracy import length

TRUTH = "the exact motion, against which errors are taken"
NUMBERS = ("h", "steps", "force_evaluations", "seconds", "spread", "theta_error", "energy_error", "final_error")


def print_references(found: References, kind: ErrorKind) -> None:
    """Print the points of Taylor's series, or why there are none, and what the closed form takes."""
    if found.taylor:
        rows = []
        for point in found.taylor:
            flaw, seconds = point.flaw(kind), point.seconds or 0.0
            cell = f"{MARKS[flaw] if flaw else ''} {point.error(kind):.1e} in {length(seconds)}"
            rows.append((f"{point.tolerance:.2g}", str(point.steps), cell))
        print()
        print_table("rrr", ("tolerance [rad/s]", "steps", TAYLOR_20.label), rows)
    if found.absent:
        print(found.absent)
    print(f"{CLOSED_FORM.label}, the floor: {length(found.floor)}")


def rows_of(points: Sequence[Point], found: References | None, kind: ErrorKind) -> list[dict[str, Any]]:
    """The points of all lines, in the fields of JSON and CSV."""
    runs: list[AnyPoint] = [*points, *(found.taylor if found else ())]
    rows = [_point_fields(point, kind) for point in runs]
    if found:
        nothing = dict.fromkeys(NUMBERS) | {"seconds": found.floor, "valid": False, "reason": TRUTH, "tolerance": None}
        rows.append({"method": CLOSED_FORM.key, **nothing})
    return rows


def _point_fields(point: AnyPoint, kind: ErrorKind) -> dict[str, Any]:
    flaw = point.flaw(kind)
    return {
        "method": point.method.key,
        **{name: getattr(point, name, None) for name in NUMBERS},
        "valid": flaw is None,
        "reason": REASONS[flaw] if flaw else None,
        "tolerance": getattr(point, "tolerance", None),
    }
