"""How far the pendulums of a run can swing: it decides the scale of the drawing."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from pendu_tui.engine.models.model import Model
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import Scene


class Reach(NamedTuple):
    """How far [rad] the stable methods may swing (`frame`), and all methods (`widest`).

    The frame is the exact motion's amplitude times a power of 1.3, or pi, so it seldom changes.
    It only grows during a run, because the largest errors do.  With a method that is unstable at
    its h, all have the whole circle from the start.
    """

    frame: float
    widest: float


def reach(scene: Scene, stepping: Stepping, sample: Sample, shown: Sequence[int]) -> Reach:
    staying = _staying(scene, stepping, sample, shown)
    largest = max((sample.readings[place].max_energy_error for place in staying), default=0.0)
    frame = _frame(scene.equations, scene.theta, scene.omega, largest)
    widest = math.pi
    if len(staying) == len(shown):
        widest = frame
    return Reach(frame, widest)


@lru_cache(maxsize=8)
def _frame(model: Model, theta: float, omega: float, largest: float) -> float:
    half = 1.3 * amplitude(model, theta, omega)
    if half < 1e-9 or not model.turns:
        return math.pi
    energy = model.energy()
    reference = model.reference(theta, omega)
    while half < 0.8 * math.pi:  # a wider frame shows the whole turn
        if reference.error(energy(model.rest_phase(half))) > largest:
            return half
        half *= 1.3
    return math.pi


def _staying(scene: Scene, stepping: Stepping, sample: Sample, shown: Sequence[int]) -> list[int]:
    """Return the methods that are stable at their step and have not gone over the top."""
    staying = []
    own = stepping.own
    fastest = scene.equations.fastest
    for place in shown:
        reading = sample.readings[place]
        limit = scene.cast[place].linear_limit
        is_stable = limit is None or abs(own[place]) * fastest <= limit
        if is_stable and reading.diverged_at is None and abs(reading.theta) < math.pi:
            staying.append(place)
    return staying


@lru_cache(maxsize=8)
def amplitude(model: Model, theta: float, omega: float) -> float:
    """Return the amplitude [rad] of a motion by bisection; pi if it turns over."""
    energy = model.energy()
    start = energy(model.start(theta, omega))
    low = 0.0
    high = math.pi
    for _ in range(40):
        middle = (low + high) / 2
        if energy(model.rest_phase(middle)) < start:
            low = middle
        else:
            high = middle
    return high
