"""One swing of the stability map in words."""

import math
from typing import Any

import numpy as np

from engine.methods import Method
from engine.stability.outcomes import HOLDS, UNKNOWN, Cells, Floats, reason

CHAOS_STEPS = 2000
"""4 ms.  Of 500 swings on the map that are chaotic or resonant, 10 000 steps judge 3 otherwise."""


def note(method: Method, theta: float, z: float, cell: Any) -> str:
    """The outcome of a swing in a few words."""
    if cell["fate"] == UNKNOWN:
        return "…"
    if cell["fate"] == HOLDS:
        return f"stable, {cell['error']:.0e}"
    return f"{_reason(method, theta, z, cell)}, step {cell['steps'] + 1}"


def verdict(method: Method, theta: float, zs: Floats, cells: Cells, at: int, w0: float) -> str:
    """The outcome of the swing from theta [rad] at zs[at], and the nearest h with another; `cells` go along zs."""
    cell = cells[at]
    place = f"{method.label} at h {zs[at] / w0:.3g} s, {math.degrees(theta):.3g} deg:"
    if cell["fate"] == UNKNOWN:
        return f"{place} not computed yet"
    holds = cell["fate"] == HOLDS
    other = np.flatnonzero((cells["fate"] == HOLDS) != holds)
    if not len(other):
        cliff = "; stable at every h on this map" if holds else "; lost at every h on this map"
    else:
        nearest = zs[other[np.abs(other - at).argmin()]] / w0
        cliff = f"; lost at h {nearest:.3g} s" if holds else f"; stable at h {nearest:.3g} s"
    if holds:
        return f"{place} stable, energy error {cell['error']:.1e}{cliff}"
    return f"{place} lost at step {cell['steps'] + 1}, {_reason(method, theta, zs[at], cell)}{cliff}"


def _reason(method: Method, theta: float, z: float, cell: Any) -> str:
    return reason(method, theta, z, int(cell["fate"]), CHAOS_STEPS)
