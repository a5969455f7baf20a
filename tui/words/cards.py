"""Cards: the properties of a method, and of a scene, as text."""

import math
import textwrap
from collections.abc import Mapping

from engine.methods import Method
from engine.models import MODELS
from engine.run.judgement import DEFINITIONS, Verdict
from engine.scenes import SCENES, UNITS, Scene
from tui.words.motion import motion_text
from tui.words.numbers import counted, z_text

WIDTH = 72  # characters; of 80 columns, frame and scroll bar take the rest
_HEAD = 14


SIGNS: dict[Verdict, str] = {
    "bounded": "=",
    "grows": "+",
    "loses": "-",
    "caught": "=",
    "wanders": "~",
    "chaotic": "!",
    "too early": "",
}
GLOSSARY = {
    "h": "the step size [s]: methods know the pendulum only at times 0, h, 2h, ...",
    "z": "h w0, the step in units of the swing; w0 = sqrt(g/L). Methods become unstable beyond a z of their own",
    "theta, omega": "angle from the downward vertical [rad], -5 t +0.89: five turns back and 0.89; its speed [rad/s]",
    "dE/E0": "the energy error over the start's energy. The exact pendulum keeps its energy, so all of it is error",
    "largest": "the largest |dE/E0| of the run so far",
    "trend": "the mean change of dE/E0 per second; a bounded error can be larger than one that grows",
    "E/Es": "the energy over that of the separatrix: below 1 it swings (libration), above it turns (rotation)",
    **{f"{sign} {verdict}".strip(): DEFINITIONS[verdict] for verdict, sign in SIGNS.items()},
    "colours": "each method keeps its own, and its letter, wherever it is shown; its digit is its place and its key",
    "×": "in the chart: one error passes another, and stays above it",
    "dotted": "the exact motion",
    "dim": "a recording laid under the lab, maybe with another h: pendu-tui live --ghost FILE",
}
HEADS: dict[tuple[str, ...], str] = {
    ("h",): GLOSSARY["h"],
    ("theta", "omega"): GLOSSARY["theta, omega"],
    ("dE/E0",): GLOSSARY["dE/E0"],
    ("largest",): GLOSSARY["largest"],
    ("per s", "trend per s"): GLOSSARY["trend"],
    ("verdict",): "what the energy error does in the long run; ? explains each word",
    ("th.err", "theta error"): "the distance from the exact angle [rad]",
    ("f", "evals/step"): "force evaluations a step: what the method costs",
    **{(each.head, each.wide_head): each.about for model in MODELS.values() for each in model.extra_columns},
    **{(model.energy_error.symbol,): model.energy_error.about for model in MODELS.values()},
}
"""What the heads of the table's columns mean."""


def head_text(head: str) -> str | None:
    """What the head of a column means, in a line."""
    return next((text for heads, text in HEADS.items() if head.partition(" [")[0] in heads), None)


def glossary() -> str:
    """What the words, signs and colours on the screen mean."""
    return _card("What is on the screen", GLOSSARY)


def method_card(method: Method) -> str:
    """A method's properties; every line is a tested claim."""
    limit = f"up to z = h w0 = {method.linear_limit:.4g} (small swings)" if method.linear_limit else "at no h"
    if method.linear_limit is None:
        limit = ""  # there is no one number
    return _card(
        f"{method.letter}  {method.label}",
        {
            "also called": ", ".join(method.other_names),
            "formula": method.formula,
            "order": f"{method.order}: as a rule, over one swing half of h divides the error by {2**method.order}",
            "costs": f"{counted(method.force_evaluations, 'force evaluation')} per step",
            "symplectic": "yes: conserves phase-space area" if method.symplectic else "no: phase-space area changes",
            "reversible": "yes: run backwards, it returns to its start, but for rounding"
            if method.reversible
            else "no",
            "stable": limit,
            "note": method.note,
            "used in": method.used,
            "reference": method.reference,
        },
    )


OFTEN_SAID = {
    "damped": "RK4 is to be preferred where energy is lost. True from an accuracy of 0.1 % on; at 1 % conformal Verlet "
    "costs half.",
    "halving": "Adaptive steps are better. They make the energy of a symplectic method drift.",
    "resonance-golden": "h over the golden ratio avoids resonances because it is irrational. 5/8 of h does, too: it is "
    "far from the resonance that counts.",
    "stiff-slow": "IMEX Euler is stable at any h. True, but it stops the swing as well as the spring.",
    "stiff-resonance": "With impulses h follows the slow motion. But not where it comes near the spring's period.",
    "learned": "A learned Hamiltonian conserves energy. It conserves the learned one; the true one errs by a percent.",
}
"""What is often said, and what of it is true, by scene; measured in tests/engine/methods and test_scenes."""


def scene_card(scene: Scene, now: str = "") -> str:
    """A scene and what to watch in it; `now`: the current step, if it differs from the scene's."""
    exact = scene.exact()
    reference = f"no closed form: Kahan & Li's method of order 8, theta right to {exact.accuracy:g} rad for a minute"
    return _card(
        f"Scene {scene.name}",
        {
            "watch": scene.watch,
            "often said": OFTEN_SAID.get(scene.name),
            "start": f"theta {math.degrees(scene.theta):.5g}°, omega {scene.omega:.5g} rad/s",
            "pendulum": f"length {scene.length:.5g} m, gravity {scene.gravity:.5g} m/s², w0 = {scene.w0:.4g} 1/s",
            **{name: f"{value:.5g} {UNITS[name]}" for name, value in scene.parameters.items()},
            "step": f"h = {scene.h:.5g} s, {z_text(scene)}",
            "now": now,
            "motion": motion_text(scene, exact),
            "compared with": reference if exact.accuracy and scene == SCENES.get(scene.name) else None,
        },
    )


def _card(title: str, lines: Mapping[str, str | None]) -> str:
    after = " " * (_HEAD + 2)
    paragraphs = [
        textwrap.fill(text, WIDTH, initial_indent=f"  {head:<{_HEAD}}", subsequent_indent=after, break_on_hyphens=False)
        for head, text in lines.items()
        if text
    ]
    return "\n".join([title, *paragraphs])
