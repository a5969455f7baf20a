"""Methods that take the parts of one model: friction, a stiff spring, two levels, derivatives.

Where in a step friction acts decides the order and how area shrinks.
"""

import math
from collections.abc import Callable, Iterator
from itertools import islice
from typing import Any

from pendu_tui.engine.methods.method import COMPILABLE, HAIRER, Method, Phases
from pendu_tui.engine.methods.verlet import velocity_verlet
from pendu_tui.engine.models.damped import DampedParts
from pendu_tui.engine.models.mean_field import MeanField, strang
from pendu_tui.engine.models.model import Phase
from pendu_tui.engine.models.spring import SpringParts


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
    note="Without friction it is velocity Verlet, of order 2.",
    models=("damped",),
    takes="parts",
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
    note="A step multiplies all areas by exp(-gamma h), as the motion does.",
    models=("damped",),
    takes="parts",
)

FRICTION = (LAGGED_VERLET, CONFORMAL_VERLET)


INNER = 10  # steps of the fast motion in a step


def respa(parts: SpringParts, phase: Phase, h: float) -> Iterator[Phase]:
    """r-RESPA, the impulse method: steps with the fast force between half kicks of the slow."""
    q, w = phase
    slow = parts.slow(q)
    while True:
        w = w + h / 2 * slow
        inner = velocity_verlet(parts.fast, (q, w), h / INNER)
        q, w = next(islice(inner, INNER - 1, None))
        slow = parts.slow(q)
        w = w + h / 2 * slow
        yield q, w


def imex_euler(parts: SpringParts, phase: Phase, h: float) -> Iterator[Phase]:
    """Implicit-explicit Euler: the fast force at the end of the step, the slow one at its start.

    It is stable at any h because it damps every motion.
    """
    q, w = phase
    while True:
        following = parts.solve(q + h * (w + h * parts.slow(q)), h * h)
        q, w = following, (following - q) / h
        yield q, w


def mean_field_splitting(parts: MeanField, phase: Phase, h: float) -> Iterator[Phase]:
    """Half a drift; the exact flow of the rest, with theta fixed; half a drift.  |s| stays."""
    while True:
        phase = strang(parts, phase, h)
        yield phase


RESPA = Method(
    key="respa",
    label="RESPA",
    letter="p",
    phases=respa,
    formula=f"w + h/2 slow;  {INNER} steps of velocity Verlet with h/{INNER} and the fast force;  "
    "w + h/2 slow",
    order=2,
    force_evaluations=INNER + 1,
    symplectic=True,
    reversible=True,
    other_names=("impulse method", "IVI"),
    reference="Tuckerman, Berne & Martyna, J. Chem. Phys. 97 (1992) 1990",
    used="molecular dynamics: LAMMPS, run_style respa, OpenMM, MTSIntegrator [docs.openmm.org, "
    "MTSIntegrator]",
    note="With this uniform slow force, its kicks resonate if h is a multiple of the fast period. "
    "Evaluating either part counts as one.",
    models=("spring",),
    takes="parts",
)

IMEX_EULER = Method(
    key="imex_euler",
    label="IMEX Euler",
    letter="u",
    phases=imex_euler,
    formula="w' = w + h (fast(q') + slow(q));  q' = q + h w'",
    order=1,
    force_evaluations=1,
    other_names=("implicit-explicit Euler",),
    reference="Ascher, Ruuth & Spiteri, Appl. Numer. Math. 25 (1997) 151",
    used="equations with a stiff part: OrdinaryDiffEq.jl, IMEXEuler [docs.sciml.ai, IMEX SDIRK "
    "Methods]",
    note="Stable at any h; it takes energy out of the spring, more per step at larger h, and then "
    "out of the swing.",
    models=("spring",),
    takes="parts",
)

MEAN_FIELD_SPLITTING = Method(
    key="mean_field_splitting",
    label="Exact splitting",
    letter="x",
    phases=mean_field_splitting,
    formula="theta + h/2 omega;  s rotated by nu h about b(theta), while -kappa b'·s kicks omega;  "
    "theta + h/2 omega",
    order=2,
    force_evaluations=1,
    symplectic=True,
    reversible=True,
    other_names=("Strang splitting",),
    reference=f"{HAIRER}, II.5",
    note="Each kick counts as one evaluation; it rotates the Bloch vector s exactly.",
    models=("mean_field",),
    takes="parts",
)

FAST_AND_SLOW = (RESPA, IMEX_EULER, MEAN_FIELD_SPLITTING)


ORDER = 20
RECIPROCALS = tuple(1 / n for n in range(1, ORDER + 1))


def taylor(zeros: Callable[[int], Any]) -> Phases:
    """Return the Taylor polynomial of theta and omega; `zeros` makes room for coefficients.

    With u = w0² cos theta the motion is theta' = omega, omega'' = -omega u, u' = omega omega'.  The
    energy is not used, so nothing cancels near the separatrix.  Of the model it takes `w0_squared`
    [s⁻²] alone.
    """

    def series(parts: Any, phase: Phase, h: float) -> Iterator[Phase]:
        theta, omega = phase
        w = zeros(ORDER + 1)  # coefficients of h omega, times powers of h
        u = zeros(ORDER)  # of h² u
        while True:
            w[0] = h * omega
            w[1] = -h * h * parts.w0_squared * math.sin(theta)
            u[0] = h * h * parts.w0_squared * math.cos(theta)
            turned = 0.0
            faster = 0.0
            for k in range(ORDER - 1):
                half = k // 2
                square = 0.0
                # the product of omega and u, from both ends: a processor adds up both at a time
                low = 0.0
                high = 0.0
                for j in range(half):
                    square += w[j] * w[k - j]
                    low += w[j + 1] * u[k - 1 - j]
                    high += w[k - j] * u[j]
                if k % 2 == 1:
                    square += w[half] * w[half + 1]
                    low += w[half + 1] * u[half]
                else:
                    square += w[half] * w[half] / 2
                if k > 0:
                    u[k] = square
                w[k + 2] = -(w[0] * u[k] + low + high) * RECIPROCALS[k] * RECIPROCALS[k + 1]
                turned += w[k + 1] * RECIPROCALS[k + 1]
                faster += w[k + 2]
            # the largest terms last, because sums are rounded
            theta = theta + (w[0] + turned)
            omega = omega + (w[1] + faster) / h
            yield theta, omega

    return series


TAYLOR = taylor(lambda size: [0.0] * size)
"""The series for Python; Numba is faster with arrays."""


def _taylor_on_arrays() -> Phases:
    import numpy as np

    return taylor(np.zeros)


COMPILABLE[TAYLOR] = _taylor_on_arrays

TAYLOR_20 = Method(
    key="taylor_20",
    label="Taylor, order 20",
    letter="t",
    phases=TAYLOR,
    formula="the first 20 derivatives of theta and omega, by recurrence",
    order=ORDER,
    force_evaluations=0,
    reference="Jorba & Zou, Exp. Math. 14 (2005) 99",
    used="astronomy and spacecraft: heyoka [bluescarni.github.io, heyoka]",
    models=("pendulum",),
    takes="parts",
)
