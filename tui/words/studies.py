"""The studies in words: the cheapest method at each accuracy, and an orbit under a method's map."""

import math
from collections.abc import Sequence
from itertools import groupby

from pendu_tui.engine.methods import Method
from pendu_tui.engine.studies.accuracy import REASONS, Cheapest, Cost, ErrorKind, Point
from pendu_tui.engine.studies.section import OrbitKind
from pendu_tui.tui.words.numbers import counted

COSTS: dict[Cost, str] = {"evaluations": "force evaluations", "seconds": "seconds"}


def length(seconds: float) -> str:
    """Write a computing time with its unit."""
    for unit, size in (("µs", 1e-6), ("ms", 1e-3)):
        if seconds < 999.5 * size:
            return f"{few(seconds / size)} {unit}"
    return f"{few(seconds)} s"


def few(number: float) -> str:
    """Write a number with three digits, or all digits of a whole number."""
    if number >= 100:
        return f"{number:.0f}"
    return f"{number:.3g}"


def point_words(point: Point, kind: ErrorKind) -> str:
    """Write a point's method, h, error and force evaluations."""
    error = f"{kind} error {point.errors[kind]:.1e}"
    if flaw := point.flaws[kind]:
        error += f" ({REASONS[flaw]})"
    swing = f"z {point.z:.3g}, {few(point.steps_per_swing)} steps per small-amplitude period"
    cost = f"{point.force_evaluations} force evaluations"
    return f"{point.method.label} at h {point.h:.4g} s: {error} for {cost} ({swing})."


def front_words(found: Sequence[Cheapest], cost: Cost) -> str:
    """Name the cheapest method in each range of errors."""
    if not found:
        return "No power of ten lies between the errors of the coarsest and finest runs."
    spans = []
    for method, some in groupby(found, key=lambda one: one.method):
        first, *others = [f"1e{round(math.log10(one.target))}" for one in some]
        span = f"at {first}"
        if others:
            span = f"from {first} to {others[-1]}"
        spans.append(f"{method.label} {span}")
    return f"Cheapest in {COSTS[cost]}: {', '.join(spans)}."


MAX_DRIFT = 1e-3  # relative change of the energy; with more an orbit is a spiral


def orbit_words(method: Method, kind: OrbitKind) -> str:
    """Describe an orbit of a method's map; "1:6" is one turn in six steps."""
    if not kind.moves:
        return "An equilibrium: it stays where it is."
    if kind.chaotic:
        return f"Chaotic: neighbouring orbits separate by a factor of e^{kind.lyapunov:.3f} a step."
    shape = "Regular"
    if not method.symplectic:
        shape = "A slow spiral"
        if abs(kind.drift) > MAX_DRIFT:
            shape = f"It spirals {'outwards' if kind.drift > 0 else 'inwards'}"
    if not kind.rotation or kind.fraction is None:
        if shape.startswith("It"):
            return f"{shape}: no rotation number, since it changes along the way."
        return f"Undecided in {kind.steps} steps: regular so far, but no definite rotation number."
    over = " over the top" if kind.spins else ""
    turns, steps = kind.fraction.as_integer_ratio()
    if kind.island:
        count = f"{counted(turns, 'turn')}{over} in every {steps} steps"
        return f"A chain of islands: {count}, {turns}:{steps}."
    period = f"{1 / abs(kind.rotation):.5g} steps a turn{over}"
    return f"{shape}: {period}, nearest fraction {turns}/{steps}."
