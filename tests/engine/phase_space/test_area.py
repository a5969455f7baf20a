"""Area kept and lost along a run."""

import math

import numpy as np
import pytest

from engine.methods import METHODS
from engine.models.pendulum import acceleration
from engine.phase_space.area import Neighbourhood
from engine.scenes import SCENES, Scene

DRIFT = SCENES["drift"]
INDEX = {method.key: i for i, method in enumerate(METHODS)}


@pytest.fixture(scope="module")
def after_ten_thousand_steps() -> dict[str, float]:
    neighbourhood = Neighbourhood(DRIFT, radius=0.05)
    neighbourhood.advance(10_000, DRIFT.h)
    return dict(zip(INDEX, neighbourhood.area_ratios, strict=True))


@pytest.mark.parametrize("method", [m for m in METHODS if m.symplectic], ids=lambda m: m.key)
def test_a_symplectic_method_keeps_area_over_ten_thousand_steps(method, after_ten_thousand_steps):
    # each step rounds its determinant by about 1e-16, and the roundings add up like a walk or worse
    assert after_ten_thousand_steps[method.key] == pytest.approx(1.0, abs=1e-12)


def test_rk4_loses_area_very_slowly(after_ten_thousand_steps):
    assert 0.99 < after_ten_thousand_steps["rk4"] < 0.9999


def test_explicit_euler_gains_area_while_it_swings():
    neighbourhood = Neighbourhood(DRIFT, radius=0.05)
    neighbourhood.advance(100, DRIFT.h)
    assert neighbourhood.area_ratios[INDEX["explicit_euler"]] > 2


def shoelace(ring) -> float:
    theta, omega = ring
    return abs(float(np.sum(theta * np.roll(omega, -1) - omega * np.roll(theta, -1)))) / 2


@pytest.mark.parametrize("method", METHODS, ids=lambda m: m.key)
def test_a_small_ring_encloses_what_the_jacobians_say(method):
    neighbourhood = Neighbourhood(DRIFT, radius=1e-4)
    before = shoelace(neighbourhood.rings[INDEX[method.key]])
    neighbourhood.advance(40, DRIFT.h)
    after = shoelace(neighbourhood.rings[INDEX[method.key]])
    # a ring of radius 1e-4 bends by its square, and cancellation in the shoelace costs as much
    assert after / before == pytest.approx(neighbourhood.area_ratios[INDEX[method.key]], rel=1e-6)


def test_the_ring_is_carried_by_the_very_step_of_the_method():
    neighbourhood = Neighbourhood(Scene(theta=0.5), radius=0.1, points=8)
    start = neighbourhood.rings[0]
    neighbourhood.advance(3, 0.05)
    for method, ring in zip(METHODS, neighbourhood.rings, strict=True):
        for i in range(8):
            phase = (float(start[0][i]), float(start[1][i]))
            for _ in range(3):
                phase = method.step(acceleration(9.81), phase, 0.05)
            # NumPy's sine and the C library's may differ in the last place
            assert (ring[0][i], ring[1][i]) == pytest.approx(phase, rel=1e-14, abs=1e-14)


def test_running_back_undoes_the_area_of_the_reversible_method():
    neighbourhood = Neighbourhood(DRIFT, radius=0.05)
    neighbourhood.advance(50, 0.05)
    neighbourhood.advance(50, -0.05)
    assert neighbourhood.area_ratios[INDEX["velocity_verlet"]] == pytest.approx(1.0, abs=1e-13)  # rounding
    assert math.log(neighbourhood.area_ratios[INDEX["explicit_euler"]]) > 0.1


def test_a_method_that_overflows_keeps_its_last_ring():
    neighbourhood = Neighbourhood(Scene(theta=1.0, omega=1e9, h=15.0), radius=1e308 / 1e3)
    neighbourhood.advance(500, 15.0)
    assert all(np.isfinite(ring).all() for ring in neighbourhood.rings)
