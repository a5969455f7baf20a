"""The step's Jacobian by complex step; tests/engine/methods/test_claims.py has its determinant."""

import cmath
import math

import pytest

from pendu_tui.engine.methods import GENERAL, Method
from pendu_tui.engine.methods.tangent import jacobian
from pendu_tui.engine.models.pendulum import Pendulum


@pytest.mark.parametrize("method", GENERAL, ids=lambda m: m.key)
def test_the_jacobian_agrees_with_central_differences(method: Method):
    theta, omega, h, d = 0.7, -1.3, 0.05, 1e-5

    def force(angle: float) -> float:
        return -9.81 * math.sin(angle)

    exact = jacobian(method.on(Pendulum(9.81), cmath.sin), (theta, omega), h)
    right, left = (method.step(force, (theta + s * d, omega), h) for s in (1, -1))
    up, down = (method.step(force, (theta, omega + s * d), h) for s in (1, -1))
    differences = [(p - q) / (2 * d) for p, q in ((right[0], left[0]), (up[0], down[0]))]
    differences += [(p - q) / (2 * d) for p, q in ((right[1], left[1]), (up[1], down[1]))]
    assert list(exact) == pytest.approx(
        differences, abs=1e-9
    )  # d² and rounding over d, both about 1e-10
