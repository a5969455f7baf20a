"""Splittings of order 4 and 6: kicks and drifts in turn.

Kicks and drifts make them symplectic; the same coefficients backwards make them reversible.
"""

from collections.abc import Iterator
from functools import partial
from itertools import pairwise

from pendu_tui.engine.methods.method import COMPILABLE, Method, Phases
from pendu_tui.engine.models.model import Force, Phase


def splitting(kicks: tuple[float, ...], drifts: tuple[float, ...]) -> Phases:
    """Return the method of kicks and drifts by these fractions of h in turn, from kick to kick.

    There is one kick more than there are drifts, and both add up to 1.  The last force of a step is
    the first of the next.  Hairer, Lubich & Wanner (2006), II.5.
    """
    first = kicks[0]
    following = kicks[1:]

    def kicks_and_drifts(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        theta, omega = phase
        opening = first * h
        pairs = zip(drifts, following)  # noqa: B905  Numba lacks it
        moves = [(drift * h, kick * h) for drift, kick in pairs]
        a = force(theta)
        while True:
            omega = omega + opening * a
            for drift, kick in moves:
                theta = theta + drift * omega
                a = force(theta)
                omega = omega + kick * a
            yield theta, omega

    def without_list(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        """Do the same for Numba, which never frees a list in a generator (numba/numba#1278)."""
        theta, omega = phase
        a = force(theta)
        while True:
            omega = omega + first * h * a
            for drift, kick in zip(drifts, following):  # noqa: B905
                theta = theta + drift * h * omega
                a = force(theta)
                omega = omega + kick * h * a
            yield theta, omega

    COMPILABLE[kicks_and_drifts] = lambda: without_list
    return kicks_and_drifts


def composition(*weights: float) -> Phases:
    """Return velocity Verlet with these fractions of h in turn.

    Hairer, Lubich & Wanner (2006), II.4.
    """
    inner = (before / 2 + after / 2 for before, after in pairwise(weights))
    return splitting((weights[0] / 2, *inner, weights[-1] / 2), weights)


def mirrored(half: tuple[float, ...], odd: bool) -> tuple[float, ...]:
    """Return coefficients and then the same backwards; if `odd`, without repeating the last."""
    repeated = half[:-1] if odd else half
    return (*half, *reversed(repeated))


_method = partial(Method, first_same_as_last=True, symplectic=True, reversible=True)

_blanes_moan = partial(
    _method,
    reference="Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, table 3",
    used="n-body spaceflight: Principia [github.com, mockingbirdnest/Principia, "
    "integrators/methods.hpp]",
)

_C = 1 / (2 - 2 ** (1 / 3))

FOREST_RUTH = _method(
    key="forest_ruth",
    label="Forest–Ruth",
    letter="f",
    phases=composition(_C, 1 - 2 * _C, _C),
    formula="velocity Verlet with c h, (1 - 2c) h and c h in turn, c = 1/(2 - 2^(1/3)) = 1.3512",
    order=4,
    force_evaluations=3,
    linear_limit=1.57340194743,
    longest_substep=2 * _C - 1,
    other_names=("Yoshida 4", "triple jump"),
    reference="Forest & Ruth, Physica D 43 (1990) 105",
    used="orbits in galaxies: gala, Ruth4Integrator [gala.adrian.pw, Ruth4Integrator]",
    note="Its middle step goes backwards by 1.7 h. Its limit is lower than any other "
    "symplectic method's, and at 20 evaluations a second its energy error is hardly smaller than "
    "Verlet's.",
)

BLANES_MOAN_4 = _blanes_moan(
    key="blanes_moan_4",
    label="BM4",
    letter="b",
    phases=splitting(
        mirrored(
            (0.08298440641740502, 0.39630980149836807, -0.039056304922348436, 0.11952419401315068),
            odd=True,
        ),
        mirrored((0.24529895718427116, 0.60487266571107997, -0.35017162289535114), odd=False),
    ),
    formula="7 kicks and 6 drifts in turn: .083, .245, .396, .605, -.039, -.350, .120 and the same "
    "backwards, times h",
    order=4,
    force_evaluations=6,
    linear_limit=3.16346506656,
    other_names=("Blanes-Moan SRKN 6b",),
    note="It follows a 2 rad swing for 100 s to within 1e-3 (1e-6) rad in 2,800 (7,800) "
    "evaluations; Yoshida 6 takes 7,700 (23,800), RK4 15,600 (59,000).",
)

BLANES_MOAN_6 = _blanes_moan(
    key="blanes_moan_6",
    label="BM6",
    letter="m",
    phases=splitting(
        mirrored(
            (
                0.04146499851826284,
                0.19812867191806655,
                -0.040006192104152686,
                0.07525398430158034,
                -0.01151138742068777,
                0.23666992478693073,
            ),
            odd=False,
        ),
        mirrored(
            (
                0.12322977594627115,
                0.29055379779955827,
                -0.12704921262541692,
                -0.2463317610620754,
                0.35720887279592776,
                0.2047770542914703,
            ),
            odd=True,
        ),
    ),
    formula="12 kicks and 11 drifts in turn: .041, .123, .198, .291, -.040, -.127, .075, -.246, "
    "-.012, .357, .237, .205 and the same backwards, times h",
    order=6,
    force_evaluations=11,
    linear_limit=3.14143108775,
    other_names=("Blanes-Moan SRKN 11b",),
    note="Of order 6 only where the force depends on the position alone. It follows a swing from 2 "
    "rad for 100 s to within 1e-9 rad in 26,400 evaluations; BM4 takes 36,000, RK4 182,000.",
)

_YOSHIDA = (0.78451361047755726, 0.23557321335935813, -1.1776799841788710)

YOSHIDA_6 = _method(
    key="yoshida_6",
    label="Yoshida 6",
    letter="y",
    phases=composition(*mirrored((*_YOSHIDA, 1 - 2 * sum(_YOSHIDA)), odd=True)),
    formula="velocity Verlet with .785, .236, -1.178, 1.315, -1.178, .236 and .785 h in turn",
    order=6,
    force_evaluations=7,
    linear_limit=2.26905799640,
    longest_substep=1 - 2 * sum(_YOSHIDA),
    other_names=("Yoshida 6A",),
    reference="Yoshida, Phys. Lett. A 150 (1990) 262, solution A",
    used="Hamiltonian systems: OrdinaryDiffEq.jl, Yoshida6 [docs.sciml.ai, Dynamical, Hamiltonian, "
    "and 2nd Order ODE Solvers]",
    note="Included because it is well known: BM6 needs fewer evaluations at every accuracy.",
)

FAMILY = (FOREST_RUTH, YOSHIDA_6, BLANES_MOAN_4, BLANES_MOAN_6)
