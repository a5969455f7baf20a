"""Taylor's series follows the exact motion, and its energy does not drift."""

import math
from itertools import islice
from statistics import fmean

import pytest

from pendu_tui.engine.methods import TAYLOR_20
from pendu_tui.engine.run.loops import PlainLoops, available, compiled
from pendu_tui.engine.scenes import Scene

SWING = Scene(theta=2.0)


def theta_error(scene, time, steps):
    """The largest error in theta [rad]."""
    exact = scene.exact()
    phases = TAYLOR_20.on(scene.equations)((scene.theta, scene.omega), time / steps)
    states = enumerate(islice(phases, steps), 1)
    return max(abs(theta - exact.at(n * time / steps).theta) for n, (theta, _) in states)


@pytest.mark.parametrize(
    ("scene", "steps", "most"),
    [  # measured 2.6e-7, 2.7e-14; 6.3e-13; 2.6e-8
        (SWING, 80, 1e-6),
        (SWING, 200, 1e-12),
        (Scene(theta=0.0, omega=8.0), 400, 1e-12),
        (Scene(theta=math.radians(179.9)), 200, 1e-6),  # as its last digit allows
    ],
)
def test_a_swing_of_20_s_takes_few_steps(scene, steps, most):
    assert most / 1e5 < theta_error(scene, 20.0, steps) < most


def test_the_error_falls_with_the_twentieth_power_of_the_step():
    coarse = theta_error(SWING, 10.0, 50)
    fine = theta_error(SWING, 10.0, 80)
    assert math.log(coarse / fine) / math.log(80 / 50) == pytest.approx(20, abs=2)


def test_the_energy_walks_at_random_and_does_not_drift():
    ends = []
    for n in range(20):
        start = (0.2 + 0.14 * n, 0.3 * (n % 3))
        model = SWING.equations
        energy = model.energy()
        end = PlainLoops(TAYLOR_20, model).propagate(start, 0.1, 2000)
        ends.append(energy(end) / energy(start) - 1)
        assert abs(ends[-1]) < 4e-14  # 2000 steps: four times the 1e-14 of one rounding a step
    # a drift would have one sign; of twenty random walks the mean is 0.22 rms, give or take
    assert abs(fmean(ends)) < 0.5 * math.sqrt(fmean(end * end for end in ends))


@pytest.mark.skipif(not available(), reason="Numba is not installed")
def test_compiled_it_has_the_same_bits():
    model = SWING.equations
    ends = [
        loops(TAYLOR_20, model).propagate((2.0, 0.5), 0.1, 100) for loops in (compiled, PlainLoops)
    ]
    assert ends[0] == ends[1]
