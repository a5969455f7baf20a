"""Cards: what is claimed of a method, and what a scene is, as text to read."""

import math
import textwrap

from engine.methods import METHODS
from engine.models.exact_pendulum import ExactMotion
from engine.scenes import Scene
from tui.drawing.palette import mark
from tui.words.motion import motion_text

WIDTH = 72  # characters; what 80 columns leave beside frame and scroll bar
_HEAD = 14


def method_card(index: int) -> str:
    """All that is claimed of a method; every line is a field of METHODS, and tested there."""
    method = METHODS[index]
    limit, area = f"z = h w0 up to {method.linear_limit:.4g}, where swings are small", "area in phase space"
    return _card(
        f"{mark(index)} {method.label}",
        {
            "also called": ", ".join(method.other_names),
            "formula": method.formula,
            "order": f"{method.order}: half the step makes the error {2**method.order} times smaller",
            "costs": f"{method.force_evaluations} force evaluation{'s' * (method.force_evaluations > 1)} a step",
            "symplectic": f"yes: it keeps {area}" if method.symplectic else f"no: {area} changes",
            "reversible": "yes: turned round, it returns to its start" if method.reversible else "no",
            "stable": limit if method.linear_limit else "none: at no h",
            "used in": method.used,
            "reference": method.reference,
        },
    )


def scene_card(scene: Scene, now: str = "") -> str:
    """What a scene is, and what to watch; `now`: the step in force, where that is another one."""
    return _card(
        f"Scene {scene.name}",
        {
            "watch": scene.watch,
            "start": f"theta {math.degrees(scene.theta):.5g}°, omega {scene.omega:.5g} rad/s",
            "pendulum": f"length {scene.length:.5g} m, gravity {scene.gravity:.5g} m/s², w0 = {scene.w0:.4g} 1/s",
            "step": f"h = {scene.h:.5g} s, z = h w0 = {scene.z:.4g}",
            "now": now,
            "motion": motion_text(ExactMotion(scene)),
        },
    )


def _card(title: str, lines: dict[str, str]) -> str:
    paragraphs = [
        textwrap.fill(text, WIDTH, initial_indent=f"  {head:<{_HEAD}}", subsequent_indent=" " * (_HEAD + 2))
        for head, text in lines.items()
        if text
    ]
    return "\n".join([title, *paragraphs])
