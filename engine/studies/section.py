"""The phase portrait of a method's own map: many starts iterated, and the kind of a single orbit.

A step of fixed h is a map of the phase plane.  An orbit is a smooth curve, a chain of islands, a
chaotic layer or, if the method is not symplectic, a spiral.
"""

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.methods import Method
from pendu_tui.engine.methods.tangent import Stretching
from pendu_tui.engine.models.model import Model, Phase
from pendu_tui.engine.run.levels import CHAOTIC_SEPARATION
from pendu_tui.engine.run.loops import OVERFLOW

Floats = NDArray[np.float64]
Points = tuple[Floats, Floats]  # theta [rad], unwrapped, and omega [rad/s], of one shape

LARGEST = 12  # denominator of a fraction that counts as small
BATCH = 25  # starts: a piece of a picture appears at once
_CHUNK = 8  # steps between two rescalings of a displacement


def spread(count: int, theta: tuple[float, float], omega: tuple[float, float]) -> Points:
    """Spread `count` starts evenly over a rectangle by Roberts' sequence R2 (2018)."""
    n = np.arange(1.0, count + 1)
    # 1/p and 1/p², where p³ = p + 1
    across = n * 0.7548776662466927 % 1
    up = n * 0.5698402909980532 % 1
    return theta[0] + (theta[1] - theta[0]) * across, omega[0] + (omega[1] - omega[0]) * up


@np.errstate(all="ignore")  # diverging methods overflow
def iterate(method: Method, model: Model, h: float, starts: Points, steps: int) -> Points:
    """Return n starts and their phases after each step of h [s]: two arrays (steps + 1, n)."""
    theta, omega = (np.empty((steps + 1, len(part))) for part in starts)
    theta[0], omega[0] = starts
    for step, phase in enumerate(islice(method.phases(model.force(np.sin), starts, h), steps), 1):
        theta[step], omega[step] = phase
    return theta, omega


def pieces(method: Method, model: Model, h: float, starts: Points, steps: int) -> Iterator[Points]:
    """Yield the orbits of batch after batch of starts; their bits do not depend on the batches."""
    theta, omega = starts
    for first in range(0, len(theta), BATCH):
        batch = slice(first, first + BATCH)
        yield iterate(method, model, h, (theta[batch], omega[batch]), steps)


def orbit(method: Method, model: Model, h: float, start: Phase, steps: int) -> Points:
    """Return the phases of one start: two arrays of at most steps + 1 finite numbers."""
    phases = [start]
    with suppress(*OVERFLOW):
        for phase in islice(method.phases(model.force(), start, h), steps):
            if not all(map(math.isfinite, phase)):
                break
            phases.append(phase)
    theta, omega = np.array(phases, np.float64).T
    return theta, omega


@dataclass(frozen=True, slots=True)
class OrbitKind:
    """The properties of an orbit of finite length."""

    steps: int
    moves: bool  # not an equilibrium
    spins: bool  # goes over the top, at least once
    rotation: float | None  # turns a step, around the bottom, or signed over the top; None: none
    fraction: Fraction | None  # the small one nearest to |rotation|
    island: bool  # every q steps, q being the fraction's denominator, it is in the same island
    lyapunov: float  # mean growth of ln |a small displacement| a step; 0 where it is regular
    chaotic: bool  # by a symplectic method, and neighbours separate faster than on regular orbits
    drift: float  # (E - E0)/E0 at the end, as in a run


def kind_of(method: Method, model: Model, h: float, points: Points) -> OrbitKind:
    """Return the kind of an orbit; `points` are those of `orbit`."""
    theta, omega = points
    path = np.transpose(points).tolist()
    steps = len(path) - 1
    moves = bool(np.ptp(theta) or np.ptp(omega))
    lap = np.zeros_like(theta)
    if model.turns:
        lap = np.floor(theta / math.tau + 0.5)
    spins = bool(np.ptp(lap))
    neighbours = Stretching(method, model, h)
    for phase in path[:-_CHUNK:_CHUNK]:
        neighbours.carry(phase, _CHUNK)
    # neighbours on regular orbits separate in proportion to the steps, and fast near upright
    from_upright = 1.0
    if model.turns:
        from_upright = min(max(abs(model.level(*path[0])), 1e-16), 1.0)
    separated = neighbours.log > CHAOTIC_SEPARATION + math.log(max(steps, 1) / from_upright)
    chaotic = method.symplectic and separated  # neighbours on spirals separate, too
    rotation = None
    fraction = None
    island = False
    if moves and not chaotic:
        rotation = rotation_number(theta - math.tau * lap[0], omega, model.w0, spins)
    if rotation is not None:
        fraction = nearest_fraction(abs(rotation))
        island = _is_island(points, rotation, fraction, spins)
    (drift,) = model.reference(*path[0]).errors(0.0, model.energy()(path[-1]))
    return OrbitKind(
        steps=steps,
        moves=moves,
        spins=spins,
        rotation=rotation,
        fraction=fraction,
        island=island,
        lyapunov=neighbours.log / max(neighbours.steps, 1),
        chaotic=chaotic,
        drift=drift,
    )


def rotation_number(theta: Floats, omega: Floats, w0: float, spins: bool = False) -> float | None:
    """Return turns per step, around the bottom or over the top; None if the halves disagree.

    A weighted Birkhoff average, which on smooth curves converges faster than any power of the
    steps: Das, Saiki, Sander & Yorke, Nonlinearity 30 (2017) 4111.
    """
    if spins:
        turns = np.diff(theta) / math.tau
    else:
        angle = np.arctan2(-omega / w0, theta)
        turns = np.diff(angle) / math.tau % 1  # a swing goes round clockwise
    half = len(turns) // 2
    if half < 2:
        return None
    rotation = _average(turns)
    change = _average(turns[:half]) - _average(turns[half:])
    if abs(change) > 1e-4 * abs(rotation):
        return None
    return rotation


def _average(values: Floats) -> float:
    t = np.arange(1, len(values) + 1) / (len(values) + 1)
    weights = np.exp(-1 / (t * (1 - t)))
    return float(weights @ values / weights.sum())


def nearest_fraction(rotation: float) -> Fraction:
    """Return the fraction nearest to a rotation number, with a denominator up to LARGEST.

    Below 1/LARGEST it is one over the nearest number of whole steps a turn.
    """
    if 0 < rotation < 1 / LARGEST:
        return Fraction(1, round(1 / rotation))
    return Fraction(rotation).limit_denominator(LARGEST)


def _is_island(points: Points, rotation: float, fraction: Fraction, spins: bool) -> bool:
    """Return whether the points of every q-th step wind around a point of their own."""
    q = fraction.denominator
    steps = len(points[0]) - 1
    tolerance = 0.1 / steps  # a tenth of a turn in all
    if q > LARGEST or abs(abs(rotation) - fraction) > tolerance:
        return False
    theta = points[0][::q]
    omega = points[1][::q]
    if spins:
        turn = math.copysign(math.tau * fraction.numerator, rotation)
        theta = theta - turn * np.arange(len(theta))
    x = theta - theta.mean()
    y = omega - omega.mean()
    angle = np.unwrap(np.arctan2(y, x))
    larger_than_rounding = np.hypot(x, y).max() > 1e-9
    return bool(larger_than_rounding and abs(angle[-1] - angle[0]) >= math.tau)
