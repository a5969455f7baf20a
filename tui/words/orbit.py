"""The orbit of a start under a method's map, in words and numbers."""

import math

from pendu_tui.engine.methods import Method
from pendu_tui.engine.phase_space.section import OrbitKind, least_lyapunov
from pendu_tui.engine.run.verdicts import CHAOTIC, UNDECIDED
from pendu_tui.tui.words.numbers import counted

HEADS = ("orbit", "turns a step", "steps a turn", "nearest", "Lyapunov number")
MAX_DRIFT = 1e-3  # relative change of the energy; with more an orbit is a spiral


def name(method: Method, kind: OrbitKind) -> str:
    """Name the kind of orbit."""
    if not kind.moves:
        return "at rest"
    if kind.chaotic:
        return CHAOTIC
    if kind.island:
        return f"islands {fraction(kind)}"
    if not method.symplectic and abs(kind.drift) > MAX_DRIFT:
        return "spirals outwards" if kind.drift > 0 else "spirals inwards"
    if kind.rotation is None:
        return UNDECIDED
    if not method.symplectic:
        return "slow spiral"
    if kind.spins:
        return "over the top"
    return "regular"


def fraction(kind: OrbitKind) -> str:
    """Return the simple fraction nearest to the rotation number; "1:6" is a turn in six steps."""
    if kind.fraction is None:
        return "-"
    return f"{kind.fraction.numerator}:{kind.fraction.denominator}"


def cells(method: Method, kind: OrbitKind) -> tuple[str, ...]:
    """Return the cells below HEADS; a regular orbit's Lyapunov number counts as 0."""
    turns = steps = "-"
    if kind.rotation is not None:
        turns = f"{kind.rotation:.7f}"
    if kind.rotation:
        steps = f"{1 / abs(kind.rotation):.5g}"
    lyapunov = f"0 within {least_lyapunov(kind.steps):.1g}"
    if not math.isfinite(kind.lyapunov):
        lyapunov = "-"
    elif kind.chaotic or kind.lyapunov < 0:
        lyapunov = f"{kind.lyapunov:+.4f}"
    return name(method, kind), turns, steps, fraction(kind), lyapunov


def sentence(method: Method, kind: OrbitKind) -> str:
    """Describe the orbit in a sentence."""
    words = name(method, kind)
    if words == "at rest":
        return "An equilibrium: it stays where it is."
    if kind.chaotic:
        return f"Chaotic: neighbouring starts separate by a factor of e^{kind.lyapunov:.3f} a step."
    spirals = words.startswith("spirals")
    if not kind.rotation or kind.fraction is None:
        if spirals:
            return f"It {words}: no rotation number, for it changes on the way."
        return f"Undecided in {kind.steps} steps: regular so far, but without one rotation number."
    over = " over the top" if kind.spins else ""
    ratio = fraction(kind)
    if kind.island:
        turns, steps = kind.fraction.as_integer_ratio()
        count = f"{counted(turns, 'turn')}{over} in every {steps} steps"
        return f"A chain of islands: {count}, {ratio}."
    near = f"{1 / abs(kind.rotation):.5g} steps a turn{over}, nearest {ratio}."
    if spirals:
        return f"It {words}, {near}"
    if method.symplectic:
        return f"Regular: {near}"
    return f"A slow spiral: {near}"
