"""The measured properties of methods that are not in METHODS; test_claims has those that are."""

import pytest

from engine.methods import measure


def composition(*weights):
    def composed(force, phase, h):
        theta, omega = phase
        while True:
            for weight in weights:
                theta = theta + weight * h / 2 * omega
                omega = omega + weight * h * force(theta)
                theta = theta + weight * h / 2 * omega
            yield theta, omega

    return composed


def test_three_steps_of_a_third_are_stable_three_times_as_far():
    assert measure.linear_limit(composition(1 / 3, 1 / 3, 1 / 3)) == pytest.approx(
        6, abs=1e-5
    )  # where rounding turns


def test_a_method_that_does_not_follow_the_pendulum_has_no_order():
    def upwards(force, phase, h):
        theta, omega = phase
        while True:
            theta, omega = theta + h * omega, omega - h * force(theta)
            yield theta, omega

    assert measure.order(upwards) is None
