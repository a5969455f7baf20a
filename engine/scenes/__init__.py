"""Scenes: what determines a run, and those worth watching."""

from pendu_tui.engine.scenes.listed import DEFAULT_SCENE, GROUPS, SCENES
from pendu_tui.engine.scenes.scene import (
    MAX_METHODS,
    Z_LIMITS,
    Line,
    Scene,
    Shot,
    check_h,
)

__all__ = [
    "DEFAULT_SCENE",
    "GROUPS",
    "MAX_METHODS",
    "SCENES",
    "Z_LIMITS",
    "Line",
    "Scene",
    "Shot",
    "check_h",
]
