"""Measure every field of METHODS on the nonlinear pendulum."""

import cmath
import math
import re
from itertools import islice

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine import simulate
from pendu_tui.engine.methods import (
    EXPLICIT_EULER,
    GENERAL,
    METHODS,
    RK4,
    implicit,
    matching,
    measure,
)
from pendu_tui.engine.methods.implicit import BACKWARD_EULER, IMPLICIT_MIDPOINT
from pendu_tui.engine.methods.runge_kutta import EXPLICIT_MIDPOINT, HEUN
from pendu_tui.engine.methods.splitting import BLANES_MOAN_4, BLANES_MOAN_6
from pendu_tui.engine.models.pendulum import Pendulum
from pendu_tui.engine.run.tangent import jacobian
from pendu_tui.engine.scenes import Scene

W0_SQUARED = 9.81
PENDULUM = Pendulum(W0_SQUARED)
each_method = pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)


@each_method
def test_the_measured_properties_are_the_claimed_ones(method):
    found = measure.measured(method.phases)
    assert found.order == pytest.approx(method.order, abs=0.1)
    assert found.linear_limit == pytest.approx(method.linear_limit, abs=2e-9)  # to 1e-9 each
    assert (found.symplectic, found.reversible) == (method.symplectic, method.reversible)
    if method.varies:
        assert round(found.force_evaluations) == method.force_evaluations
    else:
        cost = (method.force_evaluations, int(method.first_same_as_last))
        assert (found.force_evaluations, found.more_at_the_start) == cost


def test_a_method_that_does_not_follow_the_pendulum_has_no_order():
    def upwards(force, phase, h):
        theta, omega = phase
        while True:
            theta, omega = theta + h * omega, omega - h * force(theta)
            yield theta, omega

    assert measure.order(upwards) is None
    assert "another equation" in measure.no_order(measure.order(upwards))


@pytest.mark.parametrize("coefficient", [0.5001, 0.501, 0.55])
def test_a_wrong_coefficient_has_an_error_that_stays(coefficient):
    def kicked(force, phase, h):
        theta, omega = phase
        while True:
            omega = omega + coefficient * h * force(theta)
            theta = theta + h * omega
            omega = omega + 0.5 * h * force(theta)
            yield theta, omega

    found = measure.order(kicked)
    assert abs(found) < 0.1
    assert "does not fall with h" in measure.no_order(found)


@pytest.mark.parametrize(
    ("method", "island"), [(BLANES_MOAN_4, (3.1686, 5.02)), (BLANES_MOAN_6, (3.1424, 6.34))]
)
def test_above_the_first_edge_lies_a_gap_and_then_an_island(method, island):
    gap = np.linspace(method.linear_limit + 1e-6, island[0] - 3e-4, 100)
    assert all(measure.is_stable(method.phases, z) for z in np.linspace(*island, 100))
    assert not any(measure.is_stable(method.phases, z) for z in gap)


@given(theta=st.floats(-4, 4), omega=st.floats(-8, 8), h=st.floats(0.0, 0.3))
def test_explicit_euler_blows_area_up_as_backward_euler_shrinks_it(theta, omega, h):
    def blown_up(angle):
        return 1 + h**2 * W0_SQUARED * math.cos(angle)

    explicit = jacobian(EXPLICIT_EULER, PENDULUM, theta, omega, h).determinant
    assert explicit == pytest.approx(blown_up(theta), abs=1e-14)
    end, _ = BACKWARD_EULER.step(PENDULUM.force(), (theta, omega), h)
    backward = jacobian(BACKWARD_EULER, PENDULUM, theta, omega, h).determinant
    assert 1 / backward == pytest.approx(blown_up(end), abs=1e-9)


@pytest.mark.parametrize("method", implicit.FAMILY, ids=lambda method: method.key)
@given(theta=st.floats(-4, 4), omega=st.floats(-8, 8), z=st.floats(0.0, 0.99))
def test_newtons_iteration_solves_the_equation_of_the_step(method, theta, omega, z):
    h, force = z / PENDULUM.w0, PENDULUM.force()
    theta_end, omega_end = method.step(force, (theta, omega), h)
    share = {BACKWARD_EULER: 1.0, IMPLICIT_MIDPOINT: 0.5}[method]
    inside, middle = theta + share * (theta_end - theta), omega + share * (omega_end - omega)
    assert omega_end == pytest.approx(omega + h * force(inside), abs=1e-11)
    assert theta_end == pytest.approx(theta + h * middle, abs=1e-11)


def test_a_step_without_a_solution_fails_and_others_of_an_array_do_not():
    far, near = np.array([3.0, 0.1]), np.zeros(2)
    step = IMPLICIT_MIDPOINT.step
    theta, omega = step(PENDULUM.force(np.sin), (far, near), 2.2 / PENDULUM.w0)
    assert np.isnan([theta[0], omega[0]]).all()
    assert math.isnan(step(PENDULUM.force(), (3.0, 0.0), 2.2 / PENDULUM.w0)[0])
    assert np.isfinite([theta[1], omega[1]]).all()


@pytest.mark.parametrize("h", [0.01, 0.3])
@pytest.mark.parametrize(
    ("method", "sign"), [(BACKWARD_EULER, -1), (HEUN, 1), (EXPLICIT_MIDPOINT, 1)]
)
def test_backward_euler_loses_energy_and_heun_and_the_midpoint_rule_gain_some(method, sign, h):
    run = simulate(time=60.0, methods=[method], h=h)
    assert sign * run[method.key].energy_error[-1] > 0


@given(z=st.floats(0.001, 5.0))
def test_the_energy_of_small_swings_changes_as_the_cards_say(z):
    gain = 1 + z**4 / 4
    for method, factor in ((HEUN, gain), (EXPLICIT_MIDPOINT, gain), (IMPLICIT_MIDPOINT, 1)):
        theta, omega = method.step(lambda angle: -angle, (0.6, 0.8), z)
        assert theta**2 + omega**2 == pytest.approx(factor, rel=1e-12)


def test_rk4_loses_area_with_the_sixth_power_of_h():
    """det - 1 of a step at the bottom is -z⁶/72 + z⁸/576; along a swing the power is the same."""

    def lost(h):
        period = [Scene().exact().at(k * 0.1) for k in range(22)]
        return -sum(math.log(jacobian(RK4, PENDULUM, *state, h).determinant) for state in period)

    assert lost(0.02) > 0
    assert math.log2(lost(0.04) / lost(0.02)) == pytest.approx(6, abs=0.1)  # z⁸ is 0.4 % of z⁶


@each_method
@given(theta=st.floats(-3, 3), omega=st.floats(-6, 6))
def test_a_negative_step_undoes_a_step_where_reversible(method, theta, omega):
    """The lab reverses time by h -> -h; all methods keep the symmetry omega, h -> -omega, -h."""
    force = PENDULUM.force()
    back = method.step(force, method.step(force, (theta, omega), 0.05), -0.05)
    if method.reversible:
        assert back == pytest.approx((theta, omega), abs=1e-14)  # rounding of one step
    turned = method.step(force, (theta, -omega), 0.05)
    assert method.step(force, (theta, omega), -0.05) == (turned[0], -turned[1])


@each_method
@pytest.mark.parametrize(
    ("kind", "sin"), [(lambda x: np.full(3, x), np.sin), (complex, cmath.sin), (mp.mpf, mp.sin)]
)
def test_one_definition_serves_floats_arrays_complex_and_mpmath(method, kind, sin):
    def propagate(kind, sin):
        phases = method.phases(Pendulum(kind(W0_SQUARED)).force(sin), (kind(0.8), kind(-1.1)), 0.05)
        return [complex(np.ravel(value)[0]) for value in next(islice(phases, 19, None))]

    # 20 steps' rounding; their sines may differ in the last bit
    assert propagate(kind, sin) == pytest.approx(propagate(float, math.sin), abs=1e-13)


@pytest.mark.parametrize("field", ["key", "label", "letter", "phases", "formula"])
def test_no_two_methods_share_a_name(field):
    assert len({getattr(method, field) for method in METHODS}) == len(METHODS)


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
def test_every_method_has_its_names_a_reference_and_a_use_with_its_source(method):
    assert all(matching(name) == [method] for name in method.names)
    assert method.other_names
    assert re.fullmatch("[a-zA-Z]", method.letter)
    assert re.search(r"\(\d{4}\)", method.reference)
    if method.used is None:
        assert not method.general
    else:
        assert re.fullmatch(r"[^\[\]]+ \[[a-z0-9-]+(\.[a-z0-9-]+)+, [^\[\]]+\]", method.used)


@pytest.mark.parametrize(
    ("typed", "keys"),
    [
        ("Störmer Verlet", ["velocity_verlet"]),
        ("rk", ["rk4"]),  # those for one scene match only if no general one does
        ("single", []),  # a label is matched whole
        ("verlet", ["velocity_verlet"]),  # another name
        ("moan", ["blanes_moan_4", "blanes_moan_6"]),  # a later word
        ("respa", ["respa"]),
        ("learned", ["learned_map", "learned_symplectic_map"]),
        ("", []),
    ],
)
def test_a_method_is_found_by_its_names_or_the_start_of_a_word_of_its_key(typed, keys):
    assert [method.key for method in matching(typed)] == keys
