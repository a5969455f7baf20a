"""The frictionless pendulum.  Mass cancels; energies are per unit m·L², in s⁻²."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal, localcontext
from typing import Any, NamedTuple

from pendu_tui.engine.models.model import Energy, ExactMotion, Force, Model, Phase, Sine, State


@dataclass(frozen=True)
class Pendulum(Model):
    """theta'' = -w0² sin theta."""

    w0_squared: float  # g/L [s⁻²]

    key = "pendulum"
    equation = "theta'' = -w0² sin theta"
    turns = True
    has_separatrix = True

    def force(self, sin: Sine = math.sin) -> Force:
        """theta -> -w0² sin theta [rad/s²]."""
        strength = -self.w0_squared

        def pendulum_force(theta: Any) -> Any:
            return strength * sin(theta)

        return pendulum_force

    def slope(self, theta: float) -> float:
        return -self.w0_squared * math.cos(theta)

    def energy(self, sin: Sine = math.sin) -> Energy:
        """(theta, omega) -> omega²/2 + 2 w0² sin²(theta/2) [s⁻²].

        Equal to omega²/2 + w0² (1 - cos theta), which would cancel to nothing near the bottom.
        """
        twice = 2 * self.w0_squared

        def pendulum_energy(phase: Phase) -> Any:
            theta, omega = phase
            half = sin(theta * 0.5)
            return omega * omega * 0.5 + twice * half * half

        return pendulum_energy

    def exact(self, theta: float, omega: float) -> ExactMotion:
        return exact_pendulum(self.w0_squared, theta, omega)

    def level(self, theta: Any, omega: Any, cos: Sine = math.cos) -> Any:
        """Return 1 - E/E_separatrix: 1 at rest, 0 on the separatrix, negative in rotation.

        It is computed as a product, because the difference cancels near the separatrix.
        """
        c = cos(theta / 2)
        v = omega / (2 * self.w0)
        return (c - v) * (c + v)


class _Start(NamedTuple):
    theta: float  # rad
    omega: float  # rad/s
    w0: float  # rad/s


def exact_pendulum(w0_squared: float, theta: float, omega: float) -> ExactMotion:
    """Return the exact motion from theta [rad] and omega [rad/s]."""
    start = _Start(theta, omega, math.sqrt(w0_squared))
    with localcontext(prec=100):
        k_squared = _k_squared(theta, omega, w0_squared)
        d = 1 - k_squared
        k = float(k_squared.sqrt())
        k_prime = float(abs(d).sqrt())
    if k == 0:
        return ExactMotion(lambda t: State(0.0, 0.0), "equilibrium")
    if d > 0:
        return _libration(start, k, k_prime)
    if d < 0:
        return _rotation(start, k, k_prime)
    return ExactMotion(_separatrix(start), "separatrix")


def _k_squared(theta: float, omega: float, w0_squared: float) -> Decimal:
    """Return k² = (1 - cos theta)/2 + omega²/(4 w0²) in the precision of the decimal context.

    1 - cos is taken at theta/2⁶⁴, where five terms of its series are right to 100 digits, and the
    angle doubled 64 times by 1 - cos 2x = 2 (1 - cos x)(1 + cos x), so no digits of pi are needed.
    """
    small = Decimal(theta) / 2**64
    square = small * small
    versine = sum((-1) ** (n + 1) * square**n / math.factorial(2 * n) for n in range(1, 6))
    for _ in range(64):
        versine = 2 * versine * (2 - versine)
    return Decimal(versine) / 2 + Decimal(omega) ** 2 / (4 * Decimal(w0_squared))


def _half_angle(start: _Start) -> tuple[float, float, float]:
    """Return sin and cos of half the start angle in (-pi, pi), and the whole turns [rad]."""
    s = math.sin(start.theta / 2)
    c = math.cos(start.theta / 2)
    if c < 0:
        s = -s
        c = -c
    turns = round((start.theta - 2 * math.atan2(s, c)) / math.tau)
    return s, c, turns * math.tau


def _libration(start: _Start, k: float, k_prime: float) -> ExactMotion:
    """theta = 2 atan2(k sn u, dn u), omega = 2 w0 k cn u, u = w0 t + F(phi0), T = 4 K/w0."""
    w0 = start.w0
    s, c, turns = _half_angle(start)
    cn0 = start.omega / (2 * w0) / k
    quarter, sn_cn = _jacobi(k_prime)
    offset = s / k * _carlson_rf(cn0 * cn0, c * c, 1.0)  # 1 - k² sn² = c², which cannot cancel
    if cn0 < 0:
        offset = 2 * quarter - offset

    def motion(t: float) -> State:
        u = w0 * t + offset
        half_periods = round(u / (2 * quarter))
        sn, cn = sn_cn(u - half_periods * 2 * quarter)
        if half_periods % 2:
            sn = -sn
            cn = -cn
        dn = math.hypot(k_prime, k * cn)
        return State(turns + 2 * math.atan2(k * sn, dn), 2 * w0 * k * cn)

    return ExactMotion(motion, "libration", 4 * quarter / w0)


def _rotation(start: _Start, k: float, k_prime: float) -> ExactMotion:
    """theta = ±2 am(u, 1/k), omega = ±2 w0 k dn(u, 1/k).

    u = k w0 t + F(±theta0/2); a turn takes 2 K(1/k)/(k w0).
    """
    direction = math.copysign(1.0, start.omega)
    rate = start.w0 * k
    s, c, turns = _half_angle(start)
    dn0 = start.omega / (2 * rate)
    quarter, sn_cn = _jacobi(k_prime / k)
    offset = direction * s * _carlson_rf(c * c, dn0 * dn0, 1.0)

    def motion(t: float) -> State:
        u = rate * t + offset
        half_turns = round(u / (2 * quarter))
        sn, cn = sn_cn(u - half_turns * 2 * quarter)
        angle = 2 * math.atan2(sn, cn) + half_turns * math.tau
        dn = math.hypot(k_prime, cn) / k
        return State(turns + direction * angle, direction * 2 * rate * dn)

    return ExactMotion(motion, "rotation", 2 * quarter / rate)


def _separatrix(start: _Start) -> Callable[[float], State]:
    """theta = 2 gd(u), omega = ±2 w0/cosh u, u = ±w0 t: never upright.

    Only starts at the bottom lie on it to 100 digits.
    """
    rate = math.copysign(start.w0, start.omega)

    def motion(t: float) -> State:
        u = rate * t
        decay = math.exp(-abs(u))  # cosh itself overflows at u = 711
        swung = 4 * math.atan(math.tanh(u / 2))
        return State(start.theta + swung, 4 * rate * decay / (1 + decay * decay))

    return motion


def _carlson_rf(x: float, y: float, z: float) -> float:
    """Return Carlson's integral R_F(x, y, z), by duplication; at most one argument may be 0."""
    while True:
        mean = (x + y + z) / 3
        dx = 1 - x / mean
        dy = 1 - y / mean
        dz = 1 - z / mean
        # the series below errs by the sixth power of this
        if max(abs(dx), abs(dy), abs(dz)) < 2e-3:
            break
        root_x = math.sqrt(x)
        root_y = math.sqrt(y)
        root_z = math.sqrt(z)
        shift = root_x * root_y + root_y * root_z + root_z * root_x
        x = (x + shift) / 4
        y = (y + shift) / 4
        z = (z + shift) / 4
    e2 = dx * dy - dz * dz
    e3 = dx * dy * dz
    return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / math.sqrt(mean)


def _jacobi(k_prime: float) -> tuple[float, Callable[[float], tuple[float, float]]]:
    """Return K(k), and u -> (sn u, cn u) for |u| <= K, from k': Bulirsch's sncndn."""
    means: list[tuple[float, float]] = []
    a = 1.0
    b = k_prime
    while True:
        means.append((a, b))
        a, b, gap = (a + b) / 2, math.sqrt(a * b), a - b
        if gap <= 1e-8 * a:  # convergence is quadratic
            break
    ordered = tuple(reversed(means))

    def sn_cn(u: float) -> tuple[float, float]:
        if abs(u) < 1e-100:  # sn u = u, and the cotangent overflows
            return u, 1.0
        sine = math.sin(a * u)
        cotangent = math.cos(a * u) / sine
        c = a * cotangent
        dn = 1.0
        for arithmetic, geometric in ordered:
            cotangent *= c
            c *= dn
            dn = (geometric + cotangent) / (arithmetic + cotangent)
            cotangent = c / arithmetic
        sn = math.copysign(1 / math.sqrt(c * c + 1), sine)
        return sn, c * sn

    return math.pi / (2 * a), sn_cn


@dataclass(frozen=True)
class LinearOscillator(Model):
    """theta'' = -w0² theta: one period for every amplitude, and never over the top."""

    w0_squared: float  # s⁻²

    key = "linear"
    equation = "theta'' = -w0² theta"
    turns = False
    is_linear = True

    def force(self, sin: Sine = math.sin) -> Force:
        w0_squared = self.w0_squared

        def linear_force(theta: Any) -> Any:
            return -w0_squared * theta

        return linear_force

    def slope(self, theta: float) -> float:
        return -self.w0_squared

    def energy(self, sin: Sine = math.sin) -> Energy:
        """(omega² + w0² theta²)/2 [s⁻²]."""
        w0_squared = self.w0_squared

        def linear_energy(phase: Phase) -> Any:
            theta, omega = phase
            return omega * omega / 2 + w0_squared / 2 * theta * theta

        return linear_energy

    def exact(self, theta: float, omega: float) -> ExactMotion:
        """theta cos w0 t + omega/w0 sin w0 t."""
        w0 = self.w0

        def at(t: float) -> State:
            c = math.cos(w0 * t)
            s = math.sin(w0 * t)
            return State(theta * c + omega / w0 * s, omega * c - theta * w0 * s)

        if theta == 0 == omega:
            return ExactMotion(at, "equilibrium")
        return ExactMotion(at, "libration", math.tau / w0)

    def level(self, theta: Any, omega: Any, cos: Sine = math.cos) -> Any:
        """Return minus a quarter of the squared amplitude."""
        return -(theta * theta + omega * omega / self.w0**2) / 4
