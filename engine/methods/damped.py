"""Methods for friction: where in a step it acts decides the order and how area shrinks.

They take the pendulum's force and its friction, gamma [s⁻¹], separately.
"""

import math
from collections.abc import Iterator

from pendu_tui.engine.methods.method import Method
from pendu_tui.engine.models.damped import DampedParts
from pendu_tui.engine.models.model import Phase


def conformal_verlet(parts: DampedParts, phase: Phase, h: float) -> Iterator[Phase]:
    """Velocity Verlet, with omega times exp(-gamma h/2) before and after each step.

    Area shrinks by exp(-gamma h) exactly.
    """
    force, friction = parts
    theta, omega = phase
    half = h / 2
    damping = math.exp(-friction * h / 2)
    a = force(theta)
    while True:
        omega_half = omega * damping + half * a
        theta = theta + h * omega_half
        a = force(theta)
        omega = (omega_half + half * a) * damping
        yield theta, omega


def lagged_verlet(parts: DampedParts, phase: Phase, h: float) -> Iterator[Phase]:
    """Velocity Verlet with friction taken from the omega before each half kick.

    It is of order 1 only, because the second half kick depends on the omega that it leads to.
    """
    force, friction = parts
    theta, omega = phase
    a = force(theta)
    while True:
        omega_half = omega + h / 2 * (a - friction * omega)
        theta = theta + h * omega_half
        a = force(theta)
        omega = omega_half + h / 2 * (a - friction * omega_half)
        yield theta, omega


LAGGED_VERLET = Method(
    key="lagged_verlet",
    label="Lagged Verlet",
    letter="l",
    phases=lagged_verlet,
    formula="velocity Verlet with half kicks h/2 (a - gamma omega), omega from before the kick",
    order=1,
    force_evaluations=1,
    first_same_as_last=True,
    other_names=("velocity Verlet with lagged damping",),
    reference="McLachlan & Quispel, Acta Numerica 11 (2002) 341",
    used=None,
    note="Without friction it is velocity Verlet, of order 2.",
    models=("damped",),
    takes_parts=True,
)

CONFORMAL_VERLET = Method(
    key="conformal_verlet",
    label="Conformal Verlet",
    letter="c",
    phases=conformal_verlet,
    formula="omega times exp(-gamma h/2), a step of velocity Verlet, omega times exp(-gamma h/2)",
    order=2,
    force_evaluations=1,
    first_same_as_last=True,
    other_names=("conformally symplectic Verlet",),
    reference="Bhatt, Floyd & Moore, J. Sci. Comput. 66 (2016) 1234",
    used=None,
    note="It shrinks area by exp(-gamma h), as the motion does, wherever it is.",
    models=("damped",),
    takes_parts=True,
)

FAMILY = (LAGGED_VERLET, CONFORMAL_VERLET)
