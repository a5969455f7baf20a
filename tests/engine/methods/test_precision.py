"""Verlet in 32 bits, and with compensated sums."""

import math
from fractions import Fraction
from itertools import islice

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import VELOCITY_VERLET, Method
from engine.methods.precision import VERLET_COMPENSATED, VERLET_FLOAT32, Kept, Single
from engine.models.model import Phase
from engine.models.pendulum import Pendulum
from engine.run.loops import plain
from engine.scenes import Scene

PENDULUM = Pendulum(9.81)
FORCE = PENDULUM.force()
ordinary = st.floats(-1e15, 1e15).filter(lambda x: x == 0 or abs(x) > 1e-15)


def worst_and_late(method: Method, below_top: float, h: float, angle: float = 0.1) -> tuple[float, float]:
    """The largest error in theta over 100 s from this far below the top [rad], and when it passes an angle [s]."""
    scene = Scene(theta=math.pi - below_top, h=h)
    exact, worst, late = scene.exact(), 0.0, math.inf
    phases = method.phases(FORCE, (scene.theta, 0.0), h)
    for step, (theta, _) in enumerate(islice(phases, round(100 / h)), 1):
        if step % 8 == 0:  # the closed form takes longer than a step
            worst = max(worst, abs(theta - exact.at(step * h).theta))
            if worst > angle and late == math.inf:
                late = step * h
    return worst, late


@given(a=ordinary, b=ordinary)
def test_a_number_of_32_bits_is_what_numpy_calls_one(a: float, b: float) -> None:
    x, y = np.float32(a), np.float32(b)
    assert Single(a) == x
    assert Single(a) + Single(b) == x + y
    assert Single(a) * Single(b) == x * y
    assert isinstance(a * Single(b), Single)


def test_beyond_what_32_bits_hold_it_says_so_as_python_does() -> None:
    with pytest.raises(OverflowError):
        Single(1e39)


@given(increments=st.lists(st.floats(-1, 1), max_size=50))
def test_a_sum_is_rounded_as_its_increments_are_not_as_itself(increments: list[float]) -> None:
    total, exact = Kept(1e6), Fraction(10**6)
    for increment in increments:
        total, exact = total + increment, exact + Fraction(increment)
    # What an addition rounds off is half a unit in the last place of 1, or of 1e6, kept: no more than 1e-10 itself.
    assert abs(Fraction(float(total)) + Fraction(total.lost) - exact) <= len(increments) * 2.0**-53
    assert abs(total.lost) <= math.ulp(1e6) / 2


@pytest.mark.parametrize("method", [VERLET_FLOAT32, VERLET_COMPENSATED], ids=lambda m: m.key)
@given(cuts=st.lists(st.integers(1, 40), min_size=1, max_size=6))
def test_however_a_run_is_cut_the_bits_are_the_same(method: Method, cuts: list[int]) -> None:
    def bits(phase: Phase) -> list[tuple[float, float]]:
        return [(float(x), getattr(x, "lost", 0.0)) for x in phase]

    travel, phase = plain(method, PENDULUM).travel, (2.0, 0.3)
    for n in cuts:
        phase = travel(phase, 0.05, n)
    assert bits(phase) == bits(travel((2.0, 0.3), 0.05, sum(cuts)))


def test_every_phase_of_32_bits_is_a_double_that_32_bits_hold() -> None:
    for phase in islice(VERLET_FLOAT32.phases(FORCE, (2.0, 0.3), 0.05), 100):
        assert all(type(x) is float and Single(x) == x for x in phase)


@pytest.mark.parametrize(("method", "rounding"), [(VERLET_FLOAT32, 1e-4), (VERLET_COMPENSATED, 1e-12)])
def test_in_mid_swing_the_numbers_do_not_matter(method: Method, rounding: float) -> None:
    """Verlet's own error, 2e-2 after 10 s, hides them."""
    ends = [plain(each, PENDULUM).travel((2.0, 0.0), 0.02, 500) for each in (method, VELOCITY_VERLET)]
    assert ends[0] == pytest.approx(ends[1], abs=rounding)
    assert ends[0] != ends[1]


@pytest.mark.parametrize(("method", "returns"), [(VERLET_FLOAT32, 1e-3), (VERLET_COMPENSATED, 1e-13)])
def test_there_and_back_only_as_claimed(method: Method, returns: float) -> None:
    travel = plain(method, PENDULUM).travel
    theta, omega = travel((2.0, 0.3), 0.05, 200)
    theta, omega = travel((theta, -omega), 0.05, 200)
    miss = max(abs(theta - 2.0), abs(-omega - 0.3))
    assert miss < returns
    assert (miss < 1e-12) == method.reversible == method.symplectic


def test_a_force_is_evaluated_as_often_as_claimed() -> None:
    for method in (VERLET_FLOAT32, VERLET_COMPENSATED):
        count = 0

        def counted(theta: float) -> float:
            nonlocal count
            count += 1
            return FORCE(theta)  # type: ignore[no-any-return]

        next(islice(method.phases(counted, (1.0, 0.5), 0.05), 9, None))
        assert count == method.evaluations(10)


def test_a_millionth_below_the_top_doubles_lose_the_angle_and_compensated_sums_keep_it() -> None:
    assert worst_and_late(VERLET_COMPENSATED, 1e-6, 2**-10)[0] < 1e-3  # 2.2e-4
    worst, late = worst_and_late(VELOCITY_VERLET, 1e-6, 2**-10)
    assert worst > 0.1  # 0.82
    assert late == pytest.approx(35.1, abs=0.5)


@pytest.mark.parametrize("h", [2**-6, 2**-10])
def test_a_thousandth_below_the_top_32_bits_lose_the_angle_within_ten_seconds(h: float) -> None:
    assert worst_and_late(VERLET_FLOAT32, 1e-3, h, angle=1.0)[1] < 10  # 8.1 and 7.6 s
    assert worst_and_late(VELOCITY_VERLET, 1e-3, h)[0] < (0.05 if h == 2**-6 else 1e-3)  # .039 and 1.5e-4
