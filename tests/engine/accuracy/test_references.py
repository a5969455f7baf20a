"""The reference lines: Taylor's series at a ladder of tolerances, and the closed form."""

import itertools
import time

import numpy as np
import pytest

from pendu_tui.engine.accuracy.references import references, taylor_points
from pendu_tui.engine.models.exact_pendulum import exact_pendulum
from pendu_tui.engine.run.compiled import available
from pendu_tui.engine.scenes import Scene

pytestmark = pytest.mark.skipif(not available(), reason="Numba is not installed")
SWING = Scene(theta=2.0)
REGIMES = {
    "libration": SWING,
    "rotation": Scene(theta=0.5, omega=-8.0),
    "separatrix": Scene(theta=0.0, omega=2.0, gravity=1.0),
    "equilibrium": Scene(theta=0.0),
}


@pytest.mark.slow
def test_tighter_tolerances_take_more_steps_down_to_rounding():
    points = list(taylor_points(SWING, 100.0, time.perf_counter))
    assert len(points) == 17
    assert points[0].flaws.theta == "lost"
    for kind in ("theta", "energy"):
        assert "rounding" in {point.flaw(kind) for point in points[-3:]}
    good = [point for point in points if point.flaws.theta is None]
    assert len(good) >= 8
    assert all(loose.steps < tight.steps for loose, tight in itertools.pairwise(good))
    assert good[-1].theta_error < 1e-9


@pytest.mark.parametrize("regime", REGIMES)
def test_the_compiled_closed_form_differs_in_the_last_digit_at_most(regime):
    import numba

    scene, times = REGIMES[regime], np.linspace(0, 20, 401).tolist()
    plain = scene.exact()
    fast = exact_pendulum(scene.w0_squared, scene.theta, scene.omega, compile=numba.njit)
    assert fast.regime == plain.regime == regime
    found, expected = (np.array([exact.at(t) for t in times]) for exact in (fast, plain))
    assert np.abs(found - expected).max() <= 1e-15 * np.abs(expected).max()


def test_seconds_are_the_shortest_by_the_clock():
    ticks = itertools.chain.from_iterable((0.0, n) for n in (50.0, 30.0, 40.0, 60.0, 35.0))
    found = references(Scene(model="linear"), 100.0, lambda: next(ticks), fast=True)
    assert found.closed_form == 30.0 / 20
    assert next(ticks, None) is None
