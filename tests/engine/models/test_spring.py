"""A bob on a stiff spring: where it starts, what it keeps, and the reference."""

import math

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.inputs import InputError
from pendu_tui.engine.models.reference import Reference, compose_verlet
from pendu_tui.engine.models.spring import ACCURACY, STEP, Spring
from pendu_tui.engine.scenes import Scene

SPRING = Spring(9.81, 2500.0)
places = st.builds(complex, st.floats(-2, 2), st.floats(-2, 2)).filter(lambda z: abs(z) > 1e-3)


def test_the_start_is_stretched_by_4_percent_beyond_equilibrium():
    z, w = SPRING.start(1.0, 0.0)
    assert z == pytest.approx(0.8769138657516443 - 0.5630599180095599j, abs=1e-15)
    assert w == 0
    assert SPRING.spring_energy((z, w)) == pytest.approx(2500 / 2 * 0.04**2)
    assert SPRING.reference(1.0, 0.0).start == pytest.approx(6.5040, abs=1e-4)


@given(theta=st.floats(-3.1, 3.1), omega=st.floats(-5, 5))
def test_a_start_is_seen_at_its_angle_and_angular_velocity(theta, omega):
    seen = SPRING.observe(SPRING.start(theta, omega))
    assert seen[:2] == pytest.approx((theta, omega), abs=1e-14)


@given(z=places)
def test_the_force_is_minus_the_slope_of_the_energy(z):
    def energy(x, y):
        return mp.mpf("9.81") * (y + 1) + 1250 * (mp.hypot(x, y) - 1) ** 2

    with mp.workdps(40):
        x, y = mp.mpf(z.real), mp.mpf(z.imag)
        slope = complex(mp.diff(energy, (x, y), (1, 0)), mp.diff(energy, (x, y), (0, 1)))
        assert SPRING.energy()((z, 0j)) == pytest.approx(float(energy(x, y)), rel=1e-12)
    assert SPRING.force()(z) == pytest.approx(-slope, rel=1e-12, abs=1e-9)


def test_the_reference_is_as_accurate_as_it_says_and_keeps_the_energy():
    step, start = STEP / 2 / SPRING.fastest, SPRING.start(1.0, 0.0)
    finer, exact = Reference(compose_verlet(SPRING.force()), start, step), SPRING.exact(1.0, 0.0)
    energy = SPRING.energy()
    for t in (1.0, 10.0, 30.0):
        assert abs(exact.at(t).theta - SPRING.observe(finer.at(t)).theta) < ACCURACY / 2
        assert energy(SPRING.place(1.0, 0.0, t)) == pytest.approx(energy(start), rel=1e-11)


def test_the_true_motion_keeps_the_springs_energy_within_2_5_percent():
    half_a_minute = [SPRING.place(1.0, 0.0, n / 50) for n in range(1500)]
    energies = np.array([SPRING.spring_energy(phase) for phase in half_a_minute])
    assert 1.02 < max(energies / energies[0]) < 1.025
    assert min(energies / energies[0]) > 0.975


def test_its_fastest_frequency_is_the_springs():
    scene = Scene(model="spring", parameters={"stiffness": 2500.0}, h=0.02, cast=())
    assert scene.z == pytest.approx(1.0)
    # hanging down it only vibrates; gravity does not change how fast
    z, w = SPRING.place(0.0, 0.0, math.tau / 50)
    assert z == pytest.approx(SPRING.start(0.0, 0.0)[0], abs=1e-10)
    assert abs(w) < 1e-8


def test_stiffness_is_for_the_model_that_has_it_and_more_than_nothing():
    with pytest.raises(InputError, match=r"^the model linear has no stiffness; "):
        Scene(model="linear", parameters={"stiffness": 1.0})
    with pytest.raises(InputError, match=r"^stiffness = 0 s⁻² is out of range; use 1 to 1e\+18 "):
        Scene(model="spring", cast=())


def test_the_true_motion_of_too_fast_a_spring_is_not_known():
    assert math.isfinite(Spring(9.81, 1e6).exact(1.0, 0.0).at(0.1).theta)
    assert all(map(math.isnan, Spring(9.81, 1e14).exact(1.0, 0.0).at(30.0)))


@pytest.mark.parametrize(("ratio", "followed"), [(319.0, True), (321.0, False)])
def test_a_spring_that_is_too_fast_has_no_reference(ratio, followed):
    exact = Spring(9.81, ratio**2 * 9.81).exact(1.0, 0.0)
    assert math.isfinite(exact.at(0.01).theta) == followed


def test_an_error_of_theta_is_less_than_half_a_turn():
    assert SPRING.theta_error(3.1, -3.1) == pytest.approx(6.2 - math.tau)
    assert SPRING.theta_error(0.3, 0.1) == pytest.approx(0.2)
