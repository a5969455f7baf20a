"""The reference lines: Taylor's series at a ladder of tolerances, and the closed form."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from engine.accuracy import references as module
from engine.accuracy.references import CONFIRMING, FINER, TaylorStudy
from engine.accuracy.taylor import follow
from engine.models.pendulum import energy
from engine.run.compiled import available
from engine.scenes import SCENES, Scene

pytestmark = pytest.mark.skipif(not available(), reason="Numba is not installed")
SWING = Scene(theta=2.0)


@pytest.fixture(scope="module")
def study():
    return TaylorStudy(SWING, 100.0)


def test_the_errors_of_a_point_are_the_largest_of_those_compared(study):
    point = study.run(1e-8, comparisons=1000)
    times = np.linspace(0, 100, 1001)
    states, steps = follow(9.81, 2.0, 0.0, times, 1e-8)
    exact, start = SWING.exact(), energy(9.81, 2.0, 0.0)
    off = [abs(theta - exact.at(float(t)).theta) for t, (theta, _) in zip(times, states, strict=True)]
    assert (point.steps, point.theta_error, point.final_error) == (steps, max(off), off[-1])
    off = [abs(energy(9.81, *map(float, state)) - start) / start for state in states]
    # NumPy's sine is a bit off Python's here and there
    assert point.energy_error == pytest.approx(max(off), abs=1e-15)
    assert point.flaws == (None, None, None)


def test_a_tighter_tolerance_costs_steps_and_buys_accuracy_down_to_rounding(study):
    points = list(study.points())
    for loose, tight in itertools.pairwise(points):
        assert loose.tolerance > tight.tolerance
    assert points[0].flaws.theta == "lost"
    assert points[-1].flaws[:2] == ("rounding", "rounding")
    good = [point for point in points if point.flaws.theta is None and point.theta_error > 1e-11]  # below, some round
    assert len(good) >= 8
    for loose, tight in itertools.pairwise(good):
        assert loose.steps < tight.steps
        assert loose.theta_error > tight.theta_error
    assert good[-1].theta_error < 1e-9


@pytest.mark.parametrize("kind", ["theta", "energy", "final"])
@pytest.mark.parametrize("target", [1e-3, 1e-6, 1e-9, 1e-12])
def test_a_recommended_tolerance_reaches_its_target_and_so_do_finer_ones(study, kind, target):
    point = study.reach(kind, target).point
    for finer in range(CONFIRMING + 1):
        assert study.run(point.tolerance * FINER**-finer, 10_000).error(kind) <= target
    # and it is the loosest: of all that are looser, a few above it do not
    looser = [study.run(point.tolerance * FINER**step, 10_000).error(kind) for step in range(1, CONFIRMING + 2)]
    assert max(looser) > target


def test_a_target_below_rounding_gets_a_reason(study):
    reached = study.reach("theta", 1e-15)
    assert reached.point is None
    assert reached.why_not.startswith("rounding stops it at ")
    assert 1e-14 < float(reached.why_not.split()[-1]) < 1e-11


def test_a_loose_target_is_met_by_the_loosest_tolerance():
    study = TaylorStudy(SCENES["gentle"], 1.0)
    assert study.reach("theta", 1.0).point.steps == 1


def test_a_tolerance_that_takes_too_many_steps_is_given_up(monkeypatch):
    monkeypatch.setattr("engine.accuracy.taylor.MOST_STEPS", 300)
    monkeypatch.setattr(module, "MOST_STEPS", 300)
    study = TaylorStudy(SWING, 100.0)
    assert [point.steps < 300 for point in study.points()] == [True] * 5
    assert study.reach("theta", 1e-9) == (module.Reached(None, "more than 300 steps"))


def test_seconds_are_the_shortest_of_several_runs_with_their_spread(study):
    ticks = itertools.chain.from_iterable((0.0, length) for length in (50.0, 30.0, 40.0, 60.0, 35.0))
    point = study.run(1e-8)
    runs = 20_000 // point.steps
    assert study.timed(point, lambda: next(ticks)) == replace(point, seconds=30.0 / runs, spread=1.0)
    assert next(ticks, None) is None


@pytest.mark.parametrize("name", [name for name, scene in SCENES.items() if scene.model == "pendulum"])
def test_every_scene_has_a_line_down_to_rounding(name):
    scene = SCENES[name]
    points = list(TaylorStudy(scene, 20 / scene.w0).points())
    assert len(points) == module.RUNGS
    assert all(math.isfinite(point.error(kind)) for point in points for kind in ("theta", "energy", "final"))
    assert "rounding" in {point.flaws.energy for point in points}
