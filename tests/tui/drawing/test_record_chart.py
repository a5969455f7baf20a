"""The chart of a record: its energy, its trend and its band, in any size."""

import numpy as np
import pytest

from pendu_tui.tui.drawing.plotted import ENERGY, TREND, record_chart
from tests.tui.drawn import look, places, size

TIMES = np.linspace(0, 50, 4000)
ERRORS = 1e-3 * np.sin(7 * TIMES) + 1e-4 * TIMES


def chart(size=(80, 16), errors=ERRORS, slope=1e-4, deviation=7e-4, unit="ps"):
    return record_chart(
        TIMES, errors, size, slope=slope, deviation=deviation, title="energy error", unit=unit
    )


def rows_of(picture, ink):
    """Return the rows with dots of this ink, from the top."""
    return sorted({row for _, row in places(picture, ink)})


def test_energy_trend_and_axes_fill_the_size_given(snapshot):
    picture = chart()
    snapshot("record.txt", look(picture))
    assert size(picture) == (80, 16)
    spike = ERRORS.copy()
    spike[2001] = 0.05
    assert rows_of(chart(errors=spike), ENERGY)[0] <= 2  # a column spans all errors in it
    assert [bool(rows_of(chart(slope=slope), TREND)) for slope in (0.0, None)] == [True, False]
    assert " 50 ─" in chart(unit="").text


@pytest.mark.parametrize("room", [(20, 6), (21, 40), (200, 10), (19, 6), (20, 5)])
def test_any_size_from_20_by_6_has_a_chart(room):
    columns, rows = room
    assert size(chart(size=room)) == (max(columns, 20), max(rows, 6))
