"""The Verlet methods: half a kick, a drift, half a kick; or half a drift, a kick, half a drift."""

import math
import struct
from collections.abc import Iterator
from typing import Any

from pendu_tui.engine.methods.method import (
    HAIRER,
    Method,
    Phases,
    position_verlet_modified_energy,
    symplectic_euler_modified_energy,
    velocity_verlet_modified_energy,
)
from pendu_tui.engine.models.model import Force, Phase


def symplectic_euler(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Symplectic Euler: kick omega, then drift theta with the new omega."""
    theta, omega = phase
    while True:
        omega = omega + h * force(theta)
        theta = theta + h * omega
        yield theta, omega


def velocity_verlet(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Velocity Verlet: half a kick, a drift, half a kick; the last force is used again."""
    theta, omega = phase
    half = h / 2
    a = force(theta)
    while True:
        omega_half = omega + half * a
        theta = theta + h * omega_half
        a = force(theta)
        omega = omega_half + half * a
        yield theta, omega


def position_verlet(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Position Verlet: half a drift, a kick, half a drift."""
    theta, omega = phase
    half = h / 2
    while True:
        theta_half = theta + half * omega
        omega = omega + h * force(theta_half)
        theta = theta_half + half * omega
        yield theta, omega


SYMPLECTIC_EULER = Method(
    key="symplectic_euler",
    label="Symplectic Euler",
    letter="s",
    hue=1,
    phases=symplectic_euler,
    formula="omega' = omega + h a(theta);  theta' = theta + h omega'",
    order=1,
    force_evaluations=1,
    symplectic=True,
    linear_limit=2.0,
    other_names=("semi-implicit Euler", "Euler-Cromer"),
    reference=f"{HAIRER}, I.1.2",
    used="robots and physics simulation: the default of MuJoCo [mujoco.readthedocs.io, XML "
    "Reference, integrator]",
    modified_energy=symplectic_euler_modified_energy,
)

VELOCITY_VERLET = Method(
    key="velocity_verlet",
    label="Velocity Verlet",
    letter="v",
    hue=2,
    phases=velocity_verlet,
    formula="omega½ = omega + h/2 a(theta);  theta' = theta + h omega½;  omega' = omega½ + h/2 "
    "a(theta')",
    order=2,
    force_evaluations=1,
    first_same_as_last=True,
    symplectic=True,
    reversible=True,
    linear_limit=2.0,
    other_names=("Verlet", "Störmer", "Störmer-Verlet", "leapfrog", "kick-drift-kick"),
    reference=f"{HAIRER}, I.1.4",
    used="molecular dynamics: the default of LAMMPS [docs.lammps.org, run_style]",
    modified_energy=velocity_verlet_modified_energy,
    models=(*Method.models, "spring"),
)

POSITION_VERLET = Method(
    key="position_verlet",
    label="Position Verlet",
    letter="o",
    phases=position_verlet,
    formula="theta½ = theta + h/2 omega;  omega' = omega + h a(theta½);  theta' = theta½ + h/2 "
    "omega'",
    order=2,
    force_evaluations=1,
    symplectic=True,
    reversible=True,
    linear_limit=2.0,
    other_names=("drift-kick-drift",),
    reference=f"{HAIRER}, VI.3.1",
    used="planets: REBOUND, integrator leapfrog [rebound.readthedocs.io, Integrators]",
    modified_energy=position_verlet_modified_energy,
    models=(*Method.models, "spring"),
)

FAMILY = (VELOCITY_VERLET, POSITION_VERLET)


class Float32(float):
    """A number of 32 bits, IEEE binary32.

    A sum or product rounded to a double and then to 32 bits is the same as rounded once, because a
    double has more than twice the digits.  Figueroa, ACM SIGNUM Newsletter 30 (1995) 21.
    """

    __slots__ = ()

    def __new__(cls, value: float) -> "Float32":
        """Round to 32 bits.  Raises OverflowError beyond 3.4e38."""
        return super().__new__(cls, _BINARY32.unpack(_BINARY32.pack(value))[0])

    def __add__(self, other: float) -> "Float32":
        return Float32(float(self) + float(other))

    def __mul__(self, other: float) -> "Float32":
        return Float32(float(self) * float(other))

    __rmul__ = __mul__


_BINARY32 = struct.Struct("<f")


class Compensated(float):
    """A double that keeps what its last addition lost, and adds it in the next.

    Compensated summation: Kahan, Comm. ACM 8 (1965) 40; Hairer, Lubich & Wanner (2006), VIII.5.
    """

    __slots__ = ("compensation",)
    compensation: float

    def __new__(cls, value: float, compensation: float = 0.0) -> "Compensated":
        compensated = super().__new__(cls, value)
        compensated.compensation = compensation
        return compensated

    def __add__(self, other: float) -> "Compensated":
        increment = float(other) + self.compensation
        total = float(self) + increment
        return Compensated(total, increment - (total - float(self)))


def verlet_float32(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Velocity Verlet with all numbers in 32 bits; the sine is rounded from a double."""

    def rounded(theta: Any) -> Float32:
        return Float32(force(float(theta)))

    start = Float32(phase[0]), Float32(phase[1])
    for theta, omega in velocity_verlet(rounded, start, Float32(h)):
        yield float(theta), float(omega)


def verlet_compensated(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    """Velocity Verlet with compensated sums.  The compensation is a part of the phase."""
    theta, omega = (x if isinstance(x, Compensated) else Compensated(x) for x in phase)
    return velocity_verlet(force, (theta, omega), h)


def _verlet(*, numbers: str, keeps_area: bool, **fields: Any) -> Method:
    return Method(
        **fields,
        formula=f"velocity Verlet, {numbers}",
        order=2,
        force_evaluations=1,
        first_same_as_last=True,
        symplectic=keeps_area,
        reversible=keeps_area,
        linear_limit=2.0,
        reference=f"{HAIRER}, VIII.5",
        models=("pendulum",),
        any_numbers=False,
    )


VERLET_FLOAT32 = _verlet(
    phases=verlet_float32,
    key="verlet_float32",
    other_names=("single-precision Verlet",),
    label="Single Verlet",
    letter="n",
    numbers="all numbers rounded to 32 bits",
    keeps_area=False,
    note="Rounding is not symplectic: the modified energy does a random walk, "
    "about 1e-5 in 10000 steps.",
    epsilon=2.0**-24,
    used="molecular dynamics: positions and velocities in GROMACS [manual.gromacs.org, Definitions "
    "and Units]",
)

VERLET_COMPENSATED = _verlet(
    phases=verlet_compensated,
    key="verlet_compensated",
    other_names=("Verlet with compensated sums",),
    label="Kahan Verlet",
    letter="k",
    numbers="each sum carries its rounding error to the next",
    keeps_area=True,
    note="Each sum takes three more additions.",
)

PRECISION = (VERLET_FLOAT32, VERLET_COMPENSATED)


TOLERANCE = 0.1  # rad and rad/s, of a step


def halving(richardson: bool) -> Phases:
    """Return velocity Verlet with step doubling: h is halved where a step and two halves differ.

    The result is that of the two halves, or with `richardson` their extrapolation, of order 4.
    Each step begins with h again.  The difference is hypot(theta, omega), in rad and rad/s.
    """

    def step(force: Force, phase: Phase, h: float, halvings: int) -> Phase:
        whole = next(velocity_verlet(force, phase, h))
        middle = next(velocity_verlet(force, phase, h / 2))
        halves = next(velocity_verlet(force, middle, h / 2))
        theta = halves[0] - whole[0]
        omega = halves[1] - whole[1]
        if halvings and math.hypot(theta, omega) > TOLERANCE:
            return step(force, step(force, phase, h / 2, halvings - 1), h / 2, halvings - 1)
        if richardson:
            return halves[0] + theta / 3, halves[1] + omega / 3
        return halves

    def halved(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        while True:
            # at most ten halvings, because at 1e9 rad/s no step looks accurate
            phase = step(force, phase, h, 10)
            yield phase

    return halved


def _halving(*, richardson: bool, ends: str, **fields: Any) -> Method:
    return Method(
        **fields,
        phases=halving(richardson),
        formula="a step of velocity Verlet and two half steps: if they differ by more than "
        f"{TOLERANCE}, halve h; {ends}",
        reference="Press et al., Numerical Recipes, 2nd edition (1992), 16.2",
        note="Its force evaluations, as used for equal cost, are the mean over a minute of the "
        "scene halving. An undivided step takes six, and has the order given here.",
        any_numbers=False,
        varies=True,
    )


HALVING_VERLET = _halving(
    key="halving_verlet",
    label="Step doubling",
    letter="h",
    other_names=("adaptive Verlet",),
    richardson=False,
    ends="the half steps are kept",
    order=2,
    force_evaluations=8,
)

HALVING_RICHARDSON = _halving(
    key="halving_richardson",
    label="Richardson Verlet",
    letter="a",
    other_names=("extrapolated Verlet",),
    richardson=True,
    ends="both are extrapolated to h = 0",
    order=4,
    force_evaluations=7,
)

STEP_DOUBLING = (HALVING_VERLET, HALVING_RICHARDSON)
