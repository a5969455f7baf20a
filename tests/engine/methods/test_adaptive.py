"""Step doubling: what controlling the step does to the energy."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import VELOCITY_VERLET
from engine.methods.adaptive import HALVING_RICHARDSON, HALVING_VERLET, MOST_HALVINGS, halving
from engine.methods.verlet import velocity_verlet
from engine.models.pendulum import Pendulum
from engine.run.loops import PlainLoops, count_evaluations
from engine.scenes import SCENES, Scene

PENDULUM = Pendulum(9.81)
FORCE = PENDULUM.force()
SCENE = SCENES["halving"]
both = pytest.mark.parametrize("method", [HALVING_VERLET, HALVING_RICHARDSON], ids=lambda m: m.key)


def energy_error(method, h, time):
    """The relative energy error at the end, and its largest size on the way."""
    energy, start = PENDULUM.energy(), (2.0, 0.0)
    _, _, end, low, high = PlainLoops(method, PENDULUM).advance(start, h, round(time / h), math.inf)
    first = energy(start)
    return end / first - 1, max(high / first - 1, 1 - low / first)


@both
def test_with_small_steps_it_has_the_claimed_order(method):
    exact, errors, steps = Scene(theta=1.0).exact(), [], (80, 113, 160, 226, 320)
    for n in steps:
        theta, _ = PlainLoops(method, PENDULUM).travel((1.0, 0.0), 1.0 / n, n)
        errors.append(abs(theta - exact.at(1.0).theta))
    assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(method.order, abs=0.1)


@both
def test_a_step_costs_about_the_claimed_evaluations_and_six_if_it_is_not_divided(method):
    counted = count_evaluations(
        method, PENDULUM, (SCENE.theta, SCENE.omega), SCENE.h, 300
    )  # a minute
    assert counted / 300 == pytest.approx(method.force_evaluations, abs=0.5)
    assert method.varies
    assert count_evaluations(method, PENDULUM, (0.1, 0.0), 0.05, 10) == 60


def test_a_step_that_looks_accurate_is_two_halves_and_any_other_two_steps_of_half_the_length():
    phases = halving(velocity_verlet, 0.1)
    small = next(phases(FORCE, (2.0, 0.0), 0.05))
    assert small == PlainLoops(VELOCITY_VERLET, PENDULUM).travel((2.0, 0.0), 0.025, 2)
    divided = next(phases(FORCE, (2.0, -5.0), 0.4))
    halved = next(phases(FORCE, next(phases(FORCE, (2.0, -5.0), 0.2)), 0.2))
    assert divided == halved


@both
@given(theta=st.floats(-1e9, 1e9), omega=st.floats(-1e9, 1e9), h=st.floats(-100, 100))
def test_where_nothing_looks_accurate_a_step_still_ends(method, theta, omega, h):
    count = 0

    def counted(theta):
        nonlocal count
        count += 1
        return FORCE(theta)

    assert all(map(math.isfinite, method.step(counted, (theta, omega), h)))
    assert count <= 6 * (2 ** (MOST_HALVINGS + 1) - 1)


@both
def test_nothing_is_kept_from_step_to_step(method):
    travel = PlainLoops(method, PENDULUM).travel
    assert travel(travel((2.0, 0.0), 0.2, 7), 0.2, 5) == travel((2.0, 0.0), 0.2, 12)


@both
def test_there_and_back_it_misses_its_start(method):
    travel = PlainLoops(method, PENDULUM).travel
    theta, omega = travel((2.0, 0.3), 0.2, 50)
    theta, omega = travel((theta, -omega), 0.2, 50)
    assert max(abs(theta - 2.0), abs(-omega - 0.3)) > 1e-3
    assert not method.reversible
    assert not method.symplectic


def test_in_ten_minutes_it_changes_the_energy_and_verlet_at_the_same_cost_does_not():
    assert energy_error(HALVING_VERLET, 0.2, 600)[0] > 0.1  # +0.88
    assert energy_error(HALVING_RICHARDSON, 0.2, 600)[0] < -0.1  # -0.48
    assert energy_error(VELOCITY_VERLET, 1 / 40, 600)[1] < 0.003  # 0.0012
    fixed = VELOCITY_VERLET.evaluations(24_000)
    assert count_evaluations(HALVING_VERLET, PENDULUM, (2.0, 0.0), 0.2, 3000) > fixed
