import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import GENERAL
from engine.stability.linear import amplification, wobble

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


def test_rk4_halves_the_energy_fastest_at_the_square_root_of_six():
    assert amplification(BY_KEY["rk4"], math.sqrt(6)) == pytest.approx(0.5, rel=1e-12)


@given(z=st.floats(0.05, 1.9), steps=st.just(2000))
def test_the_wobble_bounds_the_energy_of_a_linear_swing_and_is_reached(z, steps):
    def spring(theta):
        return -theta

    for key in ("symplectic_euler", "velocity_verlet"):
        phase, energies, angles = (1.0, 0.0), [1.0], [1.0]
        for _ in range(steps):
            phase = BY_KEY[key].step(spring, phase, z)
            energies.append(phase[0] ** 2 + phase[1] ** 2)
            angles.append(abs(phase[0]))
        lowest, highest, widest = wobble(BY_KEY[key], z)
        assert lowest * (1 - 1e-9) <= min(energies)  # 2000 steps' rounding is 1e-12
        assert max(energies) <= highest * (1 + 1e-9)
        assert max(angles) <= widest * (1 + 1e-9)
        if all(
            abs(z - 2 * math.sin(math.pi * p / q)) > 0.01 for q in range(2, 21) for p in range(1, q)
        ):
            # Where the orbit is no short cycle it comes close to every point of the ellipse.
            assert min(energies) == pytest.approx(lowest, rel=0.05)
            assert max(energies) == pytest.approx(highest, rel=0.05)
            assert max(angles) == pytest.approx(widest, rel=0.05)


@given(z=st.floats(0.05, 1.9))
def test_the_wobble_of_the_symplectic_steps_has_a_closed_form(z):
    assert wobble(BY_KEY["velocity_verlet"], z) == pytest.approx((1 - z**2 / 4, 1, 1), rel=1e-12)
    expected = (1 / (1 + z / 2), 1 / (1 - z / 2), 1 / math.sqrt(1 - z**2 / 4))
    assert wobble(BY_KEY["symplectic_euler"], z) == pytest.approx(expected, rel=1e-12)


@given(z=st.floats(0.01, 2.8))
def test_explicit_euler_and_rk4_do_not_wobble(z):
    for key in ("explicit_euler", "rk4"):
        assert wobble(BY_KEY[key], z)[:2] == pytest.approx((1.0, 1.0), abs=1e-9)


@given(z=st.floats(2.001, 1000))
def test_beyond_its_limit_a_symplectic_step_has_no_ellipse(z):
    for key in ("symplectic_euler", "velocity_verlet"):
        assert wobble(BY_KEY[key], z) == (0.0, 1.0, 1.0)
