"""How far from the bottom the pendulums of a run may swing: what stays below the pivot can be drawn larger."""

import math
from collections.abc import Sequence
from functools import lru_cache

from engine.models.model import Model
from engine.run.lockstep import Sample
from engine.run.stepping import Stepping
from engine.scenes import Scene
from tui.playback.source import Source

REACHES = (0.5, 1.2, math.pi / 2)
"""rad; beyond the last one the pivot has to be in the middle.  So few, that the picture hardly ever changes."""


def reach(scene: Scene, stepping: Stepping, sample: Sample, shown: Sequence[int]) -> float:
    """The smallest of REACHES that neither a shown method nor the exact motion can leave with its energy; else pi.

    A method that is unstable at its h gets all the room at once.  Largest errors only grow during a run, so the
    picture never jumps back and forth.
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
        self._of: object = None
        self._angle = math.pi

    def of(self, source: Source, sample: Sample, shown: Sequence[int]) -> float:
        key = sample, source.scene, source.stepping, shown
        if key != self._of:
            self._of, self._angle = key, reach(source.scene, source.stepping, sample, shown)
        return self._angle


@lru_cache(maxsize=8)
def _margins(model: Model, theta: float, omega: float) -> list[float]:
    """The energy error with which a pendulum from a start comes to rest at each of REACHES."""
    energy, reference = model.energy(), model.reference(theta, omega)
    return [reference.error(energy(model.rest_phase(angle))) for angle in REACHES]
