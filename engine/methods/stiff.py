"""Methods for two time scales, made for a spring's fast and slow forces.

`solve(b, c)` is the solution of z = b + c fast(z); `slow` is a constant here.
"""

from collections.abc import Iterator
from itertools import islice

from pendu_tui.engine.methods.method import HAIRER, Method, Phases
from pendu_tui.engine.methods.verlet import velocity_verlet
from pendu_tui.engine.models.mean_field import MeanField, strang
from pendu_tui.engine.models.model import Phase
from pendu_tui.engine.models.spring import SpringParts


def respa(inner: Phases, n: int) -> Phases:
    """r-RESPA, the impulse method: n steps with the fast force between half kicks of the slow."""

    def impulse(parts: SpringParts, phase: Phase, h: float) -> Iterator[Phase]:
        z, w = phase
        slow = parts.slow(z)
        while True:
            w = w + h / 2 * slow
            z, w = next(islice(inner(parts.fast, (z, w), h / n), n - 1, None))
            slow = parts.slow(z)
            w = w + h / 2 * slow
            yield z, w

    return impulse


def imex_euler(parts: SpringParts, phase: Phase, h: float) -> Iterator[Phase]:
    """Implicit-explicit Euler: the fast force at the end of the step, the slow one at its start.

    It is stable at any h because it damps every motion.
    """
    z, w = phase
    while True:
        following = parts.solve(z + h * (w + h * parts.slow(z)), h * h)
        z, w = following, (following - z) / h
        yield z, w


def mean_field_splitting(parts: MeanField, phase: Phase, h: float) -> Iterator[Phase]:
    """Half a drift; the exact flow of the rest, with theta fixed; half a drift.  |s| stays."""
    while True:
        phase = strang(parts, phase, h)
        yield phase


INNER = 10

RESPA = Method(
    key="respa",
    label="RESPA",
    letter="p",
    phases=respa(velocity_verlet, INNER),
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
    note="Its kicks resonate if h is a multiple of the fast motion's period. Counted are "
    "evaluations of its parts.",
    models=("spring",),
    takes_parts=True,
)

IMEX_EULER = Method(
    key="imex_euler",
    label="IMEX Euler",
    letter="u",
    phases=imex_euler,
    formula="w' = w + h (fast(z') + slow(z));  z' = z + h w'",
    order=1,
    force_evaluations=1,
    other_names=("implicit-explicit Euler",),
    reference="Ascher, Ruuth & Spiteri, Appl. Numer. Math. 25 (1997) 151",
    used="equations with a stiff part: OrdinaryDiffEq.jl, IMEXEuler [docs.sciml.ai, IMEX SDIRK "
    "Methods]",
    note="Stable at any h; it takes energy out of the spring, the faster the longer h is, and then "
    "out of the swing.",
    models=("spring",),
    takes_parts=True,
)

MEAN_FIELD_SPLITTING = Method(
    key="mean_field_splitting",
    label="Exact splitting",
    letter="x",
    phases=mean_field_splitting,
    formula="theta + h/2 omega;  s turned by nu h about b(theta), omega kicked by it;  theta + h/2 "
    "omega",
    order=2,
    force_evaluations=1,
    symplectic=True,
    reversible=True,
    other_names=("Strang splitting",),
    reference=f"{HAIRER}, II.5",
    used=None,
    note="Counted are its kicks, each of which moves the two levels exactly over the whole step.",
    models=("mean_field",),
    takes_parts=True,
    any_numbers=False,
)

FAMILY = (RESPA, IMEX_EULER, MEAN_FIELD_SPLITTING)
