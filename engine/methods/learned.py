"""A pendulum learned from noisy measurements, as a field and as a Hamiltonian: RK4 on what was learned.

Both are sums of the same 60 random features, each fitted to the same 600 measurements by one least-squares problem
(tests/bench/learn.py); only in one of them the field is made of the slopes of one function, which it then conserves.
The one that was measured had w0² = 9.81 s⁻²; what was learned is in units of w0, so it holds for any w0.  These methods
take w0 from the model, and never ask for the force.
"""

import math
from collections.abc import Callable, Iterator
from functools import cache, lru_cache

from engine.methods.learned_numbers import FEATURES, FIELD, HAMILTONIAN
from engine.methods.method import Method
from engine.methods.runge_kutta import rk4_on_rates
from engine.models.model import Model, Phase, Rates


@cache
def _rows(coefficients: str) -> list[tuple[float, ...]]:
    """Return for each feature its three numbers and its coefficients."""
    features, sums = (
        [tuple(map(float, row.split(","))) for row in text.split()]
        for text in (FEATURES, coefficients)
    )
    return [(*feature, *each) for feature, each in zip(features, sums, strict=True)]


@lru_cache(maxsize=16)
def learned_field(w0_squared: float) -> Rates:
    """Return (theta, omega) -> (theta', omega') with a sum for each."""
    w0 = math.sqrt(w0_squared)
    rows = _rows(FIELD)

    def field(phase: Phase) -> Phase:
        theta, omega = phase
        drift = kick = 0.0
        for a, b, c, to_theta, to_omega in rows:
            feature = math.tanh(a * theta + b / w0 * omega + c)
            drift += to_theta * feature
            kick += to_omega * feature
        return w0 * drift, w0_squared * kick

    return field


@lru_cache(maxsize=16)
def learned_hamiltonian(w0_squared: float) -> Rates:
    """Return (theta, omega) -> (dH/d omega, -dH/d theta) of one sum H(theta, omega)."""
    w0 = math.sqrt(w0_squared)
    rows = _rows(HAMILTONIAN)

    def field(phase: Phase) -> Phase:
        theta, omega = phase
        drift = kick = 0.0
        for a, b, c, coefficient in rows:
            feature = math.tanh(a * theta + b / w0 * omega + c)
            slope = coefficient * (1 - feature * feature)
            drift += b * slope
            kick -= a * slope
        return w0 * drift, w0_squared * kick

    return field


def _learned(
    key: str,
    label: str,
    letter: str,
    other_name: str,
    field: Callable[[float], Rates],
    formula: str,
    note: str,
    used: str | None = None,
) -> Method:
    def phases(model: Model, phase: Phase, h: float) -> Iterator[Phase]:
        """RK4 on what was learned."""
        return rk4_on_rates(field(model.w0_squared), phase, h)

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
        other_names=(other_name,),
        reference="Greydanus, Dzamba & Yosinski, Hamiltonian Neural Networks, NeurIPS 32 (2019)",
        used=used,
        note=f"{note} Of this order in what was learned; counted are evaluations of that.",
        models=("pendulum",),
    )


RK4_LEARNED_FIELD = _learned(
    "rk4_learned_field",
    "Learned field",
    "j",
    "learned vector field",
    learned_field,
    "RK4 on (theta', omega') = sums of 60 tanh(a theta + b omega + c), fitted to 600 measurements",
    "It conserves nothing: within 100 s the true energy is off by 36 % from 1 rad, 60 % from 1.5, ninefold from 0.2.",
)

RK4_LEARNED_HAMILTONIAN = _learned(
    "rk4_learned_hamiltonian",
    "Learned H",
    "g",
    "learned Hamiltonian",
    learned_hamiltonian,
    "RK4 on the slopes of H = a sum of 60 tanh(a theta + b omega + c), fitted to 600 measurements",
    "Its field is as inexact as the learned field, yet it conserves its H: the true energy is off by 1.2 % from 1 rad, "
    "0.3 % from 2 rad, 12 % from 0.2 rad.",
    "learned dynamics that conserve: DiffEqFlux, HamiltonianNN [docs.sciml.ai, Hamiltonian Neural Network]",
)

FAMILY = (RK4_LEARNED_FIELD, RK4_LEARNED_HAMILTONIAN)
