"""Scenes: what determines a run, and those worth watching."""

from pendu_tui.engine.scenes.listed import DEFAULT_SCENE, GROUPS, SCENES
from pendu_tui.engine.scenes.scene import (
    LIMITS,
    MAX_METHODS,
    UNITS,
    Z_LIMITS,
    Line,
    Scene,
    SceneError,
    Shot,
    check_h,
)

__all__ = [
    "DEFAULT_SCENE",
    "GROUPS",
    "LIMITS",
    "MAX_METHODS",
    "SCENES",
    "UNITS",
    "Z_LIMITS",
    "Line",
    "Scene",
    "SceneError",
    "Shot",
    "check_h",
]
