"""Measure what the cards of methods say besides their fields."""

import cmath
import math
from itertools import islice

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import (
    METHODS,
    RK4,
    TAYLOR_20,
    VELOCITY_VERLET,
    method_of,
    splitting,
)
from pendu_tui.engine.methods.learned import (
    FAMILY,
    LEARNED_SYMPLECTIC_MAP,
    RK4_LEARNED_HAMILTONIAN,
    _numbers,
    learned_field,
    learned_hamiltonian,
    stored,
)
from pendu_tui.engine.methods.parts import CONFORMAL_VERLET, IMEX_EULER
from pendu_tui.engine.methods.splitting import FOREST_RUTH
from pendu_tui.engine.methods.tangent import Stretching, at_bottom, jacobian
from pendu_tui.engine.methods.verlet import (
    HALVING_RICHARDSON,
    HALVING_VERLET,
    VERLET_COMPENSATED,
    VERLET_FLOAT32,
    Float32,
)
from pendu_tui.engine.models import LinearOscillator, Pendulum
from pendu_tui.engine.models.damped import DampedPendulum
from pendu_tui.engine.models.spring import Spring
from pendu_tui.engine.run.loops import PlainLoops, count_evaluations
from pendu_tui.engine.run.stepping import Stepping
from tests.bench import learn

PENDULUM = Pendulum(9.81)
FORCE = PENDULUM.force()


def test_forest_ruth_has_the_weaknesses_on_its_card():
    limits = [method.linear_limit for method in METHODS if method.linear_limit]
    assert FOREST_RUTH.linear_limit == min(limits)
    cast = FOREST_RUTH, VELOCITY_VERLET
    wobbles = []
    for method, h in zip(cast, Stepping(0.15, equal_cost=True, cast=cast).own, strict=True):
        loops = PlainLoops(method, PENDULUM)
        _, _, _, low, high = loops.advance((1.0, 0.0), h, round(60 / h), math.inf)
        wobbles.append(high - low)
    assert 0.6 < wobbles[0] / wobbles[1] < 1


@pytest.mark.parametrize("method", splitting.FAMILY, ids=str)
def test_kicks_and_drifts_add_up_to_a_step_of_which_the_longest_is_known(method):
    places = []
    theta, _ = method.step(lambda theta: places.append(theta) or 0.0, (0.0, 1.0), 1.0)
    assert theta == pytest.approx(1.0, abs=1e-15)
    longest = max(abs(np.diff(places)))
    assert method.longest_substep == pytest.approx(max(longest, 1.0))
    if method is FOREST_RUTH:
        assert places[2] - places[1] == pytest.approx(-1.7, abs=0.01)
    _, omega = method.step(lambda theta: 1.0, (0.0, 0.0), 1.0)
    assert omega == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("w0", [1.0, 3.0])
def test_neighbours_separate_by_the_derivative_of_all_steps(w0):
    stretching = Stretching(VELOCITY_VERLET, LinearOscillator(w0**2), 2.1 / w0)
    for steps in (30, 70):
        stretching.carry((1.0, 0.5), steps)
    assert stretching.steps == 100
    step = np.reshape(at_bottom(VELOCITY_VERLET, 2.1), (2, 2))
    stretched = np.linalg.norm(np.linalg.matrix_power(step, 100)[:, 0])
    assert stretching.log == pytest.approx(math.log(stretched))


EXACT = [PENDULUM.exact(2.0, 0.0).at(t + 1.0).theta for t in range(100)]


def reaches(key, target, cost):
    """Whether so many evaluations follow a swing from 2 rad for 100 s, compared at 100 times."""
    method = method_of(key)
    every = cost // method.force_evaluations // 100
    run = islice(method.phases(FORCE, (2.0, 0.0), 1 / every), every - 1, None, every)
    return all(abs(theta - right) <= target for right, (theta, _) in zip(EXACT, run, strict=False))


@pytest.mark.parametrize(
    ("key", "target", "cost"),
    [
        ("blanes_moan_4", 1e-3, 3000),
        ("blanes_moan_4", 1e-6, 7800),
        ("blanes_moan_4", 1e-9, 36_000),
        ("blanes_moan_6", 1e-9, 26_400),
        ("yoshida_6", 1e-3, 7700),
        ("yoshida_6", 1e-6, 23_800),
        ("rk4", 1e-3, 15_600),
        ("rk4", 1e-6, 59_000),
        ("rk4", 1e-9, 190_000),
    ],
)
def test_accuracy_costs_as_much_as_the_cards_say(key, target, cost):
    assert reaches(key, target, cost)
    assert not reaches(key, target, round(0.93 * cost))


@pytest.mark.parametrize(("start", "most"), [((2.0, 0.0), 1e-12), ((3.14, 0.0), 1e-8)])
def test_taylors_series_follows_a_swing_of_20_s_in_200_steps(start, most):
    assert TAYLOR_20.force_evaluations == 0
    exact = PENDULUM.exact(*start)
    states = enumerate(islice(TAYLOR_20.on(PENDULUM)(start, 0.1), 200), 1)
    assert max(abs(theta - exact.at(0.1 * n).theta) for n, (theta, _) in states) < most


@pytest.mark.parametrize("method", [HALVING_VERLET, HALVING_RICHARDSON], ids=str)
@given(theta=st.floats(-1e9, 1e9), omega=st.floats(-1e9, 1e9), h=st.floats(-100, 100))
def test_where_nothing_looks_accurate_a_step_still_ends(method, theta, omega, h):
    left = iter(range(6 * (2**11 - 1)))

    def force(theta):
        next(left)
        return FORCE(theta)

    assert all(map(math.isfinite, method.step(force, (theta, omega), h)))


@pytest.mark.parametrize("method", [HALVING_VERLET, HALVING_RICHARDSON], ids=str)
def test_a_minute_of_step_doubling_takes_the_claimed_evaluations(method):
    counted = count_evaluations(method, PENDULUM, (2.0, 0.0), 0.2, 300)
    assert counted / 300 == pytest.approx(method.force_evaluations, abs=0.5)
    assert count_evaluations(method, PENDULUM, (0.1, 0.0), 0.05, 10) == 60
    assert "An undivided step takes six" in method.note


def log_energy_error(method, evaluations):
    """The largest |ln(E/E_true)| of a minute from 2 rad, for so many force evaluations."""
    model, h = DampedPendulum(9.81, 0.05), 60 * method.force_evaluations / evaluations
    reference, energy = model.reference(2.0, 0.0), model.energy()
    phases = enumerate(islice(method.on(model)((2.0, 0.0), h), round(60 / h)), 1)
    return max(abs(reference.errors(n * h, energy(phase))[0]) for n, phase in phases)


def test_conformal_verlet_is_cheaper_at_one_percent_and_rk4_at_a_thousandth():
    verlet, rk4 = (
        [log_energy_error(method, n) for n in (1440, 5760)] for method in (CONFORMAL_VERLET, RK4)
    )
    assert verlet[0] < 1e-2 < rk4[0]
    assert rk4[1] < 1e-4 < 1e-3 / 4 < verlet[1]


def test_conformal_verlet_shrinks_areas_as_the_motion_does():
    phases = CONFORMAL_VERLET.on(DampedPendulum(9.81, 0.2), cmath.sin)
    area = jacobian(phases, (1.0, 1.0), 0.05).determinant
    assert area == pytest.approx(math.exp(-0.2 * 0.05), rel=1e-14)


@given(a=st.floats(-1e15, 1e15))
def test_a_number_of_32_bits_is_numpys_float32(a):
    assert Float32(a) == np.float32(a)
    assert VERLET_FLOAT32.epsilon == np.finfo(np.float32).eps / 2
    assert VELOCITY_VERLET.epsilon == np.finfo(float).eps / 2


def test_a_compensation_goes_on_where_a_run_is_continued():
    propagate = PlainLoops(VERLET_COMPENSATED, PENDULUM).propagate
    whole = propagate((1.0, 0.0), 0.01, 2000)
    assert propagate(propagate((1.0, 0.0), 0.01, 1000), 0.01, 1000) == whole


def test_imex_euler_is_stable_at_any_stiffness_and_stops_the_swing_too():
    stiffest, stiff = Spring(9.81, 1e14), Spring(9.81, 2500.0)
    z, w = PlainLoops(IMEX_EULER, stiffest).propagate(stiffest.start(1.0, 0.0), 0.02, 1500)
    assert z == pytest.approx(-1j, abs=0.02)
    assert abs(w) < 0.2
    phases = islice(IMEX_EULER.on(stiff)(stiff.start(1.0, 0.0), 0.02), 500)
    left = [stiff.energy()(phase) / stiff.reference(1.0, 0.0).start for phase in phases]
    assert (left[49], left[499]) == pytest.approx((0.52, 0.065), abs=0.01)  # after 1 and 10 s


def rows(name):
    return np.array(_numbers(name))


@pytest.mark.slow
def test_the_learned_numbers_are_those_that_the_script_learns():
    """But for the last digits, which depend on the library behind NumPy."""
    learned = learn.learned(learn.SEED)
    assert list(learned) == list(stored())
    for name, expected in learned.items():
        assert rows(name) == pytest.approx(expected, rel=1e-4, abs=1e-4 * np.abs(expected).max())


def test_both_learned_fields_are_about_as_far_from_the_true_one():
    states, rates = learn.measurements(np.random.default_rng(7), 500, 0.0)
    for field in (learned_field(9.81), learned_hamiltonian(9.81)):
        found = np.array([field((theta, PENDULUM.w0 * omega)) for theta, omega in states])
        error = math.sqrt(((found / (PENDULUM.w0, 9.81) - rates) ** 2).mean() / (rates**2).mean())
        assert 0.005 < error < 0.008  # .0064 and .0062, of measurements with 2 % noise


def true_energy_errors(method, start):
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
def test_learned_energy_errors_are_those_of_the_cards_and_bounded_by_structure(start, figures):
    errors = {method: true_energy_errors(method, start) for method in FAMILY}
    assert [late for _, late in errors.values()] == pytest.approx(figures, rel=0.1)
    for method, (early, late) in errors.items():
        if method in (RK4_LEARNED_HAMILTONIAN, LEARNED_SYMPLECTIC_MAP):
            assert late == pytest.approx(early, rel=0.005)
        else:
            assert late > 1.1 * early


def test_rk4_loses_little_of_the_learned_hamiltonian():
    def energy(phase):  # over w0²
        theta, omega = phase
        a, b, c = rows("FEATURES").T
        return rows("HAMILTONIAN")[:, 0] @ np.tanh(a * theta + b / PENDULUM.w0 * omega + c)

    start = energy((1.5, 0.0))
    end = PlainLoops(RK4_LEARNED_HAMILTONIAN, PENDULUM).propagate((1.5, 0.0), 0.032, 3125)
    share = (energy(end) - start) / (start - energy((0.0, 0.0)))
    assert share / 100 == pytest.approx(-2.5e-7, rel=0.05)  # 1/s


@pytest.mark.parametrize("method", FAMILY, ids=str)
def test_what_was_learned_holds_for_any_length_and_gravity(method):
    """In units of w0 the motion is the same: here on the Moon."""
    moon = Pendulum(1.62)
    share = PENDULUM.w0 / moon.w0
    theta, omega = PlainLoops(method, PENDULUM).propagate((1.0, 0.5 * PENDULUM.w0), 0.02, 100)
    on_moon = PlainLoops(method, moon).propagate((1.0, 0.5 * moon.w0), 0.02 * share, 100)
    assert on_moon == pytest.approx((theta, omega / share), rel=1e-9)
