"""Words and numbers below the portrait: a state, and what each method made of area, time and energy."""

import math
from functools import lru_cache

from engine.models.model import ExactMotion, State
from engine.phase_space.area import Neighbours
from engine.run.stepping import change_before
from engine.scenes import Scene
from tui.drawing.axes import in_pi
from tui.drawing.palette import QUIET, TEXT, inks, mark
from tui.drawing.picture import Picture, Row
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.words.motion import energy_share, motion_text, regime
from tui.words.numbers import scientific

_NAME, _CELL = 22, 14
_NOT_CURVES = {
    "spring": "a projection: angle and angular velocity of the swing",
    "damped": "curves of equal energy, which friction makes it cross inwards",
}
"""Captions for the models whose motion does not follow the curves."""


def fact_rows(source: Source, shown: Shown, neighbours: Neighbours | None, width: int) -> list[Row]:
    """A line about the ring, the heads, and a row for each method; the first columns that fit."""
    exact, fit = source.exact.at(source.sample.t), max((width - _NAME) // _CELL, 0)
    error = "dE/E0" if source.scene.equations.energy_error.conserved else "ln E/Etrue"
    heads = ("ln area ratio", "area/area0", "theta error", error)[:fit]
    rows: list[Row] = [
        [(_ring_text(source, neighbours)[:width], TEXT)],
        [(" " * _NAME + "".join(head.rjust(_CELL) for head in heads), QUIET)],
    ]
    ring = None if neighbours is None else neighbours.ring_of(source.scene, source.sample.run)
    for index in shown.places(source.scene.cast):
        method = source.scene.cast[index]
        reading = source.sample.readings[index]
        off = source.scene.equations.theta_error(reading.theta, exact.theta)
        area = ("-", "-") if ring is None or source.scene.why_no_ring else area_text(ring.area_ratios[index])
        cells = (*area, scientific(off, _CELL, 3), scientific(reading.energy_error, _CELL, 3))
        name = f" {mark(index, method)} {method.label}".ljust(_NAME)
        rows.append(
            [(name, inks(source.scene.cast)[index]), ("".join(cell.rjust(_CELL) for cell in cells[:fit]), TEXT)]
        )
    return rows


def _ring_text(source: Source, neighbours: Neighbours | None) -> str:
    if why := source.scene.why_no_ring:
        return f" {why}"
    if neighbours is None:
        return " Press g to draw a ring of neighbouring starts and measure its area."
    step = neighbours.step if neighbours.ring_of(source.scene, source.sample.run) else 0
    behind = source.sample.step - step
    change = change_before(source.changes, step)
    left = source.scene.equations.area_share(change.t + (step - change.step) * change.stepping.h)
    if left != 1:
        return f" Ring, radius {neighbours.radius:g} rad: the true motion leaves {left:.9f} of its area"
    text = f" Ring of neighbouring starts, radius {neighbours.radius:.4g} rad"
    return f"{text}: {behind} steps behind" if behind else f"{text} (g: another)"


def captioned(plot: Picture, scene: Scene, exact: ExactMotion, aim: State | None, width: int) -> Picture:
    """The portrait, and a line below it: a state, if one is aimed at, and the exact motion as far as there is room."""
    return Picture.stacked(plot, _caption(scene, exact, aim, width))


@lru_cache(maxsize=8)  # it changes with the run and with what is aimed at only
def _caption(scene: Scene, exact: ExactMotion, aim: State | None, width: int) -> Picture:
    motion = _NOT_CURVES.get(scene.model) or motion_text(scene, exact)
    if aim is None:
        return Picture.of_line(motion, QUIET)
    room = width - len(motion) - 2
    if room < 60:
        return Picture.of_line(_place(scene, *aim, width), TEXT)
    place = _place(scene, *aim, room)
    return Picture((((place.ljust(room + 2), TEXT), (motion, QUIET)),))


def _place(scene: Scene, theta: float, omega: float, width: int) -> str:
    if scene.model == "pendulum":
        return place_text(scene.w0, theta, omega, width)
    return f"theta {theta:.15g} rad  omega {omega:.15g} rad/s"[:width]


def place_text(w0: float, theta: float, omega: float, width: int) -> str:
    """A state, its energy in units of the separatrix' and its regime, as wordy as fits."""
    half_turns = round(theta / math.pi)
    angle = in_pi(half_turns) if theta == half_turns * math.pi else f"{theta:.15g}"
    motion = f"E/Es {energy_share(w0, theta, omega)}  {regime(w0, theta, omega)}"
    texts = (
        f"theta {angle} rad ({math.degrees(theta):.5g}°)  omega {omega:.15g} rad/s  {motion}",
        f"theta {angle} rad  omega {omega:.15g} rad/s  {motion}",
        f"theta {angle}  omega {omega:.15g}  {motion}",
        f"{angle}, {omega:.15g}  {motion}",
    )
    return next((text for text in texts if len(text) <= width), texts[-1][:width])


def area_text(ratio: float) -> tuple[str, str]:
    """The sum of log det J, and the area ratio with the digits that tell it from 1: "1 + 2.2e-16", "0.997838501"."""
    if not 0 < ratio < math.inf:
        return "-", "> 1e308" if ratio else "< 1e-308"
    logarithm = scientific(math.log(ratio), 10, 3)
    if ratio == 1:
        return logarithm, "1"
    if abs(ratio - 1) < 1e-6:
        return logarithm, f"1 {'+' if ratio > 1 else '-'} {abs(ratio - 1):.1e}"
    return logarithm, f"{ratio:.9f}" if 1e-3 <= ratio < 1e3 else f"{ratio:.3e}"
