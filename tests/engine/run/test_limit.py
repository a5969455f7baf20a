"""The three outcomes of a limit on a number with a bound."""

import math

import numpy as np
import pytest

from pendu_tui.engine.run.verdicts import advice, outcome


@pytest.mark.parametrize(
    ("value", "bound", "limit", "expected"),
    [
        (1.0, 2.0, 2.0, "below"),
        (1.0, 2.0, 1.999, "cannot tell"),
        (5.0, 6.0, 3.999, "above"),
        (5.0, 6.0, 4.001, "cannot tell"),
        (-5.0, -4.0, -3.0, "below"),
        (0.0, 0.0, 0.0, "below"),
        (None, None, 1.0, "cannot tell"),
        (math.nan, 0.1, 1.0, "cannot tell"),
        (0.0, math.inf, 1.0, "cannot tell"),
    ],
)
def test_a_number_is_below_above_or_not_known(value, bound, limit, expected):
    assert outcome(value, bound, limit) == expected


def test_the_advice_is_the_length_at_which_white_noise_would_tell():
    def bound(length):
        """Return 2.58 standard errors of the slope of white noise."""
        times = np.arange(length) - (length - 1) / 2
        return 2.58 / math.sqrt(times @ times)

    assert "about 4 times as long" in advice(0.0, bound(1000), limit=bound(1000) / 8)
    assert bound(4000) == pytest.approx(bound(1000) / 8, rel=1e-3)


def test_no_length_tells_whether_a_drift_is_above_itself():
    assert "may not" in advice(1.0, 2.0, limit=1.0)
