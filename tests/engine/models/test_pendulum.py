"""The closed form against mpmath at 50 digits, and energies right to the last digits."""

import math
from itertools import permutations

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.models.model import EnergyReference, State
from pendu_tui.engine.models.pendulum import LinearOscillator, Pendulum, _carlson_rf
from pendu_tui.engine.scenes import Scene
from tests.truths import LIMITS

PENDULUM = Pendulum(9.81)
W0 = math.sqrt(9.81)
JUST = 2 * W0  # rad/s; at the bottom, the speed of the separatrix

STARTS = {
    "at the default": (1.0, 0.0),
    "hardly there": (1e-200, 0.0),
    "back through the bottom": (-1.0, -3.0),
    "a pico-radian from upright": (math.pi - 1e-12, 0.0),
    "at math.pi, which is not pi": (math.pi, 0.0),
    "just below the separatrix": (2.0, -JUST * math.cos(1.0) * (1 - 1e-13)),
    "just above it": (2.0, -JUST * math.cos(1.0) * (1 + 1e-13)),
    "within rounding of it": (0.0, JUST),
    "many turns down": (-1e6, -9.0),
    "a turn up": (7.0, 1.0),
}


def reference(scene, t):
    theta, omega, w0 = mp.mpf(scene.theta), mp.mpf(scene.omega), mp.sqrt(mp.mpf(scene.w0_squared))
    turns = 2 * mp.pi * mp.nint(theta / (2 * mp.pi))
    half = (theta - turns) / 2
    k2 = mp.sin(half) ** 2 + (omega / (2 * w0)) ** 2
    k = mp.sqrt(k2)
    if k2 < 1:
        u = w0 * t + mp.ellipf(mp.atan2(mp.sin(half), omega / (2 * w0)), k2)
        sn, cn, dn = (mp.ellipfun(name, u, m=k2) for name in ("sn", "cn", "dn"))
        return turns + 2 * mp.atan2(k * sn, dn), 2 * w0 * k * cn
    direction = mp.sign(omega)
    u = k * w0 * t + mp.ellipf(direction * half, 1 / k2)
    turn = 2 * mp.ellipk(1 / k2)
    done = mp.nint(u / turn)
    sn, cn, dn = (mp.ellipfun(name, u - done * turn, m=1 / k2) for name in ("sn", "cn", "dn"))
    return turns + direction * 2 * (mp.atan2(sn, cn) + done * mp.pi), direction * 2 * w0 * k * dn


@pytest.mark.parametrize("start", STARTS.values(), ids=STARTS)
def test_the_swing_is_exact_to_1e_12_and_back_after_its_period(start):
    scene = Scene(theta=start[0], omega=start[1])
    exact = scene.exact()
    for t in (-100 / W0, -3.3, 0.0, 3e-4, 1.234, 20.0, 100 / W0):
        state = exact.at(t)
        with mp.workdps(50):
            theta, omega = reference(scene, t)
            # the contract; beyond a turn it is relative, as the float that holds theta is
            assert abs(state.theta - theta) <= 1e-12 * max(1.0, abs(state.theta))
            assert abs(state.omega - omega) <= 1e-12 * max(scene.w0, abs(state.omega))
    turn = {"rotation": math.copysign(math.tau, scene.omega)}.get(exact.regime, 0.0)
    back = pytest.approx((scene.theta + turn, scene.omega), rel=1e-12, abs=1e-10)
    assert exact.at(exact.period) == back
    swing = float(2 * mp.pi / mp.agm(1, mp.cos(1))) / W0  # from 2 rad: Gauss
    assert PENDULUM.exact(2.0, 0.0).period == pytest.approx(swing, rel=1e-14)


@pytest.mark.parametrize("x", np.linspace(0, 0.95, 20).tolist())
def test_carlsons_integral_is_right_to_the_last_digits(x):
    right = pytest.approx(float(mp.elliprf(x, 0.7, 1)), rel=2e-15, abs=0)
    assert all(_carlson_rf(*each) == right for each in permutations((x, 0.7, 1.0)))


def test_at_rest_it_stays_and_the_separatrix_climbs_forever():
    for model in (PENDULUM, LinearOscillator(9.81)):
        rest = model.exact(0.0, 0.0)
        assert (rest.regime, rest.period, rest.at(1e5)) == ("equilibrium", None, State(0.0, 0.0))
        assert {model.exact(*start).regime for start in ((0, 1), (1, 0))} == {"libration"}
    exact = Scene(theta=0.0, omega=-4.0, gravity=4.0).exact()  # exactly on it
    assert (exact.regime, exact.period) == ("separatrix", None)
    for t in (-3.0, 0.5, 3.0):
        gudermann = -2 * math.atan(math.sinh(2 * t)), -4 / math.cosh(2 * t)
        assert exact.at(t) == pytest.approx(gudermann, abs=1e-15)  # a few roundings
    assert exact.at(1e5) == State(-math.pi, 0.0)


@given(**{name: st.floats(*limits) for name, limits in LIMITS.items()}, t=st.floats(-1e5, 1e5))
def test_no_legal_start_gives_anything_but_finite_numbers(t, **start):
    scene = Scene(**start, h=0.1 * math.sqrt(start["length"] / start["gravity"]))
    assert all(map(math.isfinite, scene.exact().at(t)))


@given(theta=st.floats(-1e6, 1e6), omega=st.floats(-1e6, 1e6), w0_squared=st.floats(1e-3, 1e3))
def test_the_energy_is_right_to_the_last_digits_everywhere(theta, omega, w0_squared):
    with mp.workdps(700):  # 1 - cos theta cancels, down to the smallest square that a float holds
        expected = float(mp.mpf(omega) ** 2 / 2 + mp.mpf(w0_squared) * (1 - mp.cos(mp.mpf(theta))))
    # A handful of roundings; 1e-300 because the squares of tiny numbers underflow.
    assert Pendulum(w0_squared).energy()((theta, omega)) == pytest.approx(
        expected, rel=1e-15, abs=1e-300
    )


@pytest.mark.parametrize("model", [PENDULUM, LinearOscillator(9.81)], ids=lambda model: model.key)
@given(theta=st.floats(-10, 10))
def test_the_force_is_minus_the_slope_of_the_energy_and_has_its_own(model, theta):
    slope = model.energy(np.sin)((complex(theta, 1e-100), 0.0)).imag / 1e-100
    assert model.force()(theta) == pytest.approx(-slope, abs=1e-13)
    assert model.slope(theta) == pytest.approx(
        model.force(np.sin)(complex(theta, 1e-100)).imag / 1e-100, abs=1e-13
    )


@given(theta=st.floats(-3, 3), omega=st.floats(-10, 10))
def test_the_level_is_one_minus_the_energy_over_the_separatrixs(theta, omega):
    level = 1 - PENDULUM.energy()((theta, omega)) / PENDULUM.energy()((math.pi, 0.0))
    assert PENDULUM.level(theta, omega) == pytest.approx(level, abs=1e-14)
    small = LinearOscillator(9.81).energy()((theta, omega)) / (2 * 9.81)  # less the 1 of rest
    assert LinearOscillator(9.81).level(theta, omega) == pytest.approx(-small)


def test_the_level_keeps_its_digits_where_the_energy_has_lost_them():
    # cos²((pi - 1e-6)/2) is 2.5e-13; 1e-9 is what rounding of the angle itself costs: 2e-16 of 1e-6
    assert PENDULUM.level(math.pi - 1e-6, 0.0) == pytest.approx(2.5e-13, rel=1e-9)


def test_errors_are_relative_to_the_start_or_to_the_separatrix():
    assert PENDULUM.reference(0.0, 2.0) == EnergyReference(2.0, 2.0)
    assert PENDULUM.reference(0.0, 0.0) == EnergyReference(0.0, 2 * 9.81)
    assert EnergyReference(2.0, 4.0).errors(5.0, 3.0, 1.0) == [0.25, -0.25]
