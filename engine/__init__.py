"""The laboratory without a screen.  Pure: no clock, no file, no thread, no randomness.

A scene (`scenes`) starts the model (`models`); the methods (`methods`, the one list) carry it side
by side (`run`).  Three studies look closer: `accuracy` at what speed costs, `stability` at where
methods fail, and `phase_space` at what a step does to neighbouring starts.  Standard library only,
and NumPy for ensembles.

The names below are the library, which `library` documents; they are loaded when they are used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from engine.library import METHODS, SCENES, judge, limits, recommend, simulate

__all__ = ["METHODS", "SCENES", "judge", "limits", "recommend", "simulate"]


def __getattr__(name: str) -> Any:
    if name in __all__:
        return getattr(import_module("engine.library"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
