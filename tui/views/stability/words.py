"""One swing of the stability map in words."""

import math
from typing import Any

import numpy as np

from engine.methods import Method
from engine.stability.outcomes import CHAOTIC, FATES, HELD, UNKNOWN, Cells, Floats, is_lost

_SAID = {"holds": "held", "holds, wobbling": "held, larger wobble"}


def said(cell: Any) -> str:
    """The fate of a swing, as people say it."""
    return _SAID.get(FATES[cell["fate"]], FATES[cell["fate"]])


def note(cell: Any) -> str:
    """The outcome of a swing in a few words."""
    if cell["fate"] == UNKNOWN:
        return "…"
    if cell["fate"] == CHAOTIC:
        return said(cell)
    found = f"step {cell['steps'] + 1}" if is_lost(cell) else f"{cell['error']:.0e}"
    return f"{said(cell)}, {found}"


def verdict(method: Method, theta: float, zs: Floats, cells: Cells, at: int, w0: float) -> str:
    """Return the outcome from theta [rad] at zs[at], and the nearest h with another outcome.

    `cells` go along zs.
    """
    cell = cells[at]
    place = f"{method.label} at h {zs[at] / w0:.3g} s, {math.degrees(theta):.3g}°:"
    if cell["fate"] == UNKNOWN:
        return f"{place} not computed yet"
    holds = not is_lost(cell)
    fate = said(cell)
    other = np.flatnonzero(np.isin(cells["fate"], HELD) != holds)
    here, there = ("held", "lost") if holds else ("lost", "held")
    cliff = f"; {here} at every h on this map"
    if len(other):
        cliff = f"; {there} at h {zs[other[np.abs(other - at).argmin()]] / w0:.3g} s"
    if holds:
        return f"{place} {fate}, energy error {cell['error']:.1e}{cliff}"
    if cell["fate"] == CHAOTIC:
        return f"{place} {fate}{cliff}"
    return f"{place} lost at step {cell['steps'] + 1}, {fate}{cliff}"
