"""How far the pendulums of a run may swing: what stays below the pivot is drawn larger."""

import math
from collections.abc import Sequence
from functools import lru_cache

from engine.models.model import Model
from engine.run.lockstep import Sample
from engine.run.stepping import Stepping
from engine.scenes import Scene
from tui.playback.source import Source

REACHES = (0.5, 1.2, math.pi / 2)
"""Reaches [rad]: few, so that the scale hardly ever changes."""


def reach(scene: Scene, stepping: Stepping, sample: Sample, shown: Sequence[int]) -> float:
    """Return the smallest of REACHES that no shown motion can leave with its energy; else pi.

    A method that is unstable at its h gets all the room at once.  Largest errors only grow during a
    run, so the picture never jumps back and forth.
    """
    fastest = scene.equations.fastest
    each = [(scene.cast[place], stepping.own[place], sample.readings[place]) for place in shown]
    if any(now.diverged_at is not None for _, _, now in each):
        return math.pi
    limits = [(abs(h) * fastest, method.linear_limit) for method, h, _ in each]
    if any(limit is not None and z > limit for z, limit in limits):
        return math.pi
    largest = max([0.0, *(now.max_energy_error for _, _, now in each)])
    margins = _margins(scene.equations, scene.theta, scene.omega)
    return next(
        (angle for angle, margin in zip(REACHES, margins, strict=True) if margin > largest), math.pi
    )


class Reach:
    """The reach of a sample, worked out once for all the panes that show it."""

    def __init__(self) -> None:
        self.is_held = False  # by the pointer, which needs the room above the pivot, too
        self._of: object = None
        self._angle = math.pi

    def of(self, source: Source, sample: Sample, shown: Sequence[int]) -> float:
        if self.is_held:
            return math.pi
        key = sample, source.scene, source.stepping, shown
        if key != self._of:
            self._of, self._angle = key, reach(source.scene, source.stepping, sample, shown)
        return self._angle


WIDER = 1.3  # the frame over the amplitude of the motion that it shows
_MOST = 0.8 * math.pi  # rad; a wider frame is all of phase space


def frame(scene: Scene, stepping: Stepping, sample: Sample, shown: Sequence[int]) -> float:
    """Return the half width [rad] that the methods which stay cannot leave with their energy.

    It is WIDER than the exact motion's amplitude by a power, so that it hardly ever changes; pi
    where that is large.  Methods stay that are stable at their step and have not gone over the top.
    """
    largest = 0.0
    for place in shown:
        reading = sample.readings[place]
        limit = scene.cast[place].linear_limit
        z = abs(stepping.own[place]) * scene.equations.fastest
        is_stable = limit is None or z <= limit
        if is_stable and reading.diverged_at is None and abs(reading.theta) < math.pi:
            largest = max(largest, reading.max_energy_error)
    angles = _frames(scene.equations, scene.theta, scene.omega)
    return next((angle for angle, margin in angles if margin > largest), math.pi)


@lru_cache(maxsize=8)
def _frames(model: Model, theta: float, omega: float) -> list[tuple[float, float]]:
    """Return frames [rad], and the energy errors with which a pendulum comes to rest at each."""
    size = amplitude(model, theta, omega)
    if size < 1e-9 or not model.turns:
        return []
    reference = model.reference(theta, omega)
    energy = model.energy()
    angles = []
    while (size := WIDER * size) < _MOST:
        angles.append((size, reference.error(energy(model.rest_phase(size)))))
    return angles


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


@lru_cache(maxsize=8)
def _margins(model: Model, theta: float, omega: float) -> list[float]:
    """The energy error with which a pendulum from a start comes to rest at each of REACHES."""
    energy = model.energy()
    reference = model.reference(theta, omega)
    return [reference.error(energy(model.rest_phase(angle))) for angle in REACHES]
