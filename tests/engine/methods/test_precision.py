"""Verlet in 32 bits, and with compensated sums."""

import math
from fractions import Fraction
from itertools import islice

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import VELOCITY_VERLET
from engine.methods.precision import VERLET_COMPENSATED, VERLET_FLOAT32, Compensated, Float32
from engine.models.pendulum import Pendulum
from engine.run.loops import PlainLoops, count_evaluations
from engine.scenes import Scene

PENDULUM = Pendulum(9.81)
FORCE = PENDULUM.force()
ordinary = st.floats(-1e15, 1e15).filter(lambda x: x == 0 or abs(x) > 1e-15)


@given(a=ordinary, b=ordinary)
def test_a_number_of_32_bits_is_numpys_float32(a, b):
    x, y = np.float32(a), np.float32(b)
    assert Float32(a) == x
    assert Float32(a) + Float32(b) == x + y
    assert Float32(a) * Float32(b) == x * y
    assert isinstance(a * Float32(b), Float32)


def test_a_number_too_large_for_32_bits_raises_overflow_error():
    with pytest.raises(OverflowError):
        Float32(1e39)


@given(increments=st.lists(st.floats(-1, 1), max_size=50))
def test_a_sum_is_rounded_as_its_increments_are_not_as_itself(increments):
    total, exact = Compensated(1e6), Fraction(10**6)
    for increment in increments:
        total, exact = total + increment, exact + Fraction(increment)
    # What an addition rounds off is half a unit in the last place of 1, or of 1e6, kept: no more than 1e-10 itself.
    assert (
        abs(Fraction(float(total)) + Fraction(total.compensation) - exact)
        <= len(increments) * 2.0**-53
    )
    assert abs(total.compensation) <= math.ulp(1e6) / 2


@pytest.mark.parametrize("method", [VERLET_FLOAT32, VERLET_COMPENSATED], ids=lambda m: m.key)
@given(cuts=st.lists(st.integers(1, 40), min_size=1, max_size=6))
def test_however_a_run_is_cut_the_bits_are_the_same(method, cuts):
    def bits(phase):
        return [(float(x), getattr(x, "lost", 0.0)) for x in phase]

    travel, phase = PlainLoops(method, PENDULUM).travel, (2.0, 0.3)
    for n in cuts:
        phase = travel(phase, 0.05, n)
    assert bits(phase) == bits(travel((2.0, 0.3), 0.05, sum(cuts)))


def test_every_phase_of_32_bits_is_a_double_that_32_bits_hold():
    for phase in islice(VERLET_FLOAT32.phases(FORCE, (2.0, 0.3), 0.05), 100):
        assert all(type(x) is float and Float32(x) == x for x in phase)


@pytest.mark.parametrize(
    ("method", "rounding"), [(VERLET_FLOAT32, 1e-4), (VERLET_COMPENSATED, 1e-12)]
)
def test_in_mid_swing_the_kind_of_numbers_does_not_matter(method, rounding):
    """Verlet's own error, 2e-2 after 10 s, hides them."""
    ends = [
        PlainLoops(each, PENDULUM).travel((2.0, 0.0), 0.02, 500)
        for each in (method, VELOCITY_VERLET)
    ]
    assert ends[0] == pytest.approx(ends[1], abs=rounding)
    assert ends[0] != ends[1]


@pytest.mark.parametrize(
    ("method", "returns"), [(VERLET_FLOAT32, 1e-3), (VERLET_COMPENSATED, 1e-13)]
)
def test_there_and_back_it_meets_its_start_only_as_claimed(method, returns):
    travel = PlainLoops(method, PENDULUM).travel
    theta, omega = travel((2.0, 0.3), 0.05, 200)
    theta, omega = travel((theta, -omega), 0.05, 200)
    miss = max(abs(theta - 2.0), abs(-omega - 0.3))
    assert miss < returns
    assert (miss < 1e-12) == method.reversible == method.symplectic


@pytest.mark.parametrize("method", [VERLET_FLOAT32, VERLET_COMPENSATED], ids=lambda m: m.key)
def test_a_run_evaluates_the_force_as_often_as_claimed(method):
    assert count_evaluations(method, PENDULUM, (1.0, 0.5), 0.05, 10) == method.evaluations(10)


def test_a_thousandth_below_the_top_32_bits_lose_the_angle_within_ten_seconds():
    scene = Scene(theta=math.pi - 1e-3, h=2**-6)
    exact, largest = scene.exact(), []
    for method in (VERLET_FLOAT32, VELOCITY_VERLET):
        phases = enumerate(islice(method.phases(FORCE, (scene.theta, 0.0), scene.h), 640), 1)
        largest.append(max(abs(theta - exact.at(n * scene.h).theta) for n, (theta, _) in phases))
    assert largest[0] > 1 > 0.05 > largest[1]  # .039
