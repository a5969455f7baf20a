"""Friction: where in a step it acts decides the order, and whether area shrinks as it should.

These ask the force for its `friction`, gamma [s⁻¹].
"""

import math
from collections.abc import Iterator
from typing import Any

from engine.methods.method import Method, Phases
from engine.methods.verlet import velocity_verlet
from engine.models.model import Number, Phase


def damped(phases: Phases) -> Phases:
    """The method with friction: omega times exp(-gamma h/2) before and after each of its steps.

    Around a symplectic method, area shrinks by exp(-gamma h) exactly, and a method of order 2 keeps its order.
    Bhatt, Floyd & Moore, J. Sci. Comput. 66 (2016) 1234.
    """

    def conformal(force: Any, phase: Phase, h: float) -> Iterator[Phase]:
        """Damp, step, damp."""
        theta, omega = phase
        damping, known = math.exp(-force.friction * h / 2), (theta, force(theta))

        def remembered(theta: Number) -> Number:
            """The force; the last one of a step is the next one's first."""
            nonlocal known
            if theta is not known[0]:
                known = theta, force(theta)
            return known[1]

        while True:
            theta, omega = next(phases(remembered, (theta, omega * damping), h))
            omega = omega * damping
            yield theta, omega

    return conformal


def lagged_verlet(force: Any, phase: Phase, h: float) -> Iterator[Phase]:
    """Velocity Verlet with friction taken from the omega before each half kick.

    Order 1 only: the second half kick should know the omega that it leads to.
    """
    theta, omega = phase
    a = force(theta)
    while True:
        omega_half = omega + h / 2 * (a - force.friction * omega)
        theta = theta + h * omega_half
        a = force(theta)
        omega = omega_half + h / 2 * (a - force.friction * omega_half)
        yield theta, omega


LAGGED_VERLET = Method(
    key="lagged_verlet",
    label="Lagged Verlet",
    letter="l",
    phases=lagged_verlet,
    formula="velocity Verlet whose half kicks are h/2 (a - gamma omega), omega from before the kick",
    order=1,
    force_evaluations=1,
    first_same_as_last=True,
    other_names=("velocity Verlet with lagged damping",),
    reference="McLachlan & Quispel, Acta Numerica 11 (2002) 341",
    used=None,
    note="Without friction it is velocity Verlet, of order 2.",
    models=("damped",),
    general=False,
)

CONFORMAL_VERLET = Method(
    key="conformal_verlet",
    label="Conformal Verlet",
    letter="c",
    phases=damped(velocity_verlet),
    formula="omega times exp(-gamma h/2), a step of velocity Verlet, omega times exp(-gamma h/2)",
    order=2,
    force_evaluations=1,
    first_same_as_last=True,
    other_names=("conformally symplectic Verlet",),
    reference="Bhatt, Floyd & Moore, J. Sci. Comput. 66 (2016) 1234",
    used=None,
    note="It shrinks area by exp(-gamma h), as the motion does, wherever it is.",
    models=("damped",),
    general=False,
)

FAMILY = (LAGGED_VERLET, CONFORMAL_VERLET)
