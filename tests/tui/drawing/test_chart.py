import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.scenes import Line
from pendu_tui.tui.drawing.frame import spread
from pendu_tui.tui.drawing.picture import FRAME
from pendu_tui.tui.drawing.plotted import ENERGY, TREND, Series, loglog_chart, record_chart
from pendu_tui.tui.drawing.time_chart import _crossings, time_chart
from pendu_tui.tui.playback.rows import Window
from pendu_tui.tui.playback.shown import Shown, Stretch
from tests.tui.drawn import cells, look, places, size

ANY = st.floats(allow_nan=True, allow_infinity=True)
COUNT = len(USUAL_CAST)
TIMES = np.arange(0.05, 20.0, 0.05)
NAMES = ["Explicit Euler", "Symplectic Euler", "Verlet", "RK4"]


def window(x, low, high=None, repeats=0.0, turned=False):
    """A window on one quantity, with a column for each method or the same for all."""
    x, low, high = (np.asarray(part, float) for part in (x, low, low if high is None else high))
    low, high = (np.tile(part[:, None], COUNT) if part.ndim == 1 else part for part in (low, high))
    t = -x if turned else x
    return Window(x, t, {"energy_error": low}, {"energy_error": high}, repeats)


def plot(
    data, width=60, height=14, places=range(COUNT), ghost=None, changes=(), names=(), **options
):
    """The chart of the methods at these places."""
    hidden = {method.key for place, method in enumerate(USUAL_CAST) if place not in places}
    shown = Shown(hidden=frozenset(hidden), **options)
    return time_chart(
        data, USUAL_CAST, shown, width, height, names=names, ghost=ghost, changes=changes
    )


def test_charts_as_they_are_stored(snapshot):
    t = np.arange(0.03, 20.0, 0.07)
    rates = np.array([3.1, 0.31, 0.031, 3.1e-16])
    grows = np.exp(t[:, None] * rates) - 0.99
    waves = np.sin(3 * t)[:, None] * rates
    ghost = window(t, 1.7 * grows)
    changes = [(0.0, "start"), (7.6, "h 0.025"), (7.7, "h 0.1"), (19.7, "h 0.05"), (20.0, "end")]
    limit = {"line": Line("energy_error", -2.0, "limit")}
    mixed = window(t, waves - 0.1, waves + 0.05, 1.1)
    long = window(60 * t, grows, repeats=1.1)
    zeros = window(np.arange(43), [0, 1e-12, 1e-8, *[0.1] * 38, 0, 0])
    pictures = [
        plot(window(t, grows, repeats=1.1), ghost=ghost, changes=changes, seconds=20, **limit),
        plot(window(t, grows), 60, 9, names=NAMES),
        plot(window(t, grows), 59, 8, names=NAMES, places=[1, 2, 3]),
        plot(window(t, grows), 59, 10, names=NAMES),
        plot(window(t, grows[:, :1] ** 10 * [1, 0, 0, 0] + grows), 60, 10, places=[0, 2]),
        plot(mixed, 60, 16, log=False, changes=changes, seconds=10, **limit),
        plot(window(t, -grows, -grows / 2, turned=True), 72, 12, log=False, names=NAMES),
        plot(window(t, np.where(t < 8, 0, np.sin(40 * t))), 72, 9, log=False, names=NAMES),
        plot(window(t, grows[:, 2]), 40, 5),
        plot(window(t[-9:], grows[-9:]), 72, 9, names=NAMES, seconds=20),  # nothing before
        # no error is torn by zeros, and neither zeros nor the smallest fortieth are on the axis
        plot(window(t, np.sin(6 * t) ** 2, repeats=1.0), 60, 8, places=[0], seconds=20),
        plot(zeros, 53, 8, places=[0], seconds=43),
        # logarithmic time begins with half a swing, or two to three decades before its end
        *(plot(window(60 * t, grows, repeats=r), 60, 8, log_time=True) for r in (0.9, 500.0)),
        plot(window(t, grows), 59, 8, line=Line("theta_error", 0.011, "of another quantity")),
        *(plot(window([], []), 40, 6, log=log) for log in (True, False)),
        plot(long, 60, 16, log_time=True, changes=[(70.0, "h 0.1")], names=NAMES),
    ]
    series = [
        Series(0, "e", [1e2, 3e3, 2e4], [2e-1, 3e-2, 4e-4]),
        Series(2, "v", [2e2, np.inf, 1e1, 4e1], [3e-5, 1, 2e-3, 4e-3]),
        Series(FRAME, "a slope of 2", [1e1, 1e7], [1e-1, 1e-13], dotted=True),
        Series(FRAME, "up", [1e3, 1e5], [1e-3, 1e1], dotted=True),
    ]
    texts = [look(each.picture) for each in pictures]
    texts.append(look(loglog_chart([], 40, 9, x_label="cost", y_label="error").picture))
    chart = loglog_chart(series, 60, 18, x_label="cost", y_label="error")
    column, row = chart.cell(3e3, 3e-2)
    assert cells(chart.picture)[row, column] == ("e", 0)
    small = loglog_chart(series, 20, 6, x_label="cost", y_label="error")  # no room for names
    snapshot("charts.txt", "\n".join([*texts, look(chart.picture), look(small.picture)]))


def test_stretches_levels_and_what_has_left_the_chart_as_they_are_stored(snapshot):
    t = TIMES
    late = np.exp(np.outer(t, (2.0, 0.9, 0.1, 0.01))) - 0.99
    cut = window(t, late, turned=True).cut(2.0, 4.5)
    spiky = window(t, np.where(np.arange(len(t)) % 100 == 37, 1.0, 1e-3), repeats=1.0)
    lower = window(t, -3 * late, late)
    plots = [
        *(plot(cut, 60, 9, stretch=Stretch(1, 2.0, 4.5, log_time)) for log_time in (False, True)),
        # a spike is held for half a swing, in whole columns unless time is logarithmic
        *(plot(spiky, 60, 7, places=[0], log_time=log_time) for log_time in (False, True)),
        *(plot(lower, 60, 12, log=log, names=NAMES) for log in (True, False)),
        *(plot(window(t, -late, 3 * late), 60, 12, log=log) for log in (True, False)),
        plot(window(60 * t, np.column_stack([1e-3 * t, 0 * t + 0.01] * 2)), places=[0, 1]),
        *(
            plot(window(t, late), 60, 9, places=[2, 3], log=log, line=line)
            for log in (True, False)
            for line in (Line("energy_error", 50.0, "above"), Line("energy_error", -1e-9, "low"))
        ),
        plot(window(t, np.where(t[:, None] > 18.5, late, np.nan)), 60, 8, log=False, names=NAMES),
    ]
    for each, sign in zip(plots[4:6], (3, -3), strict=True):
        assert each.at(40).values == pytest.approx(sign * late[278])  # the last row before 14 s
    assert plots[1].zoomed(window(t, late), 4.0) == pytest.approx((3 / 2.25**2, 3 * 2.25**2))
    for beside in (-1, plots[1].columns):
        assert plots[1].at(plots[1].left + beside) is None
    snapshot("stretches.txt", "\n".join(look(each.picture) for each in plots))


def test_a_column_is_read_out_farthest_from_zero_and_stays_where_it_is_in_a_zoom():
    data = window(TIMES, -3 * TIMES, TIMES)
    chart = plot(data, 60, 10, log=False)
    middle = chart.left + len(chart.times) // 2
    assert plot(window([], []), 40, 6).at(20) is None
    assert chart.at(middle).values[0] == pytest.approx(-30, abs=1.5)
    exact = plot(window(TIMES, 0 * TIMES))  # no error is less than the resolution of doubles
    assert exact.at(middle).values == pytest.approx([1e-17] * COUNT, rel=1e-9, abs=0)
    values = [1.0, 2.0, 3.0, math.nan]
    partly = window(TIMES, np.where(TIMES[:, None] < 6, values, math.nan))
    known = plot(partly, log=False).at(middle)
    assert known.t == pytest.approx(5.8)  # the middle of the last column where one is known
    assert known.values == pytest.approx(values, nan_ok=True)
    for factor, column, ends in (
        (0.5, None, (5, 15)),
        (0.5, 0, (0, 10)),
        (0.5, 59, (10, 20)),
        (0.4, middle, (6.12, 14.12)),
        (2, None, None),
    ):
        found = chart.zoomed(data, factor, column)
        assert found == (ends and pytest.approx(ends, abs=0.01))


@settings(max_examples=150)
@given(st.data())
def test_any_numbers_and_any_size_make_a_chart(data):
    """What plotext cannot bear would end the process, and with it this test run."""
    count = data.draw(st.integers(0, 30))
    x = np.cumsum(data.draw(arrays(np.float64, count, elements=st.floats(0, 1e6))))
    values = data.draw(arrays(np.float64, (2, count, COUNT), elements=ANY))
    width, height = data.draw(st.integers(1, 70)), data.draw(st.integers(1, 25))
    picture = plot(
        window(x, values.min(axis=0), values.max(axis=0), data.draw(st.floats(0, 1e6))),
        width,
        height,
        data.draw(st.lists(st.integers(0, COUNT - 1), unique=True)),
        log=data.draw(st.booleans()),
        seconds=data.draw(st.none() | st.floats(0.1, 1e6)),
    ).picture
    assert size(picture) == (max(width, 20), max(height, 4))
    assert "nan" not in picture.text
    assert "inf" not in picture.text


@settings(max_examples=100)
@example([([(1.0, 5e-324), (1.0, 1e308)], False)], 20, 6)
@given(
    st.lists(st.tuples(st.lists(st.tuples(ANY, ANY), max_size=8), st.booleans()), max_size=5),
    st.integers(1, 70),
    st.integers(1, 25),
)
def test_any_points_make_a_loglog_chart(data, width, height):
    series = [
        Series(ink, "esvr?"[ink], [x for x, _ in points], [y for _, y in points], dotted)
        for ink, (points, dotted) in enumerate(data)
    ]
    chart = loglog_chart(series, width, height, x_label="h [s]", y_label="error")
    assert size(chart.picture) == (max(width, 20), max(height, 6))


@pytest.mark.parametrize(
    ("columns", "back", "half_swing", "apart", "crosses"),
    [
        (3, 0, 0, 5, 0),
        (4, 0, 3, 5, 1),
        (4, 0, 4, 5, 0),
        (96, 0, 3.5, 5, 1),  # half a swing before the first column is seen
        (96, 0, 3.6, 5, 0),
        (50, 0, 0, 0.5, 1),
        (50, 0, 0, 0.49, 0),
        (50, 1, 0, 5, 0),  # it may not last
    ],
)
def test_a_pass_lasts_for_a_25th_of_the_chart_and_half_a_swing_to_the_end(
    columns, back, half_swing, apart, crosses
):
    at = np.arange(100)
    later = np.where((at < 100 - columns) | (at >= 100 - back), 10.0 - apart, 10.0 + apart)
    heights = np.column_stack((np.full(100, 10.0), later))
    assert len(_crossings(heights, np.arange(100.0) + 0.5, half_swing)) == crosses


@pytest.mark.parametrize(("apart", "crosses"), [(2.5, [30, 60]), (2.4, [60])])
def test_a_pass_is_marked_that_is_half_as_clear_as_the_clearest(apart, crosses):
    moments = np.arange(100.0)
    heights = [
        np.full(100, 20.0),
        np.where(moments < 60, 15.0, 25.0),
        np.full(100, 90.0),
        np.where(moments < 30, 90 - apart, 90 + 3 * apart),
    ]
    found = _crossings(np.column_stack(heights), moments, 0.0)
    assert sorted(column for column, _ in found) == pytest.approx(crosses, abs=1)
    for columns, passes in (([19, 1, 0], []), ([18, 2, 0], [5.0]), ([9, 1, 10], [])):
        heights = np.repeat([[1, 9], [9, 1], [1, 9]], columns, axis=0)
        assert [height for _, height in _crossings(heights, np.arange(20.0), 0.0)] == passes


@given(st.lists(st.floats(-2, 25), max_size=8), st.integers(1, 20))
def test_letters_have_rows_of_their_own_in_the_order_of_their_lines(wanted, room):
    wanted = sorted(wanted)
    rows = spread(wanted, room)
    assert rows == sorted(rows)
    assert all(0 <= row < room for row in rows)
    if len(wanted) <= room:
        assert len(set(rows)) == len(rows)
    own = [math.floor(each + 0.5) for each in wanted]
    if len(set(own)) == len(own) and all(0 <= row < room for row in own):
        assert rows == own  # moved only where they must


RECORDED = np.linspace(0, 50, 4000)
ERRORS = 1e-3 * np.sin(7 * RECORDED) + 1e-4 * RECORDED


def record(size=(80, 16), errors=ERRORS, slope=1e-4, deviation=7e-4, unit="ps"):
    return record_chart(
        RECORDED, errors, size, slope=slope, deviation=deviation, title="energy error", unit=unit
    )


def rows_of(picture, ink):
    """Return the rows with dots of this ink, from the top."""
    return sorted({row for _, row in places(picture, ink)})


def test_energy_trend_and_axes_fill_the_size_given(snapshot):
    picture = record()
    snapshot("record.txt", look(picture))
    assert size(picture) == (80, 16)
    spike = ERRORS.copy()
    spike[2001] = 0.05
    assert rows_of(record(errors=spike), ENERGY)[0] <= 2  # a column spans all errors in it
    assert [bool(rows_of(record(slope=slope), TREND)) for slope in (0.0, None)] == [True, False]
    assert " 50 ─" in record(unit="").text


@pytest.mark.parametrize("room", [(20, 6), (21, 40), (200, 10), (19, 6), (20, 5)])
def test_any_size_from_20_by_6_has_a_chart(room):
    columns, rows = room
    assert size(record(size=room)) == (max(columns, 20), max(rows, 6))
