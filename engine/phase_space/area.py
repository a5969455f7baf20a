"""Area in phase space: a ring of neighbouring starts, and how much each method changes what it encloses."""

import math

import numpy as np
from numpy.typing import NDArray

from engine.methods import METHODS, Method
from engine.models.pendulum import acceleration
from engine.models.state import Phase
from engine.phase_space.tangent import jacobian
from engine.run.lockstep import parts
from engine.scenes import Scene

Ring = tuple[NDArray[np.float64], NDArray[np.float64]]  # theta [rad] and omega [rad/s] of the neighbours


class _Carried:
    """What one method carries along: its own point, the ring around it, the area so far."""

    def __init__(self, method: Method, scene: Scene, ring: Ring) -> None:
        self.method = method
        self.phase: Phase = (scene.theta, scene.omega)
        self.ring = ring
        self.log_area = 0.0
        self.lost = False


class Neighbourhood:
    """A ring of neighbouring starts, carried along by each method.

    The area ratio comes from the product of the steps' Jacobians at the centre (the logarithms of
    the determinants, summed), not from the ring's own shoelace area, which rounding and folding
    spoil.  A method whose numbers stop being finite keeps its last ring.
    """

    def __init__(self, scene: Scene, radius: float, points: int = 64) -> None:
        """Put `points` starts around the scene's, `radius` rad away in theta and radius·w0 in omega."""
        self._w0_squared = scene.w0_squared
        self._force = acceleration(scene.w0_squared)
        self._ring_force = acceleration(scene.w0_squared, np.sin)
        angle = np.linspace(0.0, 2 * math.pi, points, endpoint=False)
        ring = (scene.theta + radius * np.cos(angle), scene.omega + radius * scene.w0 * np.sin(angle))
        self._carried = [_Carried(method, scene, ring) for method in METHODS]

    @property
    def rings(self) -> tuple[Ring, ...]:
        """Each method's ring, in the order of METHODS."""
        return tuple(carried.ring for carried in self._carried)

    @property
    def area_ratios(self) -> tuple[float, ...]:
        """Area now over area at the start, in the limit of a small ring; inf beyond a double's range."""
        return tuple(math.exp(c.log_area) if c.log_area < 709 else math.inf for c in self._carried)

    def advance(self, n: int, h: float, equal_cost: bool = False) -> None:
        """Carry everything on by n steps of size h [s], at equal cost or not (see Lockstep)."""
        with np.errstate(over="ignore", invalid="ignore"):
            for carried, own in zip(self._carried, parts(), strict=True):
                cut = own if equal_cost else 1
                for _ in range(n * cut):
                    if carried.lost:
                        break
                    self._step(carried, h / cut)

    def _step(self, carried: _Carried, h: float) -> None:
        step = carried.method.step
        try:
            determinant = jacobian(step, self._w0_squared, *carried.phase, h).determinant
            phase = step(self._force, carried.phase, h)
            log_area = carried.log_area + math.log(abs(determinant))
        except (ValueError, OverflowError):  # sin of something infinite, or log of a determinant 0
            carried.lost = True
            return
        ring = step(self._ring_force, carried.ring, h)
        if not (all(map(math.isfinite, (*phase, log_area))) and np.isfinite(ring).all()):
            carried.lost = True
            return
        carried.phase, carried.ring, carried.log_area = phase, ring, log_area
