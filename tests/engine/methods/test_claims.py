"""Every field of METHODS is a claim; here each is measured, on the nonlinear pendulum unless it says linear."""

import cmath
import math
import re
from itertools import islice

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import EXPLICIT_EULER, GENERAL, METHODS, RK4, Method, measure
from engine.models.model import Force, Phase
from engine.models.pendulum import Pendulum, acceleration
from engine.run.tangent import jacobian
from engine.scenes import Scene

W0_SQUARED = 9.81
each_method = pytest.mark.parametrize("method", GENERAL, ids=lambda method: method.key)


def travel(method: Method, force: Force, phase: Phase, h: float, n: int) -> Phase:
    for _ in range(n):
        phase = method.step(force, phase, h)
    return phase


@each_method
@pytest.mark.parametrize("start", [(1.0, 0.0), (2.5, 0.5), (0.5, 8.0)])
def test_the_error_falls_with_the_claimed_power_of_h(method: Method, start: tuple[float, float]) -> None:
    assert measure.order(method.phases, start) == pytest.approx(method.order, abs=0.1)  # the next power of h is felt


@each_method
def test_a_step_evaluates_the_force_as_often_as_claimed(method: Method) -> None:
    where: list[float] = []

    def counted(theta: float) -> float:
        where.append(theta)
        return -W0_SQUARED * math.sin(theta)

    for steps in (1, 2, 10):
        where.clear()
        next(islice(method.phases(counted, (1.0, 0.5), 0.05), steps - 1, None))
        assert len(where) == method.evaluations(steps)


@pytest.mark.parametrize("method", [m for m in GENERAL if m.symplectic], ids=lambda m: m.key)
@given(theta=st.floats(-4, 4), omega=st.floats(-8, 8), h=st.floats(-0.5, 0.5))
def test_area_is_kept_where_claimed(method: Method, theta: float, omega: float, h: float) -> None:
    # Jacobian entries up to 3 and a few products of them, each rounded.
    assert jacobian(method, Pendulum(W0_SQUARED), theta, omega, h).determinant == pytest.approx(1, abs=1e-14)


@each_method
def test_area_is_lost_or_gained_where_it_is_not_claimed(method: Method) -> None:
    phases = [(theta, omega) for theta in (-2.0, 0.0, 1.0, 3.0) for omega in (-4.0, 0.0, 3.0)]
    kept = all(abs(jacobian(method, Pendulum(W0_SQUARED), *phase, 0.05).determinant - 1) < 1e-12 for phase in phases)
    assert kept == method.symplectic


@given(theta=st.floats(-4, 4), omega=st.floats(-8, 8), h=st.floats(-0.5, 0.5))
def test_explicit_euler_blows_area_up_by_h2_w02_cos_theta(theta: float, omega: float, h: float) -> None:
    determinant = jacobian(EXPLICIT_EULER, Pendulum(W0_SQUARED), theta, omega, h).determinant
    assert determinant == pytest.approx(1 + h**2 * W0_SQUARED * math.cos(theta), abs=1e-14)


def test_rk4_loses_area_with_the_sixth_power_of_h() -> None:
    """det - 1 of a step at the bottom is -z⁶/72 + z⁸/576; along a swing the power is the same."""
    exact = Scene().exact()
    lost = []
    for h in (0.02, 0.04):
        states = [exact.at(k * 0.1) for k in range(22)]  # a period
        logs = [math.log(jacobian(RK4, Pendulum(W0_SQUARED), *state, h).determinant) for state in states]
        lost.append(sum(logs))
    assert all(loss < 0 for loss in lost)
    assert math.log2(lost[1] / lost[0]) == pytest.approx(6, abs=0.1)  # z⁸ is 0.4 % of z⁶


@each_method
@pytest.mark.parametrize("start", [(2.0, 0.3), (0.5, 2.0), (0.3, 8.0)])
def test_there_and_back_it_meets_its_start_where_claimed(method: Method, start: Phase) -> None:
    miss = measure.out_and_back(method.phases, start, 0.05, 200)  # 10 s
    # Rounding returns as 1e-13; the best of the others is RK4, which misses by more than 1e-6.
    assert (miss < 1e-12) == method.reversible
    assert method.reversible or miss > 1e-6


@each_method
@given(theta=st.floats(-3, 3), omega=st.floats(-6, 6))
def test_a_negative_step_undoes_a_step_only_where_reversible(method: Method, theta: float, omega: float) -> None:
    """Time reversed by h -> -h, as the lab does it; all four methods keep the symmetry omega, h -> -omega, -h."""
    force = acceleration(W0_SQUARED)
    back = method.step(force, method.step(force, (theta, omega), 0.05), -0.05)
    if method.reversible:
        assert back == pytest.approx((theta, omega), abs=1e-14)  # rounding of one step
    turned = method.step(force, (theta, -omega), 0.05)
    assert method.step(force, (theta, omega), -0.05) == (turned[0], -turned[1])


@each_method
def test_on_the_linear_oscillator_it_is_stable_up_to_the_claimed_limit(method: Method) -> None:
    def amplitude(z: float) -> float:
        theta, omega = travel(method, lambda theta: -theta, (1.0, 0.0), z, 20_000)
        return math.hypot(theta, omega)

    # Just below the limit the ellipse of a symplectic method is 32 times as long as wide; just above, BM6 grows by
    # 0.04 % a step, BM4 by 0.12 %, the next, RK4, by 0.07 %; from 1.0003 times its limit on BM6 is stable again.
    if method.linear_limit:
        assert amplitude(method.linear_limit * 0.999) < 100
    assert amplitude(method.linear_limit * 1.0001 or 0.1) > 1e3


@each_method
def test_one_definition_serves_floats_arrays_complex_and_mpmath(method: Method) -> None:
    start, h = (0.8, -1.1), 0.05
    expected = travel(method, acceleration(W0_SQUARED), start, h, 20)
    arrays = travel(method, acceleration(W0_SQUARED, np.sin), (np.full(3, start[0]), np.full(3, start[1])), h, 20)
    complexes = travel(method, acceleration(W0_SQUARED, cmath.sin), (complex(start[0]), complex(start[1])), h, 20)
    exact = travel(method, acceleration(mp.mpf(W0_SQUARED), mp.sin), tuple(map(mp.mpf, start)), mp.mpf(h), 20)
    for other in ([float(values[0]) for values in arrays], complexes, [float(value) for value in exact]):
        assert other == pytest.approx(expected, abs=1e-13)  # 20 steps' rounding; their sines may differ in the last bit


def test_names_are_unique_and_every_method_says_where_it_comes_from() -> None:
    for field in ("key", "label", "letter", "phases", "formula"):
        assert len({getattr(method, field) for method in METHODS}) == len(METHODS)
    for method in METHODS:
        assert re.fullmatch("[a-z]", method.letter)
        assert method.other_names
        assert re.search(r"\(\d{4}\)", method.reference)
        assert method.phases.__doc__


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
def test_where_a_method_is_used_is_said_with_who_says_so_or_not_at_all(method: Method) -> None:
    if method.used is None:
        assert not method.general
    else:
        assert re.fullmatch(r"[^\[\]]+ \[[a-z0-9.-]+\.(io|org|pw|com|ai), [^\[\]]+\]", method.used)
