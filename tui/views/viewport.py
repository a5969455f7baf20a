"""The scale of pictures: how far the pendulums swing, and what a rectangle of cells shows of it.

The middle of a Viewport is the centre of its middle cell, so that theta = 0 and omega = 0 can be
clicked.
"""

import math
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from pendu_tui.engine.models.model import Model, State
from pendu_tui.engine.run.lockstep import Sample
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import Scene

LEFT = 8  # columns of the axis and its labels, beside phase space
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
    angles, errors = _steps(scene.equations, scene.theta, scene.omega)
    staying = []
    for place in shown:
        limit = scene.cast[place].linear_limit
        if limit is None or abs(stepping.own[place]) * fastest <= limit:
            staying.append(place)

    def widest(places: Iterable[int]) -> float:
        largest = max((sample.readings[place].max_energy_error for place in places), default=0.0)
        step = bisect_right(errors, largest)
        return angles[step] if step < len(errors) else math.pi

    return Reach(widest(staying), widest(shown))


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
    return angles, reference.errors(0.0, *(energy(model.rest_phase(angle)) for angle in angles))


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


TO_WHOLE = 1.5 * 2**52
"""Added to a number or an array and taken off again, it rounds to a whole number."""

MIN_SPAN, MAX_SPAN = 1e-3, 200 * math.pi  # rad from the left to the right edge


class Viewport(NamedTuple):
    """A part of phase space on `columns` × `rows` cells; its functions also take arrays."""

    columns: int
    rows: int
    theta: float  # rad, at the centre of the middle cell
    omega: float  # rad/s, there
    theta_per_dot: float  # rad
    omega_per_dot: float  # rad/s
    wrap: bool  # it shows one turn, in which every angle has its place

    @classmethod
    def portrait(
        cls, columns: int, rows: int, scene: Scene, theta: float = math.pi, omega: float = 0.0
    ) -> "Viewport":
        """Return -theta to theta [rad], high enough for the orbit with this amplitude.

        At pi it shows more than the separatrix and the scene's orbit, by a power of 1.3, so that
        another start seldom changes it.
        """
        fastest = 2 * scene.w0 * math.sin(theta / 2)
        if theta == math.pi:
            size = max(fastest, math.hypot(scene.omega, fastest * math.sin(scene.theta / 2)))
            fastest *= 1.3 ** (1 + math.ceil(math.log(size / fastest, 1.3) - 1e-9))
        return cls(
            columns,
            rows,
            theta=0.0,
            omega=0.0,
            # half a dot more, or rounding loses points at pi
            theta_per_dot=theta / (columns - 0.5),
            omega_per_dot=max(fastest, 1.5 * omega) / max(2 * rows - 2, 2),
            wrap=scene.equations.turns,
        )

    @property
    def middle(self) -> tuple[int, int]:
        return 2 * (self.columns // 2) + 1, 4 * (self.rows // 2) + 2

    def x(self, theta: Any) -> Any:
        x = self.middle[0] + (theta - self.theta) / self.theta_per_dot
        if self.wrap:
            turn = math.tau / self.theta_per_dot
            turns = (x - self.columns) / (turn + 1e-9)  # less than half at both edges
            x = x - turn * (turns + TO_WHOLE - TO_WHOLE)
        return x

    def y(self, omega: Any) -> Any:
        return self.middle[1] - (omega - self.omega) / self.omega_per_dot

    def theta_at(self, x: Any) -> Any:
        return self.theta + (x - self.middle[0]) * self.theta_per_dot

    def omega_at(self, y: Any) -> Any:
        return self.omega - (y - self.middle[1]) * self.omega_per_dot

    def at(self, x: float, y: float) -> State:
        """Return a round state within half a dot of (x, y), an equilibrium if possible."""
        theta = self._turned(self.theta_at(x))
        omega = rounded(self.omega_at(y), self.omega_per_dot)
        equilibrium = math.pi * round(theta / math.pi)
        if abs(theta - equilibrium) <= self.theta_per_dot / 2:
            return State(equilibrium, omega)
        return State(rounded(theta, self.theta_per_dot), omega)

    def at_cell(self, column: int, row: int) -> State:
        return self.at(2 * column + 1, 4 * row + 2)

    def _turned(self, theta: float) -> float:
        if self.wrap:
            return math.remainder(theta, math.tau)
        return theta

    @property
    def across(self) -> tuple[float, float]:
        """The first and last angle [rad]; pi may be at the very edge."""
        return self.theta_at(0.0), self.theta_at(2.0 * self.columns + 1)

    @property
    def up(self) -> tuple[float, float]:
        """The lowest and highest angular velocity [rad/s]."""
        return self.omega_at(4.0 * self.rows), self.omega_at(0.0)

    @property
    def theta_span(self) -> float:
        return 2 * self.columns * self.theta_per_dot

    def zoomed(self, factor: float, x: float, y: float) -> "Viewport":
        """Return a viewport `factor` times as large; the state at (x, y) [dots] stays there."""
        factor = min(max(factor, MIN_SPAN / self.theta_span), MAX_SPAN / self.theta_span)
        left = (x - self.middle[0]) * (1 - factor)
        above = (y - self.middle[1]) * (1 - factor)
        return self._replace(
            theta=self.theta + left * self.theta_per_dot,
            omega=self.omega - above * self.omega_per_dot,
            theta_per_dot=self.theta_per_dot * factor,
            omega_per_dot=self.omega_per_dot * factor,
        )

    def stepped(self, start: State, right: float, up: float) -> State:
        """Return the state so many dots from another one, or from the middle if it is outside."""
        x = float(self.x(start.theta))
        y = float(self.y(start.omega))
        width = 2 * self.columns
        height = 4 * self.rows
        if not (0 <= x < width and 0 <= y < height):
            x, y = self.middle
        return self.at(min(max(x + right, 0), width - 1), min(max(y - up, 0), height - 1))


def rounded(value: float, unit: float) -> float:
    """Return a number within half a unit, without the decimals below the unit."""
    return round(value, -math.floor(math.log10(unit))) + 0.0  # -0.0 becomes 0.0
