"""The step's Jacobian by complex step."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import METHODS, Method
from engine.tangent import jacobian

angles = st.floats(-4.0, 4.0)
rates = st.floats(-8.0, 8.0)
steps = st.floats(-0.5, 0.5).filter(lambda h: abs(h) > 1e-3)


@pytest.mark.parametrize("method", METHODS, ids=lambda m: m.key)
@given(theta=angles, omega=rates, h=steps)
def test_a_step_keeps_area_exactly_if_its_method_is_called_symplectic(method: Method, theta, omega, h):
    determinant = jacobian(method.step, 9.81, theta, omega, h).determinant
    if method.symplectic:
        # entries are of order (h w0)² <= 2.5 and their products are rounded a few times
        assert determinant == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize("method", [m for m in METHODS if not m.symplectic], ids=lambda m: m.key)
def test_a_step_changes_area_if_its_method_is_not_symplectic(method: Method):
    # RK4's change is the smallest, of the order of (h w0)⁶/72 = 2e-7 at this step
    assert abs(jacobian(method.step, 9.81, 0.0, 0.0, 0.05).determinant - 1) > 1e-7


@given(theta=angles, omega=rates, h=steps)
def test_explicit_euler_changes_area_by_h2_w02_cos_theta(theta, omega, h):
    determinant = jacobian(METHODS[0].step, 9.81, theta, omega, h).determinant
    assert determinant == pytest.approx(1 + h * h * 9.81 * math.cos(theta), abs=1e-14)  # rounding


@pytest.mark.parametrize("method", METHODS, ids=lambda m: m.key)
def test_the_jacobian_agrees_with_central_differences(method: Method):
    theta, omega, h, d = 0.7, -1.3, 0.05, 1e-5

    def force(angle: float) -> float:
        return -9.81 * math.sin(angle)

    exact = jacobian(method.step, 9.81, theta, omega, h)
    right, left = (method.step(force, (theta + s * d, omega), h) for s in (1, -1))
    up, down = (method.step(force, (theta, omega + s * d), h) for s in (1, -1))
    differences = [(p - q) / (2 * d) for p, q in ((right[0], left[0]), (up[0], down[0]))]
    differences += [(p - q) / (2 * d) for p, q in ((right[1], left[1]), (up[1], down[1]))]
    assert list(exact) == pytest.approx(differences, abs=1e-9)  # d² and rounding over d, both about 1e-10
