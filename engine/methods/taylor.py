"""Taylor's series of the pendulum's own motion, to see beside methods that take any force."""

import math
from collections.abc import Iterator
from typing import Any

from pendu_tui.engine.methods.method import Method
from pendu_tui.engine.models.model import Phase

ORDER = 20


def taylor(parts: Any, phase: Phase, h: float) -> Iterator[Phase]:
    """The Taylor polynomial of theta and omega; `parts.w0_squared` [s⁻²] is all that it takes.

    With u = w0² cos theta the motion is theta' = omega, omega'' = -omega u, u' = omega omega'.  The
    energy is not used, so nothing cancels near the separatrix.
    """
    theta, omega = phase
    w = [0.0] * (ORDER + 1)  # the coefficients of omega
    u = [0.0] * ORDER
    while True:
        w[0] = omega
        w[1] = -parts.w0_squared * math.sin(theta)
        u[0] = parts.w0_squared * math.cos(theta)
        for k in range(ORDER - 1):
            square = 0.0
            for j in range((k + 1) // 2):
                square += w[j] * w[k - j]
            if k % 2 == 0:
                square += w[k // 2] * w[k // 2] / 2
            if k:
                u[k] = square
            product = 0.0
            for j in range(k + 1):
                product += w[j] * u[k - j]
            w[k + 2] = -product / ((k + 1) * (k + 2))
        turned = 0.0
        faster = 0.0
        for k in range(ORDER, 0, -1):
            turned = (turned + w[k - 1] / k) * h
            faster = (faster + w[k]) * h
        theta = theta + turned
        omega = omega + faster
        yield theta, omega


TAYLOR_20 = Method(
    key="taylor_20",
    label="Taylor, order 20",
    letter="t",
    phases=taylor,
    formula="the first 20 derivatives of theta and omega, by recurrence",
    order=ORDER,
    force_evaluations=0,
    reference="Jorba & Zou, Exp. Math. 14 (2005) 99",
    used="astronomy and spacecraft: heyoka [bluescarni.github.io, heyoka]",
    models=("pendulum",),
    takes_parts=True,
    any_numbers=False,
)

WHY_NOT = (
    "the Taylor series needs the pendulum's derivatives and has no force evaluations to count; see "
    "it with pendu-tui accuracy --cost seconds --methods taylor_20,rk4"
)
