"""The orbit of a start under a method's own map, in words and numbers."""

import math
from collections.abc import Sequence

from engine.methods import Cast, Method
from engine.phase_space.section import OrbitKind, numerical_period
from tui.drawing.palette import FRAME, TEXT, inks, mark
from tui.playback.source import Source
from tui.words.numbers import counted

HEADS = ("orbit", "turns a step", "steps a turn", "nearest", "Lyapunov number")
WIDTHS = (18, 14, 14, 9, 17)  # columns, two of them blank

_SPIRAL = 1e-3  # relative change of the energy
_Row = list[tuple[str, int]]


def name(method: Method, kind: OrbitKind) -> str:
    """The kind of orbit in a few words."""
    if not kind.moves:
        return "at rest"
    if kind.chaotic:
        return "chaotic"
    if kind.island:
        return f"islands {fraction(kind)}"
    if not method.symplectic and abs(kind.energy_error) > _SPIRAL:
        return "spirals outwards" if kind.energy_error > 0 else "spirals inwards"
    if kind.rotation is None:
        return "undecided"
    return ("over the top" if kind.spins else "regular") if method.symplectic else "slow spiral"


def fraction(kind: OrbitKind) -> str:
    """The small fraction nearest to the rotation number: "1:6" is one turn in six steps."""
    return "-" if kind.fraction is None else f"{kind.fraction.numerator}:{kind.fraction.denominator}"


def cells(method: Method, kind: OrbitKind) -> tuple[str, ...]:
    """What stands below HEADS."""
    rotation = kind.rotation
    return (
        name(method, kind),
        "-" if rotation is None else f"{rotation:.7f}",
        "-" if not rotation else f"{1 / abs(rotation):.5g}",
        fraction(kind),
        f"{kind.lyapunov:+.4f}" if math.isfinite(kind.lyapunov) else "-",
    )


def sentence(method: Method, kind: OrbitKind) -> str:
    """The orbit in a sentence."""
    what = name(method, kind)
    if what == "at rest":
        return "An equilibrium: it stays where it is."
    if kind.chaotic:
        return f"Chaotic: neighbouring starts part by a factor of e^{kind.lyapunov:.3f} a step."
    if kind.rotation and kind.fraction is not None:
        turns, steps = kind.fraction.numerator, kind.fraction.denominator
        over = " over the top" if kind.spins else ""
        if kind.island:
            return f"A chain of islands: {counted(turns, 'turn')}{over} in every {steps} steps, {turns}:{steps}."
        near = f"{1 / abs(kind.rotation):.5g} steps a turn{over}, nearest {turns}:{steps}."
        if what.startswith("spirals"):
            return f"It {what}, {near}"
        return f"{'Regular' if method.symplectic else 'A slow spiral'}: {near}"
    if what.startswith("spirals"):
        return f"It {what}: no rotation number, for it changes on the way."
    return f"Undecided in {kind.steps} steps: regular so far, but without one rotation number."


def period_sentence(source: Source) -> str:
    """How long a swing takes each method, next to the exact one; empty where nothing can be said."""
    scene, exact = source.scene, source.exact.period
    if not scene.general:
        return ""
    taken = [
        (method, numerical_period(method, scene.equations, abs(h), (scene.theta, scene.omega)))
        for method, h in zip(scene.cast, source.stepping.own, strict=True)
    ]
    if exact is None or not (said := [f"{method.label} {period:.6g} s" for method, period in taken if period]):
        return ""
    return f"From this start and with this step, a period takes {', '.join(said)}; the exact one is {exact:.6g} s."


def kind_rows(cast: Cast, known: Sequence[tuple[int, Method, OrbitKind]], width: int) -> list[_Row]:
    """Heads, and a row for each place in the cast, method and kind of its orbit; the first columns that fit."""
    label = 22
    fit = [sum(WIDTHS[: n + 1]) <= width - label for n in range(len(HEADS))]
    rows: list[_Row] = [[(" " * label + _joined(HEADS, fit), FRAME)]]
    for place, method, kind in known:
        title = f" {mark(place, method)} {method.label}".ljust(label)
        rows.append([(title, inks(cast)[place]), (_joined(cells(method, kind), fit), TEXT)])
    return rows


def _joined(words: Sequence[str], fit: Sequence[bool]) -> str:
    return "".join(word.rjust(width) for word, width, fits in zip(words, WIDTHS, fit, strict=True) if fits)
