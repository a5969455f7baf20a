"""Velocity Verlet in other numbers than doubles, to show what rounding does."""

import struct
from collections.abc import Iterator
from typing import Any

from pendu_tui.engine.methods.method import HAIRER, Method
from pendu_tui.engine.methods.verlet import velocity_verlet
from pendu_tui.engine.models.model import Force, Phase


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
    note="Rounding is not symplectic: the modified energy walks, by 1e-5 in 10 000 steps.",
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
    numbers="each sum keeps what it rounds off for the next",
    keeps_area=True,
    used=None,
    note="Each sum takes three more additions.",
)

FAMILY = (VERLET_FLOAT32, VERLET_COMPENSATED)
