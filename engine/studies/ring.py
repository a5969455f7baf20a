"""How each method changes the area of a ring of neighbouring starts in phase space."""

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.tangent import jacobian
from pendu_tui.engine.models.model import Phase
from pendu_tui.engine.run.loops import OVERFLOW
from pendu_tui.engine.run.stepping import Stepping, SteppingChange, change_before
from pendu_tui.engine.scenes import Scene

# theta [rad] and omega [rad/s] of the neighbours
Ring = tuple[NDArray[np.float64], NDArray[np.float64]]


@dataclass(slots=True)
class _Carried:
    """One method's phase, the ring around it, and the area so far."""

    method: Method
    phase: Phase
    ring: Ring
    log_area: float = 0.0
    lost: bool = False


class Neighbourhood:
    """A ring of neighbouring starts of a run, carried along by each method.

    The area ratio is the product of the steps' Jacobian determinants at the centre, because the
    area of the ring itself suffers from rounding and folding.  A method whose numbers stop being
    finite keeps its last ring.
    """

    def __init__(self, scene: Scene, radius: float, run: int = 1) -> None:
        """Put 64 starts around the scene's: `radius` [rad] in theta, `radius`·w0 in omega."""
        self.radius = radius
        self.step = 0
        self._run = (scene, run)
        self._model = scene.equations
        angle = np.linspace(0.0, 2 * math.pi, 64, endpoint=False)
        ring = (
            scene.theta + radius * np.cos(angle),
            scene.omega + radius * scene.w0 * np.sin(angle),
        )
        start = (scene.theta, scene.omega)
        self._carried = [_Carried(method, start, ring) for method in scene.cast]

    @property
    def rings(self) -> tuple[Ring, ...]:
        """Each method's ring, in the order of the cast."""
        return tuple(carried.ring for carried in self._carried)

    @property
    def area_ratios(self) -> tuple[float, ...]:
        """The area over that at the start, of an infinitesimal ring; inf if it overflows."""
        return tuple(math.exp(c.log_area) if c.log_area < 709 else math.inf for c in self._carried)

    def is_of(self, scene: Scene, run: int) -> bool:
        """Return whether this is the ring of a run."""
        return self._run == (scene, run)

    def following(self, step: int, changes: Sequence[SteppingChange], most: int) -> "Neighbourhood":
        """Return the ring carried towards a step of its run, by at most `most` steps.

        It is another ring on a way back.  `changes` are all of the run's, in order; those of its
        past stay, since a branch is another.
        """
        ring = self
        if step < self.step:
            scene, run = self._run
            ring = Neighbourhood(scene, self.radius, run)
        target = min(step, ring.step + most)
        while ring.step < target:
            stop = min([target, *(change.step for change in changes if change.step > ring.step)])
            ring.advance(stop - ring.step, change_before(changes, stop).stepping)
        return ring

    def advance(self, n: int, stepping: Stepping) -> None:
        """Carry everything forward by n steps of the lockstep."""
        with np.errstate(all="ignore"):
            for carried, part in zip(self._carried, stepping.parts, strict=True):
                if not carried.lost:
                    self._carry(carried, n * part, stepping.h / part)
        self.step += n

    def _carry(self, carried: _Carried, steps: int, h: float) -> None:
        method = carried.method
        phases = method.on(self._model)(carried.phase, h)
        rings = method.on(self._model, np.sin)(carried.ring, h)
        displaced = method.on(self._model, cmath.sin)
        try:
            for _ in range(steps):
                determinant = jacobian(displaced, carried.phase, h).determinant
                phase = next(phases)
                ring = next(rings)
                log_area = carried.log_area + math.log(abs(determinant))
                if not (math.isfinite(log_area) and np.isfinite(ring).all()):
                    raise OverflowError
                carried.phase = phase
                carried.ring = ring
                carried.log_area = log_area
        except OVERFLOW:  # also the logarithm of a determinant 0
            carried.lost = True
