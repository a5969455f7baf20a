"""A pendulum learned from noisy measurements, as a field and as a Hamiltonian: RK4 on what was learned.

Both are sums of the same 60 random features, each fitted to the same 600 measurements by one least-squares problem
(tests/bench/learn.py); only in one of them the field is made of the slopes of one function, which it then conserves.
These methods know no other pendulum than the one that was measured, and never ask for the force.
"""

import math
from collections.abc import Iterator
from functools import cache
from typing import Any

from engine.methods.learned_numbers import FEATURES, FIELD, HAMILTONIAN
from engine.methods.method import Method
from engine.methods.runge_kutta import rk4_on_rates
from engine.models.model import Phase, Rates

W0_SQUARED = 9.81  # s⁻², of the pendulum that was measured


def _rows(numbers: str) -> list[tuple[float, ...]]:
    return [tuple(map(float, row.split(","))) for row in numbers.split()]


@cache
def learned_field() -> Rates:
    """Return (theta, omega) -> (theta', omega') with a sum for each."""
    w0 = math.sqrt(W0_SQUARED)
    rows = [(*feature, *sums) for feature, sums in zip(_rows(FEATURES), _rows(FIELD), strict=True)]

    def field(phase: Phase) -> Phase:
        theta, omega = phase
        drift = kick = 0.0
        for a, b, c, to_theta, to_omega in rows:
            feature = math.tanh(a * theta + b / w0 * omega + c)
            drift += to_theta * feature
            kick += to_omega * feature
        return w0 * drift, W0_SQUARED * kick

    return field


@cache
def learned_hamiltonian() -> Rates:
    """Return (theta, omega) -> (dH/d omega, -dH/d theta) of one sum H(theta, omega)."""
    w0 = math.sqrt(W0_SQUARED)
    rows = [(*feature, *sums) for feature, sums in zip(_rows(FEATURES), _rows(HAMILTONIAN), strict=True)]

    def field(phase: Phase) -> Phase:
        theta, omega = phase
        drift = kick = 0.0
        for a, b, c, coefficient in rows:
            feature = math.tanh(a * theta + b / w0 * omega + c)
            slope = coefficient * (1 - feature * feature)
            drift += b * slope
            kick -= a * slope
        return w0 * drift, W0_SQUARED * kick

    return field


def _learned(
    key: str, label: str, letter: str, field: Rates, formula: str, note: str, used: str | None = None
) -> Method:
    def phases(parts: Any, phase: Phase, h: float) -> Iterator[Phase]:
        """RK4 on what was learned, whatever the model."""
        return rk4_on_rates(field, phase, h)

    return Method(
        key=key,
        label=label,
        letter=letter,
        phases=phases,
        takes_parts=True,
        any_numbers=False,
        formula=formula,
        order=4,
        force_evaluations=4,
        other_names=("random features",),
        reference="Greydanus, Dzamba & Yosinski, Hamiltonian Neural Networks, NeurIPS 32 (2019)",
        used=used,
        note=f"{note} Of this order in what was learned; counted are evaluations of that.",
        models=("pendulum",),
    )


RK4_LEARNED_FIELD = _learned(
    "rk4_learned_field",
    "Learned field",
    "j",
    learned_field(),
    "RK4 on (theta', omega') = sums of 60 tanh(a theta + b omega + c), fitted to 600 measurements",
    "It conserves nothing: the true energy is off by a third after 100 s, or by all of it.",
)

RK4_LEARNED_HAMILTONIAN = _learned(
    "rk4_learned_hamiltonian",
    "Learned H",
    "g",
    learned_hamiltonian(),
    "RK4 on the slopes of H = a sum of 60 tanh(a theta + b omega + c), fitted to 600 measurements",
    "Its field is as inexact as the learned field, yet it conserves its H, so the true energy is off by a percent.",
    "learned dynamics that conserve: DiffEqFlux, HamiltonianNN [docs.sciml.ai, Hamiltonian Neural Network]",
)

FAMILY = (RK4_LEARNED_FIELD, RK4_LEARNED_HAMILTONIAN)
