"""How far the pendulums of a run can swing, which decides how large they are drawn."""

import math
from collections.abc import Sequence
from functools import lru_cache

from engine.models.model import Model
from engine.run.lockstep import Sample
from engine.run.stepping import Stepping
from engine.scenes import Scene

REACHES = (0.5, 1.2, math.pi / 2)
"""Reaches [rad]: few, so that the scale hardly ever changes."""
WIDER = 1.3  # the frame over the amplitude of the motion that it shows


def reach(scene: Scene, stepping: Stepping, sample: Sample, shown: Sequence[int]) -> float:
    """Return the smallest of REACHES that no shown motion can leave with its energy; else pi.

    A method that is unstable at its h gets all the room at once.  Largest errors only grow during a
    run, so the picture never jumps back and forth.
    """
    largest = 0.0
    for place in shown:
        reading = sample.readings[place]
        if reading.diverged_at is not None or _is_unstable(scene, stepping, place):
            return math.pi
        largest = max(largest, reading.max_energy_error)
    start = scene.equations, scene.theta, scene.omega
    return next((angle for angle in REACHES if _error_at_rest(*start, angle) > largest), math.pi)


def frame(scene: Scene, stepping: Stepping, sample: Sample, shown: Sequence[int]) -> float:
    """Return the half width [rad] that the methods which stay cannot leave with their energy.

    It is WIDER than the exact motion's amplitude by a power, so that it hardly ever changes; pi
    where that is large.  Methods stay that are stable at their step and have not gone over the top.
    """
    start = scene.equations, scene.theta, scene.omega
    half = WIDER * amplitude(*start)
    if half < 1e-9 or not scene.equations.turns:
        return math.pi
    largest = 0.0
    for place in shown:
        reading = sample.readings[place]
        stays = reading.diverged_at is None and abs(reading.theta) < math.pi
        if stays and not _is_unstable(scene, stepping, place):
            largest = max(largest, reading.max_energy_error)
    while half < 0.8 * math.pi:  # a wider frame is all of phase space
        if _error_at_rest(*start, half) > largest:
            return half
        half *= WIDER
    return math.pi


def _is_unstable(scene: Scene, stepping: Stepping, place: int) -> bool:
    limit = scene.cast[place].linear_limit
    return limit is not None and abs(stepping.own[place]) * scene.equations.fastest > limit


@lru_cache(maxsize=8)
def amplitude(model: Model, theta: float, omega: float) -> float:
    """Return the angle [rad] at which a motion comes to rest, pi if it turns, by bisection."""
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


@lru_cache(maxsize=64)
def _error_at_rest(model: Model, theta: float, omega: float, angle: float) -> float:
    """Return the energy error with which a pendulum from a start comes to rest at an angle."""
    return model.reference(theta, omega).error(model.energy()(model.rest_phase(angle)))
