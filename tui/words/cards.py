"""Cards: the properties of a method or a scene as text; and the glossary."""

import math
import textwrap
from collections.abc import Mapping

from pendu_tui.engine.methods import Method
from pendu_tui.engine.models import MODELS, NUMBERS
from pendu_tui.engine.quantities import QUANTITIES
from pendu_tui.engine.run.verdicts import VERDICTS
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.tui.words.numbers import counted, motion_text, z_text

WIDTH = 72  # characters; frame and scroll bar take the rest of 80 columns

GLOSSARY = {
    "h": "the step size [s]: methods give the motion only at times 0, h, 2h, ...",
    "z": "h·w0, the step in units of 1/w0, with w0 = sqrt(g/L) or the faster frequency of the "
    "model. Above its limit in z a method is unstable",
    **{each.head.wide.partition(" [")[0]: each.sentence for each in QUANTITIES if each.head.wide},
    "E/Es": "the energy over the separatrix energy: libration (swinging) below 1, rotation above",
    **{f"{each.sign} {each.word}".strip(): each.meaning for each in VERDICTS.values()},
    "colours": "each method keeps its colour and letter everywhere; its digit is its place "
    "and its key",
    "×": "in the chart: one error passes another for good",
    "dotted": "the exact motion",
    "dim": "the run before the restart (r), with its own step",
}
HEADS = {
    **GLOSSARY,
    **{each.head.narrow: each.sentence for each in QUANTITIES if each.head.wide},
    "verdict": "what the energy error does in the long run; ? explains each word",
}
"""The meaning of the table's heads."""
for model in MODELS.values():
    HEADS[model.error.head.narrow] = model.error.sentence
    for column in model.extra_columns:
        HEADS |= dict.fromkeys(column[:2], column.about)


def head_text(head: str) -> str | None:
    """Explain the head of a column in a line, None if it is unknown."""
    return HEADS.get(head.partition(" [")[0])


def glossary() -> str:
    """Explain the words, signs and colours on the screen."""
    return _card("What is on the screen", GLOSSARY)


def method_card(method: Method) -> str:
    """Return a method's properties; every line is a tested claim."""
    limit = method.linear_limit
    stable: str | None = "at no h"
    if limit is None:
        stable = None  # no single number
    elif limit == math.inf:
        stable = "at any h (small swings)"
    elif limit:
        stable = f"up to z = h w0 = {limit:.4g} (small swings)"
    order = "none: the error does not fall with h; the method solves the wrong equation"
    if method.order:
        order = f"{method.order}: as a rule, halving h divides a swing's error by {2**method.order}"
    costs = f"{counted(method.force_evaluations, 'force evaluation')} per step"
    if method.varies:
        costs = f"about {costs}"
    symplectic = "no: does not preserve phase-space area"
    if method.symplectic:
        symplectic = "yes: preserves phase-space area"
    reversible = "no"
    if method.reversible:
        reversible = "yes: with omega reversed, it retraces its path"
    lines = {
        "also called": ", ".join(method.other_names),
        "formula": method.formula,
        "order": order,
        "costs": costs,
        "symplectic": symplectic,
        "reversible": reversible,
        "stable": stable,
        "note": method.note,
        "used in": method.used,
        "reference": method.reference,
    }
    return _card(f"{method.letter}  {method.label}", lines)


def scene_card(scene: Scene) -> str:
    exact = scene.exact()
    reference = None
    if exact.accuracy and scene == SCENES.get(scene.name):
        accuracy = f"theta accurate to {exact.accuracy:g} rad for a minute"
        reference = f"Kahan & Li's method of order 8, {accuracy}; no closed form"
    lines = {
        "watch": scene.watch,
        "often said": scene.often_said,
        "start": f"theta {math.degrees(scene.theta):.5g}°, omega {scene.omega:.5g} rad/s",
        "pendulum": f"length {scene.length:.5g} m, gravity {scene.gravity:.5g} m/s², w0 = "
        f"{scene.w0:.4g} 1/s",
        **{name: f"{value:.5g} {NUMBERS[name].unit}" for name, value in scene.parameters.items()},
        "step": f"h = {scene.h:.5g} s, {z_text(scene)}",
        "motion": motion_text(scene, exact),
        "compared with": reference,
    }
    return _card(f"Scene {scene.name}", lines)


def _card(title: str, lines: Mapping[str, str | None]) -> str:
    wrapper = textwrap.TextWrapper(WIDTH, subsequent_indent=" " * 16)
    texts = [wrapper.fill(f"  {head:<13} {text}") for head, text in lines.items() if text]
    return "\n".join([title, *texts])
