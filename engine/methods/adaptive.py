"""Step size control: a step is divided until it looks accurate enough.

Whether a step is divided depends on its start, and may differ on the way back: it is neither
symplectic nor reversible, whatever the method inside.  Hairer, Lubich & Wanner (2006), VIII.1.
"""

import math
from collections.abc import Iterator
from typing import Any

from pendu_tui.engine.methods.method import Method, Phases
from pendu_tui.engine.methods.verlet import velocity_verlet
from pendu_tui.engine.models.model import Force, Phase

TOLERANCE = 0.1  # rad and rad/s, of a step


def halving(phases: Phases, tolerance: float, richardson: bool = False) -> Phases:
    """Return the method with step doubling: h is halved where a step and two halves differ.

    The result is that of the two halves, or with `richardson` their extrapolation, of order 4 for a
    method of order 2.  Each step begins with h again.  The difference is hypot(theta, omega), in
    rad and rad/s.
    """

    def step(force: Force, phase: Phase, h: float, halvings: int) -> Phase:
        whole = next(phases(force, phase, h))
        halves = next(phases(force, next(phases(force, phase, h / 2)), h / 2))
        theta = halves[0] - whole[0]
        omega = halves[1] - whole[1]
        if halvings and math.hypot(theta, omega) > tolerance:
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
        phases=halving(velocity_verlet, TOLERANCE, richardson),
        formula="a step of velocity Verlet, and two halves: if they differ by more than "
        f"{TOLERANCE}, halve h; {ends}",
        reference="Press et al., Numerical Recipes, 2nd edition (1992), 16.2",
        used=None,
        note="Its force evaluations, which equal cost uses, are the mean of a minute of the scene "
        "halving. An undivided step takes six, and the order is that of undivided steps.",
        models=("pendulum", "linear"),
        any_numbers=False,
        varies=True,
    )


HALVING_VERLET = _halving(
    key="halving_verlet",
    label="Step doubling",
    letter="h",
    other_names=("adaptive Verlet",),
    richardson=False,
    ends="the halves count",
    order=2,
    force_evaluations=8,
)

HALVING_RICHARDSON = _halving(
    key="halving_richardson",
    label="Richardson Verlet",
    letter="a",
    other_names=("extrapolated Verlet",),
    richardson=True,
    ends="they are extrapolated to h = 0",
    order=4,
    force_evaluations=7,
)

FAMILY = (HALVING_VERLET, HALVING_RICHARDSON)
