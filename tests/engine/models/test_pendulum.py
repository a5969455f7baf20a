import math

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.models.model import EnergyReference
from pendu_tui.engine.models.pendulum import LinearOscillator, Pendulum

ENERGY = Pendulum(9.81).energy()


@given(theta=st.floats(-1e6, 1e6), omega=st.floats(-1e6, 1e6), w0_squared=st.floats(1e-3, 1e3))
def test_the_energy_is_right_to_the_last_digits_everywhere(theta, omega, w0_squared):
    with mp.workdps(700):  # 1 - cos theta cancels, down to the smallest square that a float holds
        expected = float(mp.mpf(omega) ** 2 / 2 + mp.mpf(w0_squared) * (1 - mp.cos(mp.mpf(theta))))
    # A handful of roundings; 1e-300 because the squares of tiny numbers underflow.
    assert Pendulum(w0_squared).energy()((theta, omega)) == pytest.approx(
        expected, rel=1e-15, abs=1e-300
    )


@given(theta=st.floats(-10, 10))
def test_the_acceleration_is_minus_the_slope_of_the_energy(theta):
    slope = Pendulum(9.81).energy(np.sin)((complex(theta, 1e-100), 0.0)).imag / 1e-100
    assert Pendulum(9.81).force()(theta) == pytest.approx(-slope, abs=1e-14)


@given(theta=st.floats(-3, 3), omega=st.floats(-10, 10))
def test_the_margin_is_one_minus_the_energy_over_the_separatrixs(theta, omega):
    margin = 1 - ENERGY((theta, omega)) / ENERGY((math.pi, 0.0))
    assert Pendulum(9.81).level(theta, omega) == pytest.approx(margin, abs=1e-14)


def test_the_margin_keeps_its_digits_where_the_energy_has_lost_them():
    # cos²((pi - 1e-6)/2) is 2.5e-13; 1e-9 is what rounding of the angle itself costs: 2e-16 of 1e-6
    assert Pendulum(9.81).level(math.pi - 1e-6, 0.0) == pytest.approx(2.5e-13, rel=1e-9)


def test_errors_are_relative_to_the_start_or_to_the_separatrix():
    assert Pendulum(9.81).reference(0.0, 2.0) == EnergyReference(2.0, 2.0)
    assert Pendulum(9.81).reference(0.0, 0.0) == EnergyReference(0.0, 2 * 9.81)


@given(theta=st.floats(-3, 3), omega=st.floats(-3, 3))
def test_the_level_of_the_oscillator_is_the_pendulums_for_small_swings(theta, omega):
    """1 - E/E_separatrix = 1 - E/(2 w0²), less the 1 of rest, where E = w0² amplitude²/2."""
    amplitude = math.hypot(theta, omega / math.sqrt(9.81))
    level = LinearOscillator(9.81).level(theta, omega)
    assert level == pytest.approx(-(amplitude**2) / 4)
