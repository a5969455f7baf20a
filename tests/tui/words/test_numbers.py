import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tui.words.numbers import angle, decimal, file_size, scientific, seconds

ANY = st.floats(allow_nan=True, allow_infinity=True) | st.none()
WIDTHS = st.integers(1, 14)


@given(ANY, WIDTHS, st.integers(0, 6))
def test_a_number_is_exactly_as_wide_as_asked_and_never_nan_or_inf(value, width, digits):
    for text in (decimal(value, width, digits), scientific(value, width, digits)):
        assert len(text) == width
        assert "n" not in text


@given(st.floats(allow_nan=False, allow_infinity=False, allow_subnormal=False), st.integers(8, 14))
def test_what_is_written_is_the_number_to_the_digits_that_are_written(value, width):
    text = decimal(value, width)
    shown = float(text)
    mantissa, _, exponent = text.strip().partition("e")
    places = len(mantissa.partition(".")[2])
    half = 0.5 * 10.0 ** (int(exponent or 0) - places)
    assert math.isinf(shown) or abs(shown - value) <= 1.0002 * half  # float(text) rounds once more


def test_an_angle_keeps_its_decimals_until_the_width_is_used_up_and_then_turns_scientific():
    assert [
        decimal(theta, 8) for theta in (1.0, -31.4159265, 12345.6789, -1234567.8, 1.5e9, -1e150)
    ] == [
        "  +1.000",
        " -31.416",
        "+12345.7",
        "-1234568",
        "+1.5e+09",
        " -1e+150",
    ]


@pytest.mark.parametrize("value", [None, math.nan, math.inf, -math.inf])
def test_what_is_not_a_number_is_a_hyphen(value):
    assert decimal(value, 4) == scientific(value, 4) == "   -"


def test_a_number_that_cannot_fit_is_not_cut_to_a_wrong_one():
    assert scientific(1.5e-300, 5) == "#####"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0.00 s"),
        (-0.001, "0.00 s"),
        (12.345, "12.35 s"),
        (59.994, "59.99 s"),
        (59.996, "1 min 00 s"),
        (185, "3 min 05 s"),
        (-185, "-3 min 05 s"),
        (3599.6, "1 h 00 min"),
        (3720, "1 h 02 min"),
        (86399, "1 d 00 h"),
        (3 * 86400 + 4 * 3600, "3 d 04 h"),
        (1e12, "1.0e+12 s"),
        (math.inf, "-"),
    ],
)
def test_times_read_as_people_say_them(value, text):
    assert seconds(value) == text


@pytest.mark.parametrize(
    ("count", "text"),
    [
        (0, "0 B"),
        (999, "999 B"),
        (1000, "1.0 kB"),
        (9_960, "10 kB"),
        (96_400, "96 kB"),
        (999_600, "1.0 MB"),
        (12_345_678, "12 MB"),
        (5 * 10**15, "5000 TB"),
    ],
)
def test_sizes_have_two_or_three_digits(count, text):
    assert file_size(count) == text


def test_an_angle_beyond_a_turn_is_turns_and_the_rest():
    assert angle(-30.52848, 14, 5) == "-5 turns +0.89"
    assert angle(-30.52848, 6, 3) == "-30.53"
    assert angle(3.0, 11, 5) == "   +3.00000"
    assert angle(math.nan, 6, 3).strip() == "-"
