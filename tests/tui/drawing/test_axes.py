import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tui.drawing.axes import envelope, linear_axis, log_axis, log_time_axis, log_x_axis, time_axis

ROWS = st.integers(3, 60)


def rows_of_labels(axis, rows):
    """The row, counted from above and in fractions, at which each label stands."""
    return [rows * (axis.high - place) / (axis.high - axis.low) for place in axis.labels]


@given(st.floats(-17, 6), st.floats(0, 23), ROWS)
def test_a_logarithmic_axis_covers_its_range_and_labels_evenly_spaced_rows(low, size, rows):
    axis = log_axis(low, low + size, rows)
    assert axis.low <= low
    assert low + size <= axis.high
    assert all(float(label) == pytest.approx(10.0**place) for place, label in axis.labels.items())
    assert_even(rows_of_labels(axis, rows))


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), ROWS)
def test_a_linear_axis_covers_its_range_and_labels_evenly_spaced_rows(a, b, rows):
    low, high = min(a, b), max(a, b)
    axis = linear_axis(low, high, rows)
    assert axis.low <= low
    assert high <= axis.high
    assert_even(rows_of_labels(axis, rows))
    step = np.diff(list(axis.labels))[:1].sum() or 1.0
    for place, label in axis.labels.items():
        assert float(label) == pytest.approx(
            place, abs=1e-6 * step
        )  # the label is the number, and not a rounded one


def assert_even(rows):
    assert all(row % 1 == pytest.approx(0.5, abs=1e-6) for row in rows)
    apart = -np.diff(rows)
    assert np.all(apart >= 1 - 1e-6)
    assert np.allclose(apart, apart[:1], atol=1e-6)


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.integers(8, 60))
def test_an_axis_has_enough_labels_and_its_data_fills_at_least_a_third_of_it(a, b, rows):
    low, high = min(a, b), max(a, b)
    assume(high - low > max(1e-3 * max(abs(a), abs(b)), 1e-15))
    axis = linear_axis(low, high, rows)
    assert 2 <= len(axis.labels) <= rows / 2 + 1
    assert high - low >= 0.33 * (
        axis.high - axis.low
    )  # 8 rows: the next round step, and whole rows between labels


@given(st.floats(-1e6, 1e6), st.floats(0, 1), ROWS)
def test_labels_stay_narrow_enough_for_the_smallest_chart(middle, spread, rows):
    for axis in (
        linear_axis(*sorted((middle, middle * (1 + spread))), rows),
        log_axis(-17, 6, rows),
    ):
        assert 5 <= axis.label_width <= 11  # a sign, the six digits that differ, and e-15


def test_the_most_common_axes_of_the_lab():
    assert log_axis(-7.3, 0.6, 14).labels == {
        0: "1",
        -2: "1e-2",
        -4: "1e-4",
        -6: "1e-6",
        -8: "1e-8",
    }
    assert log_axis(-6.0, 0.8, 11).low == pytest.approx(-6.333, abs=1e-3)  # no empty decade
    assert list(linear_axis(-0.06, 4.3, 14).labels.values()) == ["-1", "0", "1", "2", "3", "4", "5"]
    assert list(linear_axis(4.503, 4.509, 10).labels.values()) == [
        "4.502",
        "4.504",
        "4.506",
        "4.508",
        "4.510",
    ]
    assert list(linear_axis(-3e-7, 2e-7, 10).labels.values())[:2] == ["-4e-7", "-2e-7"]


@given(st.floats(0, 1e9), st.floats(0.5, 1e6), st.integers(8, 200))
def test_times_are_labelled_with_round_numbers_and_one_unit(start, size, columns):
    axis = time_axis(start, start + size, columns)
    labels = list(axis.labels.values())
    assert len(labels) <= columns / 10 + 2
    units = [label.partition(" ")[2] for label in labels]
    assert set(units[:-1]) <= {""}
    assert set(units[-1:]) <= {"s", "min", "h"}


@given(st.floats(-300, 300), st.floats(0, 600), st.integers(9, 200))
def test_a_horizontal_logarithmic_axis_covers_its_range_and_does_not_crowd_labels(
    low, size, columns
):
    axis = log_x_axis(low, low + size, columns)
    assert axis.low <= low
    assert low + size <= axis.high
    assert len(axis.labels) <= columns / 8 + 1
    assert all(place == math.floor(place) for place in axis.labels)


def test_a_long_run_is_labelled_in_s_min_h_and_days():
    axis = log_time_axis(1.0, 86400.0, 60)
    assert list(axis.labels.values()) == ["1 s", "5 s", "1 min", "5 min", "1 h", "5 h", "1 d"]
    assert [round(10**place) for place in axis.labels] == [1, 5, 60, 300, 3600, 18000, 86400]


def test_an_envelope_holds_the_largest_value_for_one_piece_or_two():
    x = np.arange(0.0, 6.0, 0.5)
    values = np.where(x == 2.5, 9.0, 1.0)[:, None]
    assert envelope(x, values, 1.0).ravel().tolist() == [1] * 4 + [9] * 4 + [1] * 4
    assert envelope(x, values, 0.0) is values
