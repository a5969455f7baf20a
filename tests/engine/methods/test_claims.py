"""Every field of METHODS is a claim; here each is measured, on the nonlinear pendulum unless it says linear."""

import cmath
import math
import re

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import simulate
from engine.methods import (
    EXPLICIT_EULER,
    GENERAL,
    METHODS,
    RK4,
    USUAL_CAST,
    implicit,
    matching,
    measure,
)
from engine.methods.implicit import BACKWARD_EULER, IMPLICIT_MIDPOINT
from engine.methods.runge_kutta import EXPLICIT_MIDPOINT, HEUN
from engine.methods.splitting import BLANES_MOAN_4, BLANES_MOAN_6
from engine.models.pendulum import Pendulum, acceleration
from engine.run.tangent import jacobian
from engine.scenes import Scene

W0_SQUARED = 9.81
each_method = pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)


def travel(method, force, phase, h, n):
    for _ in range(n):
        phase = method.step(force, phase, h)
    return phase


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


@given(
    share=st.floats(0, 1 - 1e-8), beyond=st.floats(1e-8, 4)
)  # nearer to the edge it is a matter of rounding
def test_up_to_its_limit_a_method_is_stable_and_those_of_the_usual_cast_nowhere_beyond(
    share, beyond
):
    for method in GENERAL:
        assert measure.is_stable(method.phases, share * min(method.linear_limit, 10.0))
    for method in USUAL_CAST[1:]:
        assert not measure.is_stable(method.phases, method.linear_limit + beyond)


@pytest.mark.parametrize(
    ("method", "island"), [(BLANES_MOAN_4, (3.1686, 5.02)), (BLANES_MOAN_6, (3.1424, 6.34))]
)
def test_above_the_first_edge_lies_a_gap_and_then_an_island(method, island):
    gap = np.linspace(method.linear_limit + 1e-6, island[0] - 3e-4, 100)
    assert all(measure.is_stable(method.phases, z) for z in np.linspace(*island, 100))
    assert not any(measure.is_stable(method.phases, z) for z in gap)


@each_method
@pytest.mark.parametrize("start", [(2.5, 0.5), (0.5, 8.0)])
def test_the_error_falls_with_the_claimed_power_of_h(method, start):
    assert measure.order(method.phases, start) == pytest.approx(
        method.order, abs=0.1
    )  # the next power of h is felt


@pytest.mark.parametrize("method", [m for m in GENERAL if m.symplectic], ids=lambda m: m.key)
@given(theta=st.floats(-4, 4), omega=st.floats(-8, 8), h=st.floats(-0.5, 0.5))
def test_area_is_kept_where_claimed(method, theta, omega, h):
    # Jacobian entries up to 3 and a few products of them, each rounded.
    assert jacobian(method, Pendulum(W0_SQUARED), theta, omega, h).determinant == pytest.approx(
        1, abs=1e-14
    )


@given(theta=st.floats(-4, 4), omega=st.floats(-8, 8), h=st.floats(-0.5, 0.5))
def test_explicit_euler_blows_area_up_by_h2_w02_cos_theta(theta, omega, h):
    determinant = jacobian(EXPLICIT_EULER, Pendulum(W0_SQUARED), theta, omega, h).determinant
    assert determinant == pytest.approx(1 + h**2 * W0_SQUARED * math.cos(theta), abs=1e-14)


@given(theta=st.floats(-4, 4), omega=st.floats(-8, 8), h=st.floats(0.0, 0.3))
def test_backward_euler_shrinks_area_by_what_explicit_euler_adds_on_the_way_back(theta, omega, h):
    force = acceleration(W0_SQUARED)
    end, _ = BACKWARD_EULER.step(force, (theta, omega), h)
    determinant = jacobian(BACKWARD_EULER, Pendulum(W0_SQUARED), theta, omega, h).determinant
    assert 1 / determinant == pytest.approx(1 + h**2 * W0_SQUARED * math.cos(end), abs=1e-9)


@given(
    theta=st.floats(-4, 4),
    omega=st.floats(-8, 8),
    z=st.floats(0.0, 0.99),
    method=st.sampled_from(implicit.FAMILY),
)
def test_newtons_iteration_solves_the_equation_of_the_step(theta, omega, z, method):
    h = z / math.sqrt(W0_SQUARED)
    force = acceleration(W0_SQUARED)
    theta_end, omega_end = method.step(force, (theta, omega), h)
    share = 1.0 if method is BACKWARD_EULER else 0.5
    inside = theta + share * (theta_end - theta)
    assert omega_end == pytest.approx(omega + h * force(inside), abs=1e-11)
    middle = omega + share * (omega_end - omega)
    assert theta_end == pytest.approx(theta + h * middle, abs=1e-11)


@pytest.mark.parametrize("h", [0.001, 0.05, 0.3])
def test_backward_euler_loses_energy_and_heun_and_the_midpoint_rule_gain_some(h):
    for method, sign in ((BACKWARD_EULER, -1), (HEUN, 1), (EXPLICIT_MIDPOINT, 1)):
        judge = simulate(time=60.0, methods=[method.key], h=h)
        assert sign * judge[method.key].energy_error[-1] > 0


@given(z=st.floats(0.001, 5.0))
def test_of_small_swings_a_step_keeps_or_multiplies_the_energy_as_the_cards_say(z):
    start = (0.6, 0.8)
    for method, factor in (
        (HEUN, 1 + z**4 / 4),
        (EXPLICIT_MIDPOINT, 1 + z**4 / 4),
        (IMPLICIT_MIDPOINT, 1),
    ):
        theta, omega = method.step(lambda angle: -angle, start, z)
        assert theta**2 + omega**2 == pytest.approx(factor, rel=1e-12)


def test_rk4_loses_area_with_the_sixth_power_of_h():
    """det - 1 of a step at the bottom is -z⁶/72 + z⁸/576; along a swing the power is the same."""
    exact = Scene().exact()
    lost = []
    for h in (0.02, 0.04):
        states = [exact.at(k * 0.1) for k in range(22)]  # a period
        logs = [
            math.log(jacobian(RK4, Pendulum(W0_SQUARED), *state, h).determinant) for state in states
        ]
        lost.append(sum(logs))
    assert all(loss < 0 for loss in lost)
    assert math.log2(lost[1] / lost[0]) == pytest.approx(6, abs=0.1)  # z⁸ is 0.4 % of z⁶


@each_method
@given(theta=st.floats(-3, 3), omega=st.floats(-6, 6))
def test_a_negative_step_undoes_a_step_only_where_reversible(method, theta, omega):
    """Time reversed by h -> -h, as the lab does it; all methods keep the symmetry omega, h -> -omega, -h."""
    force = acceleration(W0_SQUARED)
    back = method.step(force, method.step(force, (theta, omega), 0.05), -0.05)
    if method.reversible:
        assert back == pytest.approx((theta, omega), abs=1e-14)  # rounding of one step
    turned = method.step(force, (theta, -omega), 0.05)
    assert method.step(force, (theta, omega), -0.05) == (turned[0], -turned[1])


@each_method
def test_one_definition_serves_floats_arrays_complex_and_mpmath(method):
    start, h = (0.8, -1.1), 0.05
    expected = travel(method, acceleration(W0_SQUARED), start, h, 20)
    arrays = travel(
        method,
        acceleration(W0_SQUARED, np.sin),
        (np.full(3, start[0]), np.full(3, start[1])),
        h,
        20,
    )
    complexes = travel(
        method, acceleration(W0_SQUARED, cmath.sin), (complex(start[0]), complex(start[1])), h, 20
    )
    exact = travel(
        method, acceleration(mp.mpf(W0_SQUARED), mp.sin), tuple(map(mp.mpf, start)), mp.mpf(h), 20
    )
    for other in (
        [float(values[0]) for values in arrays],
        complexes,
        [float(value) for value in exact],
    ):
        assert other == pytest.approx(
            expected, abs=1e-13
        )  # 20 steps' rounding; their sines may differ in the last bit


def test_names_are_unique_and_every_method_has_a_reference():
    for method in METHODS:
        for name in method.names:
            assert matching(name) == [method]
    for field in ("key", "label", "letter", "phases", "formula"):
        assert len({getattr(method, field) for method in METHODS}) == len(METHODS)
    for method in METHODS:
        assert re.fullmatch("[a-zA-Z]", method.letter)
        assert method.other_names
        assert re.search(r"\(\d{4}\)", method.reference)
        assert method.phases.__doc__


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
def test_every_general_method_names_a_use_and_its_source(method):
    if method.used is None:
        assert not method.general
    else:
        assert re.fullmatch(r"[^\[\]]+ \[[a-z0-9.-]+\.(io|org|pw|com|ai), [^\[\]]+\]", method.used)
