"""Taylor's series follows the exact motion to its tolerance, and its energy does not drift."""

import math
from statistics import fmean

import numpy as np
import pytest

from pendu_tui.engine.run.compiled import available
from pendu_tui.engine.scenes import Scene

pytestmark = pytest.mark.skipif(not available(), reason="Numba is not installed")
if available():
    from pendu_tui.engine.accuracy.taylor import solve
SWING = Scene(theta=2.0)


def errors(scene, time, tolerance, comparisons=400):
    """The largest error in theta [rad], the relative one in energy at the end, and the steps."""
    times = np.linspace(0, time, comparisons + 1)
    states, steps = solve(scene.w0_squared, scene.theta, scene.omega, times, tolerance)
    exact = scene.exact()
    start, end = map(scene.equations.energy(), states[[0, -1]].tolist())
    off = max(
        abs(theta - exact.at(float(t)).theta) for t, (theta, _) in zip(times, states, strict=True)
    )
    return off, (end - start) / start, steps


@pytest.mark.parametrize(
    ("scene", "tolerance", "most", "steps"),
    [  # measured 2.7e-4, 3.5e-7, 1.9e-10; 2.7e-10; 2e-13; 3.9e-6, 1.3e-8
        (SWING, 1e-6, 1e-3, 343),
        (SWING, 3.2e-9, 1e-6, 465),
        (SWING, 1.8e-12, 1e-9, 684),
        (Scene(theta=0.0, omega=8.0), 1e-12, 1e-9, 898),
        (Scene(theta=math.radians(179.9)), 1e-12, 1e-5, 400),
        # as close as the start's last digit allows
        (Scene(theta=math.radians(179.9)), 1e-16, 1e-7, 650),
    ],
)
def test_over_100_s_a_tolerance_buys_its_error_for_few_steps(scene, tolerance, most, steps):
    theta_error, _, taken = errors(scene, 100.0, tolerance)
    assert most / 1000 < theta_error < most
    assert taken == pytest.approx(steps, rel=0.1)


def test_the_energy_walks_at_random_and_does_not_drift():
    ends = []
    for n in range(20):
        theta, omega = 0.2 + 0.14 * n, 0.3 * (n % 3)
        _, energy_error, steps = errors(Scene(theta=theta, omega=omega), 1e4, 1e-16, comparisons=1)
        assert abs(energy_error) < 2e-13  # 6e4 steps: four times the 5e-14 of one rounding a step
        assert steps > 5e4
        ends.append(energy_error)
    # a drift would have one sign; of twenty random walks the mean is 0.22 rms, give or take
    assert abs(fmean(ends)) < 0.5 * math.sqrt(fmean(end * end for end in ends))


def test_the_phase_stays_with_the_exact_one_for_a_million_steps():
    assert errors(SWING, 1e3, 1e-16)[0] < 5e-10
    # time summed without compensation: 7e-7, as much of t is lost in every step
    assert errors(SWING, 1e5, 1e-16)[0] < 5e-8


def test_times_asked_for_in_between_do_not_change_the_steps():
    parameters = SWING.w0_squared, SWING.theta, SWING.omega
    coarse, steps = solve(*parameters, np.array([10.0]), 1e-9)
    fine, same_steps = solve(*parameters, np.linspace(0, 10, 10_001), 1e-9)
    assert steps == same_steps
    assert np.array_equal(coarse[-1], fine[-1])
    assert tuple(fine[0]) == (SWING.theta, SWING.omega)


def test_a_pendulum_at_rest_stays_at_rest_in_one_step():
    states, steps = solve(9.81, 0.0, 0.0, np.linspace(0, 100, 11), 1e-12)
    assert steps == 1
    assert not states.any()
