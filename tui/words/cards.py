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
    limit = (
        f"z = h w0 up to {method.linear_limit:.4g}, where swings are small" if method.linear_limit else "none: at no h"
    )
    return _card(
        f"{mark(index)} {method.label}",
        {
            "also called": ", ".join(method.other_names),
            "formula": method.formula,
            "order": f"{method.order}: half the step makes the error {2**method.order} times smaller",
            "costs": f"{method.force_evaluations} force evaluation{'s' * (method.force_evaluations > 1)} a step",
            "symplectic": "yes: it keeps area in phase space"
            if method.symplectic
            else "no: area in phase space changes",
            "reversible": "yes: turned round, it returns to its start" if method.reversible else "no",
            "stable": limit,
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
    """A title and what there is to say, each line with its head."""
    told = [
        textwrap.fill(text, WIDTH, initial_indent=f"  {head:<{_HEAD}}", subsequent_indent=" " * (_HEAD + 2))
        for head, text in lines.items()
        if text
    ]
    return "\n".join([title, *told])
