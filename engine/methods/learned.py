"""A pendulum learned from noisy measurements in four ways, which keep different structure.

A field and a Hamiltonian are integrated by RK4; a map and a symplectic map are steps themselves.
Field and Hamiltonian are sums of the same 60 random features, fitted to the same 600 measurements
by least squares (tests/bench/learn.py).  Only the Hamiltonian's field consists of the slopes of one
function, which it conserves.  The measured pendulum had w0² = 9.81 s⁻²; everything is in units of
w0.  These methods take w0 from the model, and never the force.
"""

import math
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

from pendu_tui.engine.methods.method import Method
from pendu_tui.engine.methods.runge_kutta import rk4_on_rates
from pendu_tui.engine.models.model import Model, Phase, Rates


@cache
def stored() -> dict[str, str]:
    """Return the learned numbers by name, as tests/bench/learn.py wrote them."""
    import tomllib  # slow to load, and few scenes need it

    return tomllib.loads(Path(__file__).with_name("learned.toml").read_text("utf-8"))


def _numbers(name: str) -> list[tuple[float, ...]]:
    return [tuple(map(float, row.split(","))) for row in stored()[name].split()]


@cache
def _rows(coefficients: str) -> list[tuple[float, ...]]:
    """Return the three numbers of each feature with its coefficients."""
    pairs = zip(_numbers("FEATURES"), _numbers(coefficients), strict=True)
    return [(*feature, *each) for feature, each in pairs]


def _two_sums(coefficients: str, w0: float) -> Callable[[float, float], tuple[float, float]]:
    """Return (theta, omega) -> two sums of features."""
    rows = _rows(coefficients)

    def sums(theta: float, omega: float) -> tuple[float, float]:
        drift = kick = 0.0
        for a, b, c, to_theta, to_omega in rows:
            feature = math.tanh(a * theta + b / w0 * omega + c)
            drift += to_theta * feature
            kick += to_omega * feature
        return drift, kick

    return sums


def learned_field(w0_squared: float) -> Rates:
    """Return (theta, omega) -> (theta', omega') with a sum for each."""
    w0 = math.sqrt(w0_squared)
    sums = _two_sums("FIELD", w0)

    def field(phase: Phase) -> Phase:
        drift, kick = sums(*phase)
        return w0 * drift, w0_squared * kick

    return field


def learned_hamiltonian(w0_squared: float) -> Rates:
    """Return (theta, omega) -> (dH/d omega, -dH/d theta) of one sum H(theta, omega)."""
    w0 = math.sqrt(w0_squared)
    rows = _rows("HAMILTONIAN")

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


def _learned(*, note: str, **fields: Any) -> Method:
    return Method(
        **fields,
        takes="parts",
        any_numbers=False,
        models=("pendulum",),
        note=f"{note} Order and evaluations refer to the learned functions.",
    )


def _by_rk4(field: Callable[[float], Rates], **fields: Any) -> Method:
    def phases(model: Model, phase: Phase, h: float) -> Iterator[Phase]:
        return rk4_on_rates(field(model.w0_squared), phase, h)

    return _learned(
        **fields,
        phases=phases,
        order=4,
        force_evaluations=4,
        reference="Greydanus, Dzamba & Yosinski, Hamiltonian Neural Networks, NeurIPS 32 (2019)",
    )


RK4_LEARNED_FIELD = _by_rk4(
    learned_field,
    key="rk4_learned_field",
    label="Learned field",
    letter="j",
    other_names=("learned vector field",),
    formula="RK4 on d(theta, omega)/dt = sums of 60 terms k tanh(a theta + b omega + c), "
    "fitted to 600 measurements",
    note="It conserves nothing: within 100 s the true energy of a swing from 1 rad is off by "
    "36 %, from 1.5 rad by 60 %, and from 0.2 rad it is nine times as large.",
)

RK4_LEARNED_HAMILTONIAN = _by_rk4(
    learned_hamiltonian,
    key="rk4_learned_hamiltonian",
    label="Learned H",
    letter="g",
    other_names=("learned Hamiltonian",),
    formula="RK4 on Hamilton's equations of H = a sum of 60 terms k tanh(a theta + b omega + c), "
    "fitted to 600 measurements",
    note="Its field is as inexact as the learned field, but its flow conserves H; from 1.5 rad at "
    "w0 h = 0.1 RK4 loses 2.5e-7 of H per second. The true energy of a swing is off by 1.2 % from "
    "1 rad, 0.3 % from 2, 12 % from 0.2.",
    used="energy-conserving learned dynamics: DiffEqFlux, HamiltonianNN [docs.sciml.ai, "
    "Hamiltonian Neural Network]",
)


def learned_map(model: Model, phase: Phase, h: float) -> Iterator[Phase]:
    """The learned map, for w0 h = 0.1; at other h its increment is taken as proportional to h."""
    w0 = model.w0
    tau = w0 * h
    sums = _two_sums("MAP", w0)
    theta, omega = phase
    while True:
        drift, kick = sums(theta, omega)
        theta = theta + tau * drift
        omega = omega + w0 * tau * kick
        yield theta, omega


@cache
def _module(numbers: str) -> Callable[[float], float]:
    """Return x -> the sum of k tanh(a x + c)."""
    rows = _numbers(numbers)

    def module(x: float) -> float:
        return sum(k * math.tanh(a * x + c) for a, c, k in rows)

    return module


def learned_symplectic_map(model: Model, phase: Phase, h: float) -> Iterator[Phase]:
    """The learned symplectic map: half a kick by theta, a drift by omega, half a kick.

    It is symplectic whatever the two functions are.
    """
    w0 = model.w0
    tau = w0 * h
    push = _module("KICK")
    carry = _module("DRIFT")
    theta, omega = phase
    kick = push(theta)
    while True:
        omega = omega + tau / 2 * w0 * kick
        theta = theta + tau * carry(omega / w0)
        kick = push(theta)
        omega = omega + tau / 2 * w0 * kick
        yield theta, omega


LEARNED_MAP = _learned(
    key="learned_map",
    label="Learned map",
    letter="z",
    phases=learned_map,
    formula="(theta, omega/w0) + w0 h (two sums of 60 terms k tanh(a theta + b omega/w0 + c)), "
    "learned for w0 h = 0.1",
    order=1,
    force_evaluations=1,
    other_names=("plain learned map",),
    reference="Jin, Zhang, Zhu, Tang & Karniadakis, Neural Networks 132 (2020) 166",
    note="It preserves no structure: within 100 s at w0 h = 0.1 the true energy of a swing is off "
    "by 35 % from 1 rad, by 61 % from 1.5, and nine times as large from 0.2.",
)

LEARNED_SYMPLECTIC_MAP = _learned(
    key="learned_symplectic_map",
    label="SympNet",
    letter="t",
    phases=learned_symplectic_map,
    formula="half a kick, a drift, half a kick, by sums of 20 terms k tanh(a x + c) in theta "
    "and in omega/w0",
    order=2,
    force_evaluations=1,
    first_same_as_last=True,
    symplectic=True,
    other_names=("learned symplectic map",),
    reference="Jin, Zhang, Zhu, Tang & Karniadakis, Neural Networks 132 (2020) 166",
    note="It preserves area, so it nearly conserves a modified energy: within 100 s at w0 h = 0.1 "
    "the true one is off by 0.6 % for a start at 1 rad, 0.4 % at 1.5, 3 % at 0.2.",
)

FAMILY = (RK4_LEARNED_FIELD, RK4_LEARNED_HAMILTONIAN, LEARNED_MAP, LEARNED_SYMPLECTIC_MAP)
