"""Numbers as people write them."""

import math

import pytest

from pendu_tui.engine.inputs import angle, did_you_mean, number, seconds, start_angle


@pytest.mark.parametrize(
    ("read", "text", "value"),
    [
        (number, "0.05", 0.05),
        (number, "5%", 0.05),
        (angle, "2", 2.0),
        (angle, "2rad", 2.0),
        (angle, "90deg", math.pi / 2),
        (angle, "90°", math.pi / 2),
        (angle, "30deg/s", math.pi / 6),
        (angle, "+pi/2", math.pi / 2),
        (angle, "-2pi/3", -2 * math.pi / 3),
        (angle, "-0.5*π", -math.pi / 2),
        (start_angle, "6.28", 6.28),
        (start_angle, "inf", math.inf),  # a scene says within which limits
        (start_angle, "-6.29rad", -6.29),
        (start_angle, "3pi", 3 * math.pi),
        (start_angle, "400deg", math.radians(400)),
        (seconds, "2", 2.0),
        (seconds, "2s", 2.0),
        (seconds, "50ms", 0.05),
        (seconds, "20us", 2e-5),
        (seconds, "20 µs", 2e-5),
        (seconds, "2min", 120.0),
        (seconds, "1.5h", 5400.0),
    ],
)
def test_a_number_is_read_in_its_unit(read, text, value):
    assert read(text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("read", "text", "why"),
    [
        *((number, text, "a number; use") for text in ("", "2s", "1,5")),
        *((angle, text, "an angle; use") for text in ("2m", "pi/0", "deg")),
        *((start_angle, text, r"is 1\.0 turns") for text in ("6.29", "-6.29")),
        (start_angle, "115", r"115 is 18\.3 turns; write 115deg or 115rad"),
        *((seconds, text, "a time; use") for text in ("2deg", "s", "1 2")),
    ],
)
def test_what_is_no_such_number_is_refused(read, text, why):
    with pytest.raises(ValueError, match=why):
        read(text)


def test_a_suggestion_is_alike_in_any_case():
    assert did_you_mean("enrgy", ["Energy"]) == ": did you mean Energy?"
    assert did_you_mean("--heta", ["--theta"])  # much alike
    assert not did_you_mean("xnexgy", ["energy"])
