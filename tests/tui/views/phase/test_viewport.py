"""From cells and dots to phase space and back."""

import itertools
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from engine.scenes import SCENES, Scene
from tui.views.phase.viewport import MIN_SPAN, Viewport, roundest

DRIFT = SCENES["drift"]
sizes = st.tuples(st.integers(2, 200), st.integers(2, 60))


def cell_of(viewport: Viewport, theta: float, omega: float) -> tuple[int, int]:
    return math.floor(viewport.x(theta) / 2), math.floor(viewport.y(omega) / 4)


@pytest.mark.parametrize("scene", [DRIFT, SCENES["linear"]])
@pytest.mark.parametrize("size", [(9, 5), (8, 4)])
def test_every_cell_leads_to_the_state_that_is_drawn_in_its_middle(size, scene):
    viewport = Viewport.portrait(*size, scene)
    for column in range(size[0]):
        for row in range(size[1]):
            theta, omega = viewport.at_cell(column, row)
            x, y = viewport.x(theta), viewport.y(omega)
            # rounding to a round number may take half a dot; 1e-9 is for the rounding of doubles
            assert (x, y) == pytest.approx((2 * column + 1, 4 * row + 2), abs=0.5 + 1e-9)


@given(sizes, st.floats(-3, 3), st.floats(-20, 20), st.floats(1e-7, 1), st.data())
def test_zoomed_and_panned_anywhere_cells_still_lead_to_what_is_drawn_there(
    size, theta, omega, factor, data
):
    viewport = Viewport.portrait(*size, DRIFT)._replace(wrap=False)
    viewport = viewport.panned(-theta / viewport.theta_per_dot, omega / viewport.omega_per_dot)
    viewport = viewport.zoomed(factor, size[0], 2 * size[1])
    column, row = data.draw(st.integers(0, size[0] - 1)), data.draw(st.integers(0, size[1] - 1))
    # at the deepest zoom a dot of a wide pane is 1e-9 of the angle: still ten thousand doubles
    assert viewport.x(viewport.at_cell(column, row).theta) == pytest.approx(
        2 * column + 1, abs=0.5 + 1e-4
    )
    assert viewport.y(viewport.at_cell(column, row).omega) == pytest.approx(
        4 * row + 2, abs=0.5 + 1e-4
    )


@given(sizes)
def test_rest_can_be_clicked_exactly_in_the_middle_cell(size):
    columns, rows = size
    assert Viewport.portrait(columns, rows, DRIFT).at_cell(columns // 2, rows // 2) == (0.0, 0.0)


@given(sizes, st.floats(-math.pi, math.pi))
def test_every_angle_of_a_turn_is_on_the_portrait_and_every_turn_shows_the_same(size, theta):
    viewport = Viewport.portrait(*size, DRIFT)
    assert 0 <= viewport.x(theta) < 2 * size[0]
    assume(abs(theta) < math.pi - 1e-6)  # there, rounding decides between the two edges
    # a turn of 6.28 rad, taken off again, leaves a few roundings of 1e-15
    assert viewport.x(theta + 3 * math.tau) == pytest.approx(viewport.x(theta), abs=1e-9)


def test_all_three_regimes_fit_whatever_the_start():
    for scene in (DRIFT, SCENES["spin"], SCENES["verlet-limit"], Scene(omega=50.0)):
        viewport = Viewport.portrait(40, 12, scene)
        assert 0 <= viewport.y(2 * scene.w0) < viewport.y(0.0) < viewport.y(-2 * scene.w0) < 48
        assert 0 <= viewport.y(scene.omega) < 48


@given(st.floats(0.01, 100), st.floats(0, 80), st.floats(0, 48))
def test_zoom_keeps_what_is_under_the_pointer(factor, x, y):
    before = Viewport.portrait(40, 12, DRIFT)
    after = before.zoomed(factor, x, y)
    # some roundings at the size of the numbers
    assert after.theta_at(x) == pytest.approx(before.theta_at(x), abs=1e-11)
    assert after.omega_at(y) == pytest.approx(before.omega_at(y), abs=1e-11)


def test_zoom_goes_to_a_thousandth_of_a_radian_and_no_further():
    viewport = Viewport.portrait(47, 16, DRIFT)
    viewport = viewport.panned(-math.pi / viewport.theta_per_dot, 0)
    for _ in range(100):
        viewport = viewport.zoomed(0.5, 47, 34)
    assert viewport.theta_span == pytest.approx(MIN_SPAN)
    around_the_top = [
        viewport.at_cell(column, 8).theta % math.tau - math.pi for column in range(47)
    ]
    steps = [b - a for a, b in itertools.pairwise(around_the_top)]
    assert all(
        0.4 * MIN_SPAN / 47 < step < 1.6 * MIN_SPAN / 47 for step in steps
    )  # half a dot of rounding each


@given(st.floats(-1e3, 1e3), st.floats(1e-9, 1))
def test_a_round_number_is_near_enough_and_no_shorter_one_is(value, tolerance):
    rounded = roundest(value, tolerance)
    assert abs(rounded - value) <= tolerance
    decimals = len(f"{rounded:.17f}".rstrip("0").partition(".")[2])
    if 0 < decimals < 10:
        assert abs(round(value, decimals - 1) - value) > tolerance * (1 - 1e-9)


def test_a_start_is_chosen_in_round_numbers():
    assert roundest(1.2345, 0.02) == 1.23
    assert roundest(-0.004, 0.02) == 0.0
    assert str(roundest(-0.004, 0.02)) == "0.0"
