import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tui.drawing.axes import held, per_column, time_span

VALUES = st.floats(-1e6, 1e6) | st.just(np.nan)


@st.composite
def rows(draw):
    """Times that ascend, some of them equal, and two series with gaps."""
    count = draw(st.integers(0, 60))
    x = np.cumsum(draw(arrays(np.float64, count, elements=st.floats(0, 2)))).round(
        6
    )  # on an edge, or well beside it
    low = draw(arrays(np.float64, (count, 2), elements=VALUES))
    return x, low, low + draw(arrays(np.float64, (count, 2), elements=st.floats(0, 10)))


@given(rows(), st.integers(1, 30))
def test_a_column_has_the_lowest_low_and_the_highest_high_of_its_rows(data, columns):
    x, low, high = data
    lows, highs = per_column(x, low, high, 0, 40, columns)
    edges = (
        np.linspace(0, 40, columns + 1) - 1e-9 * 40 / columns
    )  # rows on an edge belong to the right
    edges[-1] = 40
    for column in range(columns):
        last = column == columns - 1
        inside = (x >= edges[column]) & (
            (x <= edges[column + 1]) if last else (x < edges[column + 1])
        )
        for series in range(2):
            known = inside & ~np.isnan(low[:, series])
            if known.any():
                assert lows[column, series] == low[known, series].min()
                assert highs[column, series] == high[known, series].max()
            else:
                assert np.isnan(lows[column, series])


@given(rows(), st.integers(1, 30), st.floats(0, 50))
def test_a_held_column_is_the_largest_of_the_columns_before_it_up_to_the_end_of_the_data(
    data, columns, hold
):
    x, _, high = data
    largest = held(x, high, 0, 40, columns, hold)
    plain = per_column(x, high, high, 0, 40, columns)[1]
    back = min(int(np.ceil(hold / (40 / columns))), columns)
    for column in range(columns):
        begun = column == 0 or (len(x) and x[-1] > column * 40 / columns)
        parts = plain[max(column - back, 0) : column + 1]
        for series in range(2):
            expected = (
                parts[~np.isnan(parts[:, series]), series].max(initial=-np.inf)
                if begun
                else -np.inf
            )
            assert (largest[column, series] == expected) or (
                np.isnan(largest[column, series]) and expected == -np.inf
            )


def test_values_from_before_the_chart_are_held_into_its_first_columns():
    x = np.array([0.5, 1.5, 2.5])
    values = np.array([[9.0], [1.0], [2.0]])
    assert held(x, values, 1, 3, 2, 0.0).ravel().tolist() == [1, 2]
    assert held(x, values, 1, 3, 2, 1.0).ravel().tolist() == [9, 2]


@given(st.floats(0, 1e9), st.floats(1, 1e4), st.integers(5, 200))
def test_a_window_ends_within_a_column_of_the_last_moment_and_columns_keep_their_place(
    latest, seconds, columns
):
    start, end = time_span(np.array([0.0, latest]), seconds, columns)
    assert end - start == pytest.approx(seconds, rel=1e-4)  # 1e9 s less 20 s has few digits left
    assert latest <= end * (1 + 1e-9)
    assert end <= max(latest + seconds / columns, seconds) * (1 + 1e-9)
    assert (
        end / (seconds / columns) % 1 == pytest.approx(0, abs=1e-3)
        or end / (seconds / columns) % 1 > 0.999
    )


@given(st.floats(0, 1e9))
def test_the_whole_run_fills_at_least_nine_tenths_of_the_chart(latest):
    start, end = time_span(np.array([0.0, latest]), None, 50)
    assert start == 0
    assert max(latest, 1) <= end * (1 + 1e-9)
    assert end <= max(1.1 * latest, 1.1)
    assert time_span(np.array([]), None, 50) == (0, 1)
