"""The measured properties of methods that are not in METHODS; test_claims has those that are."""

from collections.abc import Iterator

import pytest

from engine.methods import measure
from engine.methods.measure import Measured, measured
from engine.methods.method import Phases
from engine.models.model import Force, Phase


def midpoint(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
    theta, omega = phase
    while True:
        theta_half, omega_half = theta + h / 2 * omega, omega + h / 2 * force(theta)
        theta, omega = theta + h * omega_half, omega + h * force(theta_half)
        yield theta, omega


def composition(*weights: float) -> Phases:
    def composed(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        theta, omega = phase
        while True:
            for weight in weights:
                theta = theta + weight * h / 2 * omega
                omega = omega + weight * h * force(theta)
                theta = theta + weight * h / 2 * omega
            yield theta, omega

    return composed


OUTER = 1 / (2 - 2 ** (1 / 3))
INNER = (
    -1.17767998417887,
    0.235573213359357,
    0.784513610477560,
)  # Yoshida (1990), solution A of order 6
SIXTH = (*INNER[::-1], 1 - 2 * sum(INNER), *INNER)


def test_the_explicit_midpoint_rule_is_of_order_2_and_never_stable() -> None:
    found = measured(midpoint)
    assert found.order == pytest.approx(2, abs=0.05)
    assert (
        found[1:] == Measured(2, 2.0, 0, symplectic=False, reversible=False, linear_limit=0.0)[1:]
    )


@pytest.mark.parametrize(("weights", "order"), [((OUTER, 1 - 2 * OUTER, OUTER), 4), (SIXTH, 6)])
def test_yoshidas_compositions_have_their_order_and_keep_area_and_time(
    weights: tuple[float, ...], order: int
) -> None:
    found = measured(composition(*weights))
    assert found.order == pytest.approx(order, abs=0.15)
    assert (found.force_evaluations, found.symplectic, found.reversible) == (
        len(weights),
        True,
        True,
    )


def test_three_steps_of_a_third_are_stable_three_times_as_far() -> None:
    assert measure.linear_limit(composition(1 / 3, 1 / 3, 1 / 3)) == pytest.approx(
        6, abs=1e-5
    )  # where rounding turns


def test_a_method_that_does_not_follow_the_pendulum_has_no_order() -> None:
    def upwards(force: Force, phase: Phase, h: float) -> Iterator[Phase]:
        theta, omega = phase
        while True:
            theta, omega = theta + h * omega, omega - h * force(theta)
            yield theta, omega

    assert measure.order(upwards) is None
