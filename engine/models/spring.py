"""A bob on a stiff spring in the plane: a swing, and a vibration some ten times as fast.

A position is a complex number q = x + iy in units of the spring's natural length, y upwards and the
pivot at 0, so methods run on it unchanged: q'' = -k (1 - 1/|q|) q - i w0².
"""

import cmath
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from operator import itemgetter
from typing import Any, NamedTuple

from pendu_tui.engine.models.model import (
    Energy,
    ExtraColumn,
    Force,
    Model,
    Number,
    Observation,
    Phase,
    Sine,
    Step,
    compose_verlet,
)
from pendu_tui.engine.quantities import Chart, Quantity


class SpringParts(NamedTuple):
    """The parts of the model for methods for two time scales."""

    fast: Callable[[Any], Any]  # position -> the spring's force
    slow: Callable[[Any], Any]  # gravity's
    solve: Callable[[Any, float], Any]  # (b, c) -> the solution of q = b + c fast(q)


def _length(extra: Mapping[str, float]) -> float:
    return abs(complex(extra["x"], extra["y"]))


@dataclass(frozen=True)
class Spring(Model):
    """q'' = -k (1 - 1/|q|) q - i w0²."""

    w0_squared: float  # g/L [s⁻²], L being the spring's natural length
    stiffness: float  # k, the spring constant over the mass [s⁻²]

    key = "spring"
    equation = "q'' = -k (1 - 1/|q|) q - i w0², q = x + iy"
    turns = False  # the angle follows from the position, so it is within ±pi
    parameters = (Number("stiffness", "s⁻²", "spring constant over mass in s⁻²", 1.0, 1e18),)
    variables = (
        Quantity("x", about="over the spring's natural length"),
        Quantity("y", about="upwards from the pivot, likewise"),
        Quantity("vx", "s⁻¹"),
        Quantity("vy", "s⁻¹"),
        Quantity(
            "spring_energy",
            about="over its initial value",
            chart=Chart("spring energy (1 at t = 0)"),
            relative=True,
        ),
    )
    extra_columns = (
        ExtraColumn("length", "length", "the spring's length over its natural length", _length),
        ExtraColumn(
            "spring",
            "spring E",
            "the energy of the spring's vibration over its initial value",
            itemgetter("spring_energy"),
        ),
    )
    offers = ("parts", "force")
    counted_parts = ("fast", "solve")
    rigid = False
    frequency_symbol = "omega_s"
    caption = "a projection: angle and angular velocity"
    without_force = (
        "Maps and studies apply to a single angle; the bob on a spring has two coordinates."
    )
    without_ring = (
        "Angle and angular velocity, a projection from four dimensions: no curves of equal "
        "energy and no ring."
    )

    @property
    def fastest(self) -> float:
        """The spring's frequency sqrt(k)."""
        return max(self.w0, math.sqrt(self.stiffness))

    def start(self, theta: float, omega: float) -> Phase:
        """Return a start stretched by 4 % beyond equilibrium, with no speed along the rod."""
        length = 1 + 0.04 + (self.w0_squared * math.cos(theta) + omega * omega) / self.stiffness
        down = -1j * cmath.exp(1j * theta)
        return length * down, 1j * length * omega * down

    def rest_phase(self, theta: float) -> Phase:
        """Return the phase at rest, as long as without a weight."""
        return -1j * cmath.exp(1j * theta), 0j

    def observe(self, phase: Phase) -> Observation:
        """Return angle, angular velocity, position, velocity, and the spring's energy."""
        q, w = phase
        turned = 1j * q  # its phase is theta; cmath.phase raises where that underflows
        theta = math.atan2(turned.imag, turned.real)
        omega = (q.conjugate() * w).imag / abs(q) ** 2
        extra = {
            "x": q.real,
            "y": q.imag,
            "vx": w.real,
            "vy": w.imag,
            "spring_energy": self.spring_energy(phase),
        }
        return Observation(theta, omega, extra)

    def theta_error(self, theta: float, exact: float) -> float:
        """Return theta - exact theta [rad] within ±pi, because whole turns are not known."""
        return math.remainder(theta - exact, math.tau)

    def length(self, extra: Mapping[str, float]) -> float:
        return _length(extra)

    def exact_length(self, theta: float, omega: float, t: float) -> float:
        q, _ = self.exact_phase(theta, omega, t)
        return float(abs(q))

    def force(self, sin: Sine = math.sin) -> Force:
        fast, slow, _ = self.parts(sin)

        def spring_force(q: Any) -> Any:
            return fast(q) + slow(q)

        return spring_force

    def parts(self, sin: Sine = math.sin) -> SpringParts:
        """Return the spring's force, gravity's, and q = b (|b| + c k)/((1 + c k) |b|)."""
        k = self.stiffness
        gravity = -1j * self.w0_squared

        def fast(q: Any) -> Any:
            return -k * (1 - 1 / abs(q)) * q

        def slow(q: Any) -> Any:
            return gravity

        def solve(b: Any, c: float) -> Any:
            length = abs(b)
            return b * ((length + c * k) / ((1 + c * k) * length))

        return SpringParts(fast, slow, solve)

    def energy(self, sin: Sine = math.sin) -> Energy:
        """|w|²/2 + w0² (y + 1) + k/2 (|q| - 1)² [s⁻²]."""
        k = self.stiffness
        gravity = self.w0_squared

        def total_energy(phase: Phase) -> Any:
            q, w = phase
            stretch = abs(q) - 1
            return (
                (w.real * w.real + w.imag * w.imag) / 2
                + gravity * (q.imag + 1)
                + k / 2 * stretch * stretch
            )

        return total_energy

    def spring_energy(self, phase: Phase) -> float:
        """Return vr²/2 + k/2 (r - r_eq)² [s⁻²], r_eq being the length in balance of forces."""
        q, w = phase
        length = abs(q)
        along = q / length
        radial = (w * along.conjugate()).real
        across = (w * along.conjugate()).imag
        held = 1 + (-self.w0_squared * along.imag + across * across / length) / self.stiffness
        stretch = length - held
        energy: float = radial * radial / 2 + self.stiffness / 2 * stretch * stretch
        return energy

    def exact_step(self) -> tuple[Step, float]:
        return compose_verlet(self.force()), 0.1 / self.fastest

    def exact_phase(self, theta: float, omega: float, t: float) -> Phase:
        """Return the phase at a time [s]; nan if the spring is too fast to follow."""
        if self.fastest > 320 * self.w0:
            return complex(math.nan, math.nan), complex(math.nan, math.nan)
        return super().exact_phase(theta, omega, t)
