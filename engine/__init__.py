"""The laboratory without a screen.  Pure: no clock, no file, no thread, no randomness.

A scene (`scenes`) gives a model (`models`) its initial state, and `run` advances the methods
(`methods`) side by side.  `studies` look closer: at what accuracy costs, where methods fail, and
what a step does to neighbouring states.

The names below are those of `library`, loaded when they are used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pendu_tui.engine.library import (
        METHODS,
        SCENES,
        fluctuation_order,
        judge,
        limits,
        measure,
        recommend,
        simulate,
    )

__all__ = [
    "METHODS",
    "SCENES",
    "fluctuation_order",
    "judge",
    "limits",
    "measure",
    "recommend",
    "simulate",
]


def __getattr__(name: str) -> Any:
    if name in __all__:
        return getattr(import_module("pendu_tui.engine.library"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
