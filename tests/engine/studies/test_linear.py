import math
from itertools import islice

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import GENERAL
from pendu_tui.engine.studies.stability import amplification, wobble

BY_KEY = {method.key: method for method in GENERAL}


def on_the_unit_circle_below_two(z):
    return 1.0 if z <= 2 else z**2 / 2 - 1 + z * math.sqrt(z**2 / 4 - 1)


FORMULAS = {
    "explicit_euler": lambda z: math.sqrt(1 + z**2),
    "symplectic_euler": on_the_unit_circle_below_two,
    "velocity_verlet": on_the_unit_circle_below_two,
    "rk4": lambda z: math.sqrt(1 - z**6 / 72 + z**8 / 576),
}


@given(z=st.floats(1e-6, 3).filter(lambda z: abs(z - 2) > 1e-3))
def test_the_amplification_is_the_textbooks(z):
    # At z = 2 two multipliers meet and rounding shows as its square root; 1e-3 away it is below 1e-13.
    for key, formula in FORMULAS.items():
        assert amplification(BY_KEY[key], z) == pytest.approx(formula(z), rel=1e-12)


@pytest.mark.parametrize("z", [0.05, 0.3, 1.1, 1.9])  # no short cycles
@pytest.mark.parametrize("key", ["symplectic_euler", "velocity_verlet"])
def test_the_wobble_bounds_the_energy_of_a_linear_swing_and_is_reached(key, z):
    phases = islice(BY_KEY[key].phases(np.negative, (1.0, 0.0), z), 2000)
    theta, omega = np.array([(1.0, 0.0), *phases]).T
    energies = theta**2 + omega**2
    ratios = np.divide(
        (energies.min(), energies.max(), np.abs(theta).max()), wobble(BY_KEY[key], z)
    )
    assert ratios == pytest.approx(1, rel=0.01)
    assert (ratios * (1, -1, -1) >= np.array((1, -1, -1)) - 1e-9).all()


@given(z=st.floats(0.05, 1.9))
def test_the_wobble_of_the_symplectic_steps_has_a_closed_form(z):
    assert wobble(BY_KEY["velocity_verlet"], z) == pytest.approx((1 - z**2 / 4, 1, 1), rel=1e-12)
    expected = (1 / (1 + z / 2), 1 / (1 - z / 2), 1 / math.sqrt(1 - z**2 / 4))
    assert wobble(BY_KEY["symplectic_euler"], z) == pytest.approx(expected, rel=1e-12)


@given(z=st.floats(0.01, 2.8), beyond=st.floats(2.001, 1000))
def test_there_is_no_wobble_without_an_ellipse(z, beyond):
    for key in ("explicit_euler", "rk4"):
        assert wobble(BY_KEY[key], z)[:2] == pytest.approx((1.0, 1.0), abs=1e-9)
    for key in ("symplectic_euler", "velocity_verlet"):
        assert wobble(BY_KEY[key], beyond) == (0.0, 1.0, 1.0)
