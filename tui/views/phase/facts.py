"""Words and numbers below the portrait: a state, and each method's area, time and energy."""

import math

from engine.models.model import Model, State
from engine.phase_space.area import Neighbours
from engine.run.stepping import change_before
from tui.drawing.axes import in_pi
from tui.drawing.palette import QUIET, TEXT, inks, mark
from tui.drawing.picture import Row
from tui.playback.shown import Shown
from tui.playback.source import Source
from tui.words.numbers import energy_share, motion_text, regime, scientific

NAME, CELL = 22, 14  # columns


def caption(source: Source, aim: State | None, width: int) -> Row:
    """Return the line below the portrait: the state aimed at, and the motion if it fits."""
    model = source.scene.equations
    motion = model.caption or motion_text(source.scene, source.exact)
    if aim is None:
        return ((motion, QUIET),)
    room = width - len(motion) - 2
    if room < 60:
        return ((place_text(model, aim, width), TEXT),)
    return (place_text(model, aim, room).ljust(room + 2), TEXT), (motion, QUIET)


def place_text(model: Model, state: State, width: int) -> str:
    """Return a state, with its energy relative to the separatrix and its regime if there is one."""
    theta, omega = state
    half_turns = round(theta / math.pi)
    angle = in_pi(half_turns) if theta == half_turns * math.pi else f"{theta:.15g}"
    text = f"theta {angle}  omega {omega:.15g}"
    if model.has_separatrix:
        text += f"  E/Es {energy_share(model, theta, omega)}  {regime(model, theta, omega)}"
    return text[:width]


def fact_rows(source: Source, shown: Shown, neighbours: Neighbours | None, width: int) -> list[Row]:
    """Return a line about the ring, the heads, and each method's row, in the columns that fit."""
    scene = source.scene
    model = scene.equations
    exact = source.exact.at(source.sample.t)
    ring = None
    if neighbours is not None and not scene.why_no_ring:
        ring = neighbours.ring_of(scene, source.sample.run)
    fit = max((width - NAME) // CELL, 0)

    def cells(*texts: str) -> str:
        return "".join(text.rjust(CELL) for text in texts[:fit])

    heads = cells("ln area ratio", "area/area0", "theta error", model.energy_error.symbol)
    rows: list[Row] = [
        [(_ring_text(source, neighbours)[:width], TEXT)],
        [(" " * NAME + heads, QUIET)],
    ]
    for place in shown.places(scene.cast):
        method = scene.cast[place]
        reading = source.sample.readings[place]
        area = area_text(ring.area_ratios[place]) if ring else ("-", "-")
        off = scientific(model.theta_error(reading.theta, exact.theta), CELL, 3)
        numbers = cells(*area, off, scientific(reading.energy_error, CELL, 3))
        name = f" {mark(place, method)} {method.label}".ljust(NAME)
        rows.append([(name, inks(scene.cast)[place]), (numbers, TEXT)])
    return rows


def _ring_text(source: Source, neighbours: Neighbours | None) -> str:
    if why := source.scene.why_no_ring:
        return f" {why}"
    if neighbours is None:
        return " Press g to draw a ring of neighbouring starts and measure its area."
    step = neighbours.step if neighbours.ring_of(source.scene, source.sample.run) else 0
    change = change_before(source.changes, step)
    left = source.scene.equations.area_share(change.t + (step - change.step) * change.stepping.h)
    radius = f"radius {neighbours.radius:g} rad"
    if left != 1:
        return f" Ring, {radius}: the true motion leaves {left:.9f} of its area"
    behind = source.sample.step - step
    return f" Ring of neighbouring starts, {radius}" + (
        f": {behind} steps behind" if behind else ""
    )


def area_text(ratio: float) -> tuple[str, str]:
    """Return ln of an area ratio, and the ratio as a text that differs from 1: "1 + 2.2e-16"."""
    if not 0 < ratio < math.inf:
        return "-", "> 1e308" if ratio else "< 1e-308"
    if ratio == 1:
        text = "1"
    elif abs(ratio - 1) < 1e-6:
        text = f"1 {'+' if ratio > 1 else '-'} {abs(ratio - 1):.1e}"
    else:
        text = f"{ratio:.9f}" if 1e-3 <= ratio < 1e3 else f"{ratio:.3e}"
    return scientific(math.log(ratio), 10, 3), text
