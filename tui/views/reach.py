"""How far the pendulums of a run swing: it decides the scale of the drawing."""

import math
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import NamedTuple

from pendu_tui.engine.models.model import Model
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import Scene

STEP = 1.1
"""From one reach to the next: the drawing changes its scale at most 25 times in a run."""


class Reach(NamedTuple):
    """How far [rad] the methods that are stable at their step swing, and all of them.

    Both follow from the largest energy errors so far, so they only grow during a run.
    """

    frame: float
    widest: float


def reach(scene: Scene, stepping: Stepping, sample: Sample, shown: Sequence[int]) -> Reach:
    fastest = scene.equations.fastest
    staying = []
    for place in shown:
        limit = scene.cast[place].linear_limit
        if limit is None or abs(stepping.own[place]) * fastest <= limit:
            staying.append(place)

    def widest(places: Iterable[int]) -> float:
        errors = [sample.readings[place].max_energy_error for place in places]
        return _angle(scene.equations, scene.theta, scene.omega, max(errors, default=0.0))

    return Reach(widest(staying), widest(shown))


def _angle(model: Model, theta: float, omega: float, largest: float) -> float:
    """Return the angle [rad] that no energy error up to the `largest` leaves; pi for all."""
    angles, errors = _steps(model, theta, omega)
    step = bisect_right(errors, largest)
    return angles[step] if step < len(errors) else math.pi


@lru_cache(maxsize=8)
def _steps(model: Model, theta: float, omega: float) -> tuple[list[float], list[float]]:
    """Return angles [rad] from the amplitude up, and the energy error that reaches each."""
    angles: list[float] = []
    angle = STEP * amplitude(model, theta, omega)
    while 1e-9 < angle < 0.9 * math.pi:  # a wider picture shows the whole turn
        angles.append(angle)
        angle *= STEP
    energy = model.energy()
    reference = model.reference(theta, omega)
    return angles, [reference.error(energy(model.rest_phase(angle))) for angle in angles]


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
