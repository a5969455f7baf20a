"""The words below the charts of the accuracy view: one point, the cheapest methods, how errors grow."""

from collections.abc import Sequence

from engine.accuracy.front import Cost, front
from engine.accuracy.growth import Growth
from engine.accuracy.references import AnyPoint, References
from engine.accuracy.study import REASONS, ErrorKind, Point
from tui.words.accuracy import front_words, growth_words, length


def point_words(point: AnyPoint, kind: ErrorKind, note: str) -> str:
    """A method, its h, its error and its cost, and a note."""
    flaw, seconds = (
        point.flaw(kind),
        "" if point.seconds is None else f" in {length(point.seconds)}",
    )
    if isinstance(point, Point):
        at, cost = f"h {point.h:.4g} s", f"{point.force_evaluations} force evaluations"
    else:
        at, cost = f"a tolerance of {point.tolerance:.2g} rad/s", f"{point.steps} steps"
    reason = f" ({REASONS[flaw]})" if flaw else ""
    said = f"{point.method.label} at {at}: {kind} error {point.error(kind):.1e}{reason} for {cost}{seconds}"
    return f"{said}; {note}" if note else said


def front_lines(
    points: Sequence[Point], references: References | None, kind: ErrorKind, cost: Cost
) -> list[str]:
    """Which method is the cheapest in which range of errors, and why a reference line is absent."""
    found = front([*points, *(references.taylor if references else ())], kind, cost)
    said = [front_words(found, cost, front(points, kind, "evaluations"))]
    return [*said, references.absent] if references and references.absent else said


def growth_lines(found: Sequence[Growth], done: bool) -> list[str]:
    """The measured powers of t; and when all is `done`, which methods follow none."""
    words = growth_words(found)
    others = ", ".join(growth.method.label for growth in found if growth.power is None)
    lines = [f"From the start, {words}"] if words else []
    return [*lines, f"No single power of t: {others}"] if others and done else lines
