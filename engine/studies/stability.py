"""Which swings of the pendulum a method holds, for how long, and how it loses them.

A swing starts at rest at an amplitude theta and depends on z = h·w0 only; here w0 = 1 and h = z.
engine.studies.LOST says when a swing is lost.
"""

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice, product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pendu_tui.engine.methods import USUAL_CAST, Cast, Method
from pendu_tui.engine.methods.tangent import at_bottom, tangent_map
from pendu_tui.engine.models import Pendulum
from pendu_tui.engine.run import verdicts
from pendu_tui.engine.run.levels import CHAOTIC_SEPARATION
from pendu_tui.engine.scenes import Scene
from pendu_tui.engine.studies import BAND

Floats = NDArray[np.float64]

UNIT = Pendulum(1.0)
PARKED = 1 / 8  # share of the swings: when so many are lost, the others go on without them

FATES = (
    *("holds", "over the top", verdicts.GROWS, verdicts.LOSES),
    *("holds, but wider", "holds off-centre", verdicts.CHAOTIC),
)
"""What becomes of a swing: it swings as wide as it should; |theta| passes pi; its energy leaves the
band upwards or downwards; it stays, but swings wider; it stays beyond a symplectic method's linear
limit, as around the two places between which velocity Verlet then jumps; neighbouring swings
separate exponentially.
"""

HOLDS, OVER_THE_TOP, GROWS, LOSES, WOBBLES, ELSEWHERE, CHAOTIC = range(len(FATES))
HELD = (HOLDS, WOBBLES, ELSEWHERE)
UNKNOWN = 255  # not computed

CELL = np.dtype([("steps", "<i4"), ("error", "<f8"), ("fate", "u1")])
"""Steps survived, largest relative energy error before the swing was lost, index into FATES."""

Cells = NDArray[Any]  # of CELL


def is_lost(cells: Cells) -> NDArray[np.bool_]:
    """Return which swings a method loses; UNKNOWN cells do not count."""
    return ~np.isin(cells["fate"], (*HELD, UNKNOWN))


class Watched(NamedTuple):
    """The limits and extremes of each of many swings; energies in s⁻², angles in rad."""

    start: Floats  # energies at the start
    band: Floats  # largest allowed energy difference from the start; inf: no limit
    top: Floats  # largest allowed |theta|; inf: no limit
    off: Floats  # energies, less the start's, after the last step
    worst: Floats  # largest |off| so far
    width: Floats  # largest |theta| so far


def watch(
    method: Method, phase: tuple[Floats, Floats], h: Floats, watched: Watched, n: int
) -> Iterator[tuple[int, tuple[Floats, Floats]]]:
    """Take n steps of many swings at once; all arrays are one-dimensional and of one length.

    Yields the steps done and the phase there after the last step, and whenever an energy is out of
    its band or a swing over its top.  Updates off, worst and width; the caller may change band and
    top.
    """
    energy = UNIT.energy(np.sin)
    start, band, top, off, worst, width = watched
    size = np.empty_like(off)
    bounded = np.isfinite(band).any()
    phases = islice(method.phases(UNIT.force(np.sin), phase, h), n)  # type: ignore[arg-type]
    for done, phase in enumerate(phases, 1):
        np.subtract(energy(phase), start, out=off)
        np.fmax(worst, np.abs(off, out=size), out=worst)
        outside = bounded and (size > band).any()
        np.fmax(width, np.abs(phase[0], out=size), out=width)
        if outside or done == n or (size > top).any():
            yield done, phase


def _bounds(method: Method, theta: Floats, z: Floats, start: Floats) -> tuple[Floats, ...]:
    """Return how far a held swing's energy may rise and fall, and theta's largest value [rad]."""
    distinct, where = np.unique(z, return_inverse=True)
    wobbles = np.array([wobble(method, value) for value in distinct.tolist()]).T
    lowest, highest, widest = wobbles[:, where]
    up = ((1 + BAND) * highest - 1) * start
    down = (1 - (1 - BAND) * lowest) * start
    if method.symplectic:
        up[:] = down[:] = math.inf  # its energy comes back
    return up, down, widest * theta


@np.errstate(all="ignore")  # lost swings may overflow
def outcomes(method: Method, theta: Floats, z: Floats, steps: int) -> Cells:
    """Return the outcome of each of many swings within `steps` steps.

    theta [rad], between 0 and pi, and z are one-dimensional and of one length, as are the CELLs
    returned.  No cell depends on the others.
    """
    h = z
    rest = np.zeros(len(theta))
    phase = (theta, rest)
    start: Floats = UNIT.energy(np.sin)(phase)
    up, down, reach = _bounds(method, theta, z, start)
    band = np.minimum(up, down)
    watched = Watched(start, band, rest + math.pi, rest.copy(), rest.copy(), theta.copy())
    index: NDArray[Any] = np.arange(len(theta))
    cells = np.zeros(len(theta), CELL)
    cells["steps"] = steps
    begun = 0
    while begun < steps and len(index):
        parked = np.zeros(len(index), np.bool_)
        for done, phase in watch(method, phase, h, watched, steps - begun):  # noqa: B020
            over = np.abs(phase[0]) > watched.top
            above = watched.off > up
            lost = over | above | (watched.off < -down)
            now = index[lost]
            cells["steps"][now] = begun + done - 1
            cells["error"][now] = watched.worst[lost] / watched.start[lost]
            cells["fate"][now] = np.where(over, OVER_THE_TOP, np.where(above, GROWS, LOSES))[lost]
            parked |= lost
            for limit in (watched.band, watched.top, up, down):
                limit[lost] = math.inf
            if np.count_nonzero(parked) > PARKED * len(parked):
                break
        begun = begun + done
        kept = ~parked
        index, h, up, down = (each[kept] for each in (index, h, up, down))
        phase = (phase[0][kept], phase[1][kept])
        watched = Watched(*(each[kept] for each in watched))
    cells["error"][index] = watched.worst / watched.start
    if method.symplectic:
        wobbling = index[(watched.width > 1.1 * reach[index]) | (z[index] > method.linear_limit)]
        if len(wobbling):
            steady = np.where(z[wobbling] > method.linear_limit, ELSEWHERE, WOBBLES)
            chaotic = is_chaotic(method, theta[wobbling], z[wobbling], min(steps, 2000))
            cells["fate"][wobbling] = np.where(chaotic, CHAOTIC, steady)
    return cells


def amplification(method: Method, z: float) -> float:
    """Return the largest |eigenvalue| of the Jacobian of a step at the bottom.

    Below a symplectic method's limit it is 1 to rounding, 1e-15; at the limit two eigenvalues meet,
    and the error is the square root of rounding, 1e-8.
    """
    a, b, c, d = at_bottom(method, z)
    mean = (a + d) / 2
    spread = cmath.sqrt((a - d) ** 2 / 4 + b * c)
    return max(abs(mean + spread), abs(mean - spread))


class Wobble(NamedTuple):
    """The range of a bounded linear swing from rest, relative to its start."""

    lowest: float  # energy
    highest: float
    widest: float  # |theta|


def wobble(method: Method, z: float) -> Wobble:
    """Return the energy's range and the largest amplitude of a linear swing from rest.

    A symplectic step with the Jacobian ((a, b), (c, d)) at w0 = 1 keeps a swing on the ellipse
    -c theta² + (a - d) theta omega + b omega² = -c theta0².  The squares of its half axes are the
    energy's extremes: (1 - z²/4, 1, 1) for velocity Verlet, (1/(1 + z/2), 1/(1 - z/2),
    1/sqrt(1 - z²/4)) for symplectic Euler, (1, 1, 1) for explicit Euler and RK4.  Beyond its limit
    a symplectic step has no ellipse: (0, 1, 1), as for velocity Verlet at its limit.
    """
    a, b, c, d = at_bottom(method, z)
    skew = (a - d) ** 2 / 4 + b * c
    if skew >= 0:
        return Wobble(0.0, 1.0, 1.0)
    mean = (b - c) / 2
    spread = math.hypot((b + c) / 2, (a - d) / 2)
    return Wobble(-c / (mean + spread), -c / (mean - spread), math.sqrt(b * c / skew))


GREENE_Z = math.sqrt(0.971635)  # Greene's K


def parting(method: Method, theta: Any, omega: Any, z: Any, steps: int) -> Any:
    """Return ln of the growth of neighbours' distance after so many steps, with w0 = 1.

    The displacement is rescaled to length 1 after each step: Benettin et al., Meccanica 15 (1980)
    9.  It grows in proportion to the steps on regular orbits, exponentially on chaotic ones.
    """
    phases = method.on(UNIT, np.sin)
    along = 1.0
    across = 0.0
    total = 0.0
    for _ in range(steps):
        (theta, omega), (along, across) = tangent_map(phases, (theta, omega), (along, across), z)
        growth = np.hypot(along, across)
        along = along / growth
        across = across / growth
        total = total + np.log(growth)
    return total


def is_chaotic(method: Method, theta: Any, z: Any, steps: int) -> Any:
    """Return whether swings from rest at theta [rad] are chaotic within `steps` steps.

    Over a million steps neighbours on regular orbits separate by at most e^14, on chaotic ones by
    e^28 within some thousand.  The exact swing from theta separates them by 1/cos²(theta/2), which
    does not count.
    """
    return parting(method, theta, 0.0 * theta, z, steps) > CHAOTIC_SEPARATION + math.log(
        steps
    ) - 2 * np.log(np.cos(theta / 2))


PART = 4096  # swings of a method: NumPy's calls cost little, and the arrays fit in the cache


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """The amplitudes, steps and methods of a map, or of a part of one."""

    theta: Floats  # rad, amplitudes between 0 and pi
    z: Floats  # h·w0, above 0
    steps: int
    methods: Cast = USUAL_CAST

    @property
    def shape(self) -> tuple[int, int, int]:
        """The shape of its cells: (z, methods, theta)."""
        return len(self.z), len(self.methods), len(self.theta)

    def cells(self) -> Cells:
        """Return the outcome of every swing."""
        z, theta = (axis.ravel() for axis in np.meshgrid(self.z, self.theta, indexing="ij"))
        by_method = [
            outcomes(method, theta, z, self.steps).reshape(len(self.z), -1)
            for method in self.methods
        ]
        return np.stack(by_method, axis=1)

    def unknown(self) -> Cells:
        """Return cells of unknown outcome."""
        return np.full(self.shape, np.array((0, 0.0, UNKNOWN), CELL))

    def parts(self, width: int | None = None) -> list["Part"]:
        """Return the grid cut into `width` z of one method; the cells are the same to the bit.

        They depend on `sin`, that is on processor and libm, so all workers must be alike.
        """
        width = width or max(1, PART // len(self.theta))
        zs = [slice(first, first + width) for first in range(0, len(self.z), width)]
        return [
            Part(z, index, replace(self, z=self.z[z], methods=(method,)))
            for z, (index, method) in product(zs, enumerate(self.methods))
        ]


@dataclass(frozen=True, slots=True)
class Part:
    """Some z of one method of a grid."""

    z: slice
    method: int  # index
    grid: Grid  # of these alone

    def cells(self) -> Cells:
        """Return the outcomes by (z, theta)."""
        return self.grid.cells()[:, 0]


@dataclass(frozen=True, slots=True)
class Piece:
    """A computed part of a map, and the share of the map that is done with its steps."""

    part: Part
    cells: Cells
    done: float


def pieces(grid: Grid, passes: Sequence[int]) -> Iterator[Piece]:
    """Yield the map in pieces of ten z and one method, with the steps of each pass."""
    for steps in passes:
        parts = replace(grid, steps=steps).parts(10)
        for done, part in enumerate(parts, 1):
            yield Piece(part, part.cells(), done / len(parts))


THETAS = (0.1, 0.5, 1.0, 2.0, 3.0)  # rad, and the scene's own

LADDER = np.geomspace(1e-3, 3.2, 812)
"""The z at which failures are searched, a rung every 1 %, to beyond every linear limit."""


@dataclass(frozen=True, slots=True)
class Row:
    """One method and one amplitude, with the smallest z tried at which the swing is lost."""

    method: Method
    theta: float  # rad
    here: Any  # the CELL at the scene's z
    z: float | None = None  # None: holds on the whole ladder
    steps: int | None = None  # survived
    reason: str | None = None  # over the top | grows | loses | chaotic


def amplitude(scene: Scene) -> float | None:
    """Return how far the scene's pendulum swings [rad]; None where it spins or rests."""
    if scene.omega == 0 and 0 < abs(scene.theta) < math.pi:
        return abs(scene.theta)
    share = scene.equations.energy()((scene.theta, scene.omega)) / (2 * scene.w0_squared)
    if not 0 < share < 1:
        return None
    return 2 * math.asin(math.sqrt(share))


def ladder_of(
    scene: Scene, thetas: Sequence[float] | None, zs: Sequence[float] | None, steps: int
) -> Grid:
    """Return a table's grid: amplitudes [rad] on a ladder of z that includes the scene's own."""
    rungs = np.union1d(LADDER if zs is None else zs, [scene.z])
    if thetas is None:
        thetas = list(THETAS)
        if own := amplitude(scene):
            others = [theta for theta in THETAS if not np.isclose(theta, own, rtol=0.01)]
            thetas = sorted([own, *others])
    return Grid(np.array(thetas), rungs, steps, scene.cast)


def map_of(
    scene: Scene, thetas: Sequence[float] | None, zs: Sequence[float] | None, steps: int
) -> Grid:
    """Return the grid of a map, by default of 100 amplitudes [rad] up to pi and 200 z up to 3.

    If a method of the cast is stable at 3, as BM4 is, z goes up to 3.5.
    """
    if not thetas:
        thetas = ((np.arange(100) + 0.5) * math.pi / 100).tolist()
    if not zs:
        stable_at_3 = any((method.linear_limit or 0) >= 3 for method in scene.cast)
        largest = 3.5 if stable_at_3 else 3.0
        zs = ((np.arange(200) + 0.5) * largest / 200).tolist()
    return Grid(np.array(thetas), np.array(zs), steps, scene.cast)


def table(scene: Scene, grid: Grid, cells: Cells) -> list[Row]:
    """Return the first failure of each method at each amplitude, from the cells of a ladder.

    Bisection would not do, because above the first failure there are windows of z where the swing
    is held again.
    """
    here = int(np.searchsorted(grid.z, scene.z))
    rows = []
    for (m, method), (t, theta) in product(enumerate(grid.methods), enumerate(grid.theta.tolist())):
        column = cells[:, m, t]
        row = Row(method, theta, column[here])
        lost = np.flatnonzero(is_lost(column))
        if len(lost):
            first = column[lost[0]]
            z = float(grid.z[lost[0]])
            row = replace(row, z=z, steps=int(first["steps"]), reason=FATES[first["fate"]])
        rows.append(row)
    return rows
