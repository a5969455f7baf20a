import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from pendu_tui.tui.drawing.frame import (
    Axis,
    Frame,
    linear_axis,
    log_axis,
    log_time_axis,
    log_x_axis,
    number_ticks,
    theta_ticks,
    time_axis,
)
from pendu_tui.tui.drawing.time_chart import per_column, time_span

ROWS = st.integers(3, 60)
NUMBERS = st.floats(-1e6, 1e6)


@given(NUMBERS, NUMBERS, ROWS)
def test_an_axis_covers_its_range_and_its_labels_stand_at_their_values(a, b, rows):
    low, high = sorted((a, b))
    axis = linear_axis(low, high, rows)
    assert axis.low <= low <= high <= axis.high
    size = axis.high - axis.low
    for place, label in axis.labels.items():
        assert float(label) == pytest.approx(place, abs=1e-6 * size)
    axis = log_axis(low / 1e5, high / 1e5, rows)
    assert axis.low - 1e-9 <= low / 1e5 <= high / 1e5 <= axis.high + 1e-9
    assert all(float(label) == pytest.approx(10.0**place) for place, label in axis.labels.items())


HOUR = 3600


@pytest.mark.parametrize(
    ("axis", "ends", "text"),
    [
        (log_axis, (-7.3, 0.6, 14), "1e-6 1e-3 1"),
        (log_axis, (-5.3, 1.2, 8), "1e-5 1"),
        (log_axis, (-5.3, 1.2, 9), "1e-6 1e-4 1e-2 1"),
        (log_axis, (0.1, 1.1, 60), "1e-2 1e-1 1 10"),
        (log_axis, (1.0, 4.0, 3), "1 1e3"),
        (log_axis, (-17.0, 6.0, 3), "1e-24 1"),
        (log_x_axis, (0.0, 0.0, 40), "1 10"),
        (log_x_axis, (-3.2, 1.1, 47), "1e-4 1e-2 1 100"),
        (log_x_axis, (-3.2, 1.1, 48), "1e-4 1e-3 1e-2 1e-1 1 10 100"),
        (linear_axis, (-0.13, 0.19, 10), "0 0.2"),
        (linear_axis, (-0.13, 0.19, 9), "-0.2 -0.1 0 0.1 0.2"),
        (linear_axis, (4.503, 4.509, 10), "4.500 4.502 4.504 4.506 4.508"),
        (linear_axis, (-0.1, 0.02, 9), "-0.10 -0.05 0"),
        (linear_axis, (-3e-6, 2e-6, 10), "-4e-6 -2e-6 0 2e-6"),
        (linear_axis, (-3e-5, 2e-5, 9), "-0.00002 0 0.00002"),
        (linear_axis, (5.0, 5.0, 9), "4.9995 5.0000 5.0005"),
        (linear_axis, (0.0, 29.7, 3), "0"),
        (linear_axis, (0.0, 0.0, 9), "-1e-16 -5e-17 0 5e-17 1e-16"),
        (time_axis, (0, 4.9, 40, " run"), "0 2 4 s run"),
        (time_axis, (0, 5.0, 9), "0 5 s"),
        (time_axis, (2e6, 2e6 + 8, 30), "2000000 2000005 s"),
        (time_axis, (0, 4.9 * HOUR, 60), "0 50 100 150 200 250 min"),
        (time_axis, (0, 5 * HOUR, 60), "0 1 2 3 4 5 h"),
        (log_time_axis, (1.0, 86400.0, 60), "1 s 5 s 1 min 5 min 1 h 5 h 1 d"),
        (log_time_axis, (1.0, 86400.0, 61, " run"), "1 s 5 s 1 min 5 min 1 h 5 h 1 d run"),
        (
            log_time_axis,
            (0.009, 1e9, 400),
            "0.01 s 0.1 s 1 s 2 s 5 s 10 s 20 s 1 min 2 min 5 min 10 min 20 min"
            " 1 h 2 h 5 h 10 h 1 d 10 d 100 d 1000 d 10000 d",
        ),
        (log_time_axis, (2.0, 12.0, 20), "2 s 5 s"),
        (theta_ticks, (-math.pi, math.pi, 4), "-pi -pi/2 0 pi/2 pi"),
        (theta_ticks, (-15 * math.pi, 15 * math.pi, 8), "-15pi -10pi -5pi 0 5pi 10pi 15pi"),
        (theta_ticks, (-0.6, 0.6, 4), "-0.5 0 0.5"),
        (theta_ticks, (-1.0, 1.0, 4), "-pi/4 0 pi/4"),
        (number_ticks, (0.0, 1234.56, 4), "0 500 1000"),
        (number_ticks, (2.0, 2.0, 4), "2"),
    ],
)
def test_the_most_common_labels_of_the_lab(axis, ends, text):
    found = axis(*ends)
    assert " ".join(getattr(found, "labels", found).values()) == text


def test_what_is_off_an_axis_is_at_its_end():
    axis = Axis(0.0, 10.0, {})
    frame = Frame(axis, axis, columns=5, rows=4)
    cells = [(frame.column(at), frame.row(at)) for at in (-9, 0, 5, 10, 99)]
    assert cells == [(0, 3), (0, 3), (2, 1), (4, 0), (4, 0)]


@st.composite
def series(draw):
    """Times that ascend, some of them equal, on an edge or well beside it; values with gaps."""
    count = draw(st.integers(0, 60))
    x = np.cumsum(draw(arrays(np.float64, count, elements=st.floats(0, 2)))).round(6)
    low = draw(arrays(np.float64, (count, 2), elements=NUMBERS | st.just(np.nan)))
    return x, low, low + draw(arrays(np.float64, (count, 2), elements=st.floats(0, 10)))


@example((np.array([40.0]), np.zeros((1, 2)), np.ones((1, 2))), 1, 0.0)  # at the end of the axis
@given(series(), st.integers(1, 30), st.just(0.0) | st.floats(0.01, 50))
def test_a_column_has_the_extremes_of_its_rows_and_of_those_held_from_before(data, columns, hold):
    x, low, high = data
    edges = np.linspace(0, 40, columns + 1)
    lows, highs = per_column(x, low, high, edges, hold)
    assert len(lows) == columns
    edges -= 1e-9 * 40 / columns  # a row on an edge belongs to the right
    edges[-1] = np.nextafter(40, 41)
    for column, (begin, end) in enumerate(pairwise(edges)):
        inside = (x >= begin - hold) & (x < end) & (column == 0 or bool(np.any(x >= begin)))
        rows = np.vstack([low[inside], [[np.nan] * 2]]), np.vstack([high[inside], [[np.nan] * 2]])
        assert np.array_equal(lows[column], np.fmin.reduce(rows[0]), equal_nan=True)
        assert np.array_equal(highs[column], np.fmax.reduce(rows[1]), equal_nan=True)


@pytest.mark.parametrize(
    ("latest", "seconds", "span"),
    [
        (0.0, None, (0, 1)),
        (2.01, None, (0, 2.1)),
        (12.3, None, (0, 13)),
        (5.0, 20.0, (0, 20)),
        (20.1, 20.0, (0.4, 20.4)),  # 50 columns keep their moments
    ],
)
def test_a_chart_ends_within_a_tenth_of_the_run_or_a_column_of_its_window(latest, seconds, span):
    assert time_span(np.array([0.0, latest]), seconds, 50) == pytest.approx(span)
