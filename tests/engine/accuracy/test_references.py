"""The reference lines: Taylor's series at a ladder of tolerances, and the closed form."""

import itertools
import math
import time

import numpy as np
import pytest

from engine.accuracy.references import references, taylor_points
from engine.models.exact_pendulum import exact_pendulum
from engine.run.compiled import available
from engine.scenes import SCENES, Scene

pytestmark = pytest.mark.skipif(not available(), reason="Numba is not installed")
SWING = Scene(theta=2.0)
REGIMES = {
    "libration": SWING,
    "rotation": Scene(theta=0.5, omega=-8.0),
    "separatrix": Scene(theta=0.0, omega=2.0, gravity=1.0),
    "equilibrium": Scene(theta=0.0),
}


@pytest.fixture(scope="module")
def points():
    return list(taylor_points(SWING, 100.0, time.perf_counter))


def test_a_tighter_tolerance_costs_steps_and_buys_accuracy_down_to_rounding(points):
    assert len(points) == 17
    assert points[0].flaws.theta == "lost"
    assert all(
        "rounding" in {point.flaw(kind) for point in points[-3:]} for kind in ("theta", "energy")
    )
    good = [point for point in points if point.flaws.theta is None]
    assert len(good) >= 8
    for loose, tight in itertools.pairwise(good):
        assert loose.steps < tight.steps
    assert good[-1].theta_error < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [name for name, scene in SCENES.items() if scene.model == "pendulum"]
)
def test_every_scene_has_a_line_down_to_rounding(name):
    scene = SCENES[name]
    points = list(taylor_points(scene, 20 / scene.w0, itertools.count().__next__))
    assert all(
        math.isfinite(point.error(kind))
        for point in points
        for kind in ("theta", "energy", "final")
    )
    assert "rounding" in {point.flaws.energy for point in points}


@pytest.mark.parametrize("regime", REGIMES)
def test_the_compiled_closed_form_is_that_of_plain_python_but_for_the_last_digit(regime):
    import numba

    scene = REGIMES[regime]
    plain = scene.exact()
    fast = exact_pendulum(scene.w0_squared, scene.theta, scene.omega, compile=numba.njit)
    assert fast.regime == plain.regime == regime
    times = [20 * n / 400 for n in range(401)]
    expected = np.array([plain.at(t) for t in times])
    assert np.max(np.abs([fast.at(t) for t in times] - expected)) <= 1e-15 * np.max(
        np.abs(expected)
    )


def test_seconds_are_the_shortest_by_the_clock():
    ticks = itertools.chain.from_iterable(
        (0.0, length) for length in (50.0, 30.0, 40.0, 60.0, 35.0)
    )
    assert (
        references(Scene(model="linear"), 100.0, lambda: next(ticks), fast=True).closed_form
        == 30.0 / 20
    )
    assert next(ticks, None) is None
