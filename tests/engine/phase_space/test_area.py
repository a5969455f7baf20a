"""Area kept and lost along a run, and a ring of neighbours that keeps up with one."""

import math

import numpy as np
import pytest

from engine.methods import USUAL_CAST
from engine.models.pendulum import acceleration
from engine.phase_space.area import Neighbourhood, Neighbours
from engine.run.rewindable import RewindableRun
from engine.run.stepping import Stepping
from engine.scenes import SCENES, Scene

DRIFT = SCENES["drift"]
INDEX = {method.key: i for i, method in enumerate(USUAL_CAST)}


@pytest.fixture(scope="module")
def after_ten_thousand_steps():
    neighbourhood = Neighbourhood(DRIFT, radius=0.05)
    neighbourhood.advance(10_000, Stepping(DRIFT.h))
    return dict(zip(INDEX, neighbourhood.area_ratios, strict=True))


@pytest.mark.parametrize("method", [m for m in USUAL_CAST if m.symplectic], ids=lambda m: m.key)
def test_a_symplectic_method_keeps_area_over_ten_thousand_steps(method, after_ten_thousand_steps):
    # each step rounds its determinant by about 1e-16, and the roundings add up like a walk or worse
    assert after_ten_thousand_steps[method.key] == pytest.approx(1.0, abs=1e-12)


def test_rk4_loses_area_very_slowly(after_ten_thousand_steps):
    assert 0.99 < after_ten_thousand_steps["rk4"] < 0.9999


def test_explicit_euler_gains_area_while_it_swings():
    neighbourhood = Neighbourhood(DRIFT, radius=0.05)
    neighbourhood.advance(100, Stepping(DRIFT.h))
    assert neighbourhood.area_ratios[INDEX["explicit_euler"]] > 2


def shoelace(ring):
    theta, omega = ring
    return abs(float(np.sum(theta * np.roll(omega, -1) - omega * np.roll(theta, -1)))) / 2


@pytest.mark.parametrize("method", USUAL_CAST, ids=lambda m: m.key)
def test_a_small_ring_encloses_the_area_of_the_jacobians(method):
    neighbourhood = Neighbourhood(DRIFT, radius=1e-4)
    before = shoelace(neighbourhood.rings[INDEX[method.key]])
    neighbourhood.advance(40, Stepping(DRIFT.h))
    after = shoelace(neighbourhood.rings[INDEX[method.key]])
    # a ring of radius 1e-4 bends by its square, and cancellation in the shoelace costs as much
    assert after / before == pytest.approx(neighbourhood.area_ratios[INDEX[method.key]], rel=1e-6)


def test_the_ring_is_carried_by_the_very_step_of_the_method():
    neighbourhood = Neighbourhood(Scene(theta=0.5), radius=0.1, points=8)
    start = neighbourhood.rings[0]
    neighbourhood.advance(3, Stepping(0.05))
    for method, ring in zip(USUAL_CAST, neighbourhood.rings, strict=True):
        for i in range(8):
            phase = (float(start[0][i]), float(start[1][i]))
            for _ in range(3):
                phase = method.step(acceleration(9.81), phase, 0.05)
            # NumPy's sine and the C library's may differ in the last place
            assert (ring[0][i], ring[1][i]) == pytest.approx(phase, rel=1e-14, abs=1e-14)


def test_running_back_undoes_the_area_of_the_reversible_method():
    neighbourhood = Neighbourhood(DRIFT, radius=0.05)
    neighbourhood.advance(50, Stepping(0.05))
    neighbourhood.advance(50, Stepping(-0.05))
    assert neighbourhood.area_ratios[INDEX["velocity_verlet"]] == pytest.approx(
        1.0, abs=1e-13
    )  # rounding
    assert math.log(neighbourhood.area_ratios[INDEX["explicit_euler"]]) > 0.1


def test_a_method_that_overflows_keeps_its_last_ring():
    neighbourhood = Neighbourhood(Scene(theta=1.0, omega=1e9, h=15.0), radius=1e308 / 1e3)
    neighbourhood.advance(500, Stepping(15.0))
    assert all(np.isfinite(ring).all() for ring in neighbourhood.rings)


def rings(neighbours, run, most=10_000):
    return np.array(neighbours.follow(run.scene, run.run, run.step, run.changes, most).rings)


def expected(*stretches, scene=DRIFT):
    ring = Neighbourhood(scene, 0.1)
    for steps, h in stretches:
        ring.advance(steps, Stepping(h))
    return np.array(ring.rings)


def test_neighbours_take_the_steps_of_the_run_changes_of_h_included():
    run = RewindableRun(DRIFT, 1)
    for steps, h in ((7, 0.02), (5, -0.02)):
        run.forward(steps)
        run.set_stepping(Stepping(h))
    run.forward(3)
    assert np.array_equal(rings(Neighbours(0.1), run), expected((7, 0.05), (5, 0.02), (3, -0.02)))


def test_the_ring_does_not_depend_on_when_or_how_often_it_was_followed():
    run, early = RewindableRun(DRIFT, 1), Neighbours(0.1)
    for _ in range(10):
        run.forward(3)
        rings(early, run)
    assert np.array_equal(rings(early, run), rings(Neighbours(0.1), run))


def test_they_take_at_most_the_given_steps_at_a_time():
    run, neighbours = RewindableRun(DRIFT, 1), Neighbours(0.1)
    run.forward(250)
    for step in (100, 200, 250):
        rings(neighbours, run, most=100)
        assert neighbours.step == step
    assert np.array_equal(rings(neighbours, run), expected((250, 0.05)))


def test_they_go_back_with_the_run_and_begin_again_with_another():
    run, neighbours = RewindableRun(DRIFT, 1), Neighbours(0.1)
    run.forward(20)
    rings(neighbours, run)
    run.back_to(15)
    assert np.array_equal(rings(neighbours, run), expected((15, 0.05)))
    run.branch(2)  # a run of its own, that shares the first 15 steps
    run.set_stepping(Stepping(0.1))
    run.forward(2)
    assert np.array_equal(rings(neighbours, run), expected((15, 0.05), (2, 0.1)))
    gentle = RewindableRun(SCENES["gentle"], 3)
    gentle.forward(4)
    assert np.array_equal(
        rings(neighbours, gentle), expected((4, gentle.scene.h), scene=gentle.scene)
    )


def test_a_change_of_h_just_after_the_last_step_counts_for_the_next_one():
    run, neighbours = RewindableRun(DRIFT, 1), Neighbours(0.1)
    run.forward(5)
    rings(neighbours, run)
    run.set_stepping(Stepping(0.01))
    rings(neighbours, run)
    run.forward(1)
    assert np.array_equal(rings(neighbours, run), expected((5, 0.05), (1, 0.01)))
