"""Methods learned from the same measurements keep different structure."""

import math
from itertools import islice

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods.learned import (
    FAMILY,
    LEARNED_MAP,
    LEARNED_SYMPLECTIC_MAP,
    RK4_LEARNED_FIELD,
    RK4_LEARNED_HAMILTONIAN,
    learned_field,
    learned_hamiltonian,
    stored,
)
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.run.loops import PlainLoops
from tests.bench import learn

W0_SQUARED = 9.81
PENDULUM = Pendulum(W0_SQUARED)
each_way = pytest.mark.parametrize("method", FAMILY, ids=lambda m: m.key)


@pytest.mark.slow
def test_the_numbers_are_those_that_the_script_learns():
    """But for the last digits, which depend on the library behind NumPy."""
    weights, biases, theta, omega, energy = learn.learned(learn.SEED)
    found = (np.column_stack((weights, biases)), np.column_stack((theta, omega)), energy[:, None])
    plain, (kick, drift) = learn.learned_maps(learn.SEED)
    found = (*found, plain, kick.T, drift.T)
    for text, expected in zip(stored().values(), found, strict=True):
        numbers = np.array([[float(number) for number in row.split(",")] for row in text.split()])
        assert numbers == pytest.approx(expected, rel=1e-4, abs=1e-4 * np.abs(expected).max())


def test_both_fields_are_about_as_far_from_the_true_one():
    states, rates = learn.measurements(np.random.default_rng(7), 500, 0.0)
    w0 = math.sqrt(W0_SQUARED)
    for field in (learned_field(W0_SQUARED), learned_hamiltonian(W0_SQUARED)):
        found = np.array([field((theta, w0 * omega)) for theta, omega in states]) / (w0, W0_SQUARED)
        error = math.sqrt(((found - rates) ** 2).mean() / (rates**2).mean())
        assert 0.005 < error < 0.008  # .0064 and .0062, of measurements with 2 % noise


def largest_energy_errors(method, start):
    """The largest relative errors of the true energy in 50 s and in 100 s, w0 h being 0.1."""
    energy, advance = PENDULUM.energy()((start, 0.0)), PlainLoops(method, PENDULUM).advance
    _, phase, _, low, high = advance((start, 0.0), 0.032, 1562, math.inf)
    _, _, _, lowest, highest = advance(phase, 0.032, 1563, math.inf)
    early = max(high / energy - 1, 1 - low / energy)
    return early, max(early, highest / energy - 1, 1 - lowest / energy)


@pytest.mark.parametrize(
    ("start", "figures"),
    [
        (0.2, (8.4, 0.12, 8.7, 0.030)),
        (1.0, (0.36, 0.012, 0.35, 0.0059)),
        (1.5, (0.60, 0.0056, 0.61, 0.0039)),
        (2.0, (0.15, 0.0033, 0.17, 0.0032)),
    ],
)
def test_energy_errors_are_those_of_the_cards_and_bounded_by_structure(start, figures):
    errors = {method: largest_energy_errors(method, start) for method in FAMILY}
    assert [late for _, late in errors.values()] == pytest.approx(figures, rel=0.1)
    for method in (RK4_LEARNED_HAMILTONIAN, LEARNED_SYMPLECTIC_MAP):
        early, late = errors[method]
        assert late == pytest.approx(early, rel=0.005)
    for method in (RK4_LEARNED_FIELD, LEARNED_MAP):
        early, late = errors[method]
        assert late > 1.1 * early


def test_rk4_loses_little_of_the_learned_hamiltonian():
    rows = [
        (float(a), float(b), float(c), float(size))
        for (a, b, c), (size,) in (
            (feature.split(","), size.split(","))
            for feature, size in zip(
                stored()["FEATURES"].split(), stored()["HAMILTONIAN"].split(), strict=True
            )
        )
    ]

    def energy(phase):  # over w0²
        theta, omega = phase
        return sum(k * math.tanh(a * theta + b / PENDULUM.w0 * omega + c) for a, b, c, k in rows)

    start = energy((1.5, 0.0))
    end = PlainLoops(RK4_LEARNED_HAMILTONIAN, PENDULUM).propagate((1.5, 0.0), 0.032, 3125)
    share = (energy(end) - start) / (start - energy((0.0, 0.0)))
    assert share / 100 == pytest.approx(-2.5e-7, rel=0.05)  # 1/s


@each_way
def test_what_was_learned_holds_for_any_length_and_gravity(method):
    """In units of w0 the motion is the same: here on the Moon."""
    moon = Pendulum(1.62)
    share = PENDULUM.w0 / moon.w0
    theta, omega = PlainLoops(method, PENDULUM).propagate((1.0, 0.5 * PENDULUM.w0), 0.02, 500)
    on_moon = PlainLoops(method, moon).propagate((1.0, 0.5 * moon.w0), 0.02 * share, 500)
    assert on_moon == pytest.approx((theta, omega / share), rel=1e-9)


@given(theta=st.floats(-2.4, 2.4), omega=st.floats(-5, 5))
def test_the_learned_hamiltonians_field_has_no_divergence(theta, omega):
    field, d = learned_hamiltonian(W0_SQUARED), 1e-5
    along = field((theta + d, omega))[0] - field((theta - d, omega))[0]
    across = field((theta, omega + d))[1] - field((theta, omega - d))[1]
    assert along + across == pytest.approx(0, abs=1e-5 * 2 * d)


@each_way
def test_it_has_the_claimed_order_on_the_learned_field(method):
    def end(n):
        theta, _ = next(islice(method.on(PENDULUM)((1.0, 0.0), 2.0 / n), n - 1, None))
        return float(theta)

    steps = (80, 113, 160)
    errors = [abs(end(n) - end(1600)) for n in steps]
    assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(method.order, abs=0.2)
