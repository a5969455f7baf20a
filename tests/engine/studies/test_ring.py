"""The change of area along a run, and a ring of neighbours that follows a run."""

import math

import numpy as np
import pytest

from pendu_tui.engine.run.rewindable import RewindableRun
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Scene
from pendu_tui.engine.studies.ring import Neighbourhood

DRIFT = SCENES["drift"]
pytestmark = pytest.mark.timeout(20)  # a ring that cannot follow would try for ever


def test_area_is_counted_also_where_a_step_turns_it_over():
    scene = Scene(theta=3.0, h=1.5 / Scene().w0)
    neighbourhood = Neighbourhood(scene, radius=0.05)
    neighbourhood.advance(1, Stepping(scene.h))
    assert neighbourhood.area_ratios[0] == pytest.approx(-1 - 1.5**2 * math.cos(3.0))


def shoelace(ring):
    theta, omega = ring
    return abs(float(np.sum(theta * np.roll(omega, -1) - omega * np.roll(theta, -1)))) / 2


def test_a_small_ring_encloses_the_area_of_the_jacobians():
    neighbourhood = Neighbourhood(DRIFT, radius=1e-4)
    before = [shoelace(ring) for ring in neighbourhood.rings]
    neighbourhood.advance(40, Stepping(DRIFT.h))
    found = np.divide([shoelace(ring) for ring in neighbourhood.rings], before)
    # a ring of radius 1e-4 bends by its square, and cancellation in the shoelace costs as much
    assert found == pytest.approx(neighbourhood.area_ratios, rel=1e-6)


@pytest.mark.filterwarnings("error")
def test_a_method_that_overflows_keeps_its_last_ring():
    neighbourhood = Neighbourhood(Scene(theta=1.0, omega=1e9, h=15.0), radius=1e308 / 1e3)
    neighbourhood.advance(500, Stepping(15.0))
    rings = np.array(neighbourhood.rings)
    assert np.isfinite(rings).all()
    neighbourhood.advance(1, Stepping(1e-9))  # which would be a finite step again
    assert np.array_equal(neighbourhood.rings, rings)
    for log_area, ratio in ((700, np.exp(700)), (710, np.inf)):
        neighbourhood._carried[0].log_area = log_area
        assert neighbourhood.area_ratios[0] == pytest.approx(ratio)


def followed(ring, run, most=10_000):
    return ring.following(run.step, run.changes, most)


def has_taken(ring, *stretches):
    """Whether a ring is one that has taken so many steps of each h."""
    expected = Neighbourhood(DRIFT, 0.1)
    for steps, h in stretches:
        expected.advance(steps, Stepping(h))
    return np.array_equal(ring.rings, expected.rings)


def test_neighbours_take_the_steps_of_the_run_whenever_they_follow():
    run, early = RewindableRun(DRIFT, 1), Neighbourhood(DRIFT, 0.1)
    for steps, h in ((7, 0.02), (5, -0.02)):
        run.forward(steps)
        assert followed(early, run) is early
        run.change(Stepping(h))  # counts for the next step
        assert followed(early, run) is early
    run.forward(3)
    for ring in (early, Neighbourhood(DRIFT, 0.1)):
        assert has_taken(followed(ring, run), (7, 0.05), (5, 0.02), (3, -0.02))


def test_neighbours_follow_so_many_steps_at_once_and_in_each_methods_own():
    run, ring = RewindableRun(DRIFT, 1), Neighbourhood(DRIFT, 0.1)
    run.change(Stepping(0.2, True, DRIFT.cast))
    run.forward(12)
    for step in (5, 10, 12):
        assert followed(ring, run, most=5).step == step
    own = [Neighbourhood(DRIFT, 0.1) for _ in range(2)]
    for alone, steps, h in zip(own, (48, 12), (0.05, 0.2), strict=True):
        alone.advance(steps, Stepping(h))
    assert np.array_equal(ring.rings, [*own[0].rings[:3], own[1].rings[3]])


def test_they_go_back_with_their_run_and_are_of_no_other():
    run = RewindableRun(DRIFT, 2)
    run.forward(20)
    ring = followed(Neighbourhood(DRIFT, 0.1, 2), run)
    run.go_to(15)
    ring = followed(ring, run)
    assert has_taken(ring, (15, 0.05))
    assert ring.is_of(DRIFT, 2)
    assert not ring.is_of(DRIFT, 1)
    assert not ring.is_of(SCENES["gentle"], 2)


def test_a_ring_is_as_wide_in_theta_as_in_omega_over_w0():
    (theta, omega), *_ = Neighbourhood(DRIFT, 0.05).rings
    assert len(np.unique(theta.round(12))) == 33  # of 64 points: above and below, and two ends
    assert np.ptp(theta) == pytest.approx(2 * 0.05)
    assert np.ptp(omega) == pytest.approx(2 * 0.05 * DRIFT.w0)
