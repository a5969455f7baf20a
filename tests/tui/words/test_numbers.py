"""Numbers and the exact motion as text."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.scenes import Scene
from pendu_tui.tui.words.numbers import (
    SIGNED,
    UNSIGNED,
    about,
    counted,
    decimal,
    energy_share,
    factor,
    file_size,
    fitting,
    motion_text,
    regime,
    seconds,
    two_digits,
    z_text,
)

ANY = st.floats(allow_nan=True, allow_infinity=True) | st.none()
W0 = Scene().w0
MODEL = Scene().equations
NEAR_THE_TOP = math.pi - 1e-6
TEXTS = {
    (decimal, -1234567.8, 8, 3): "-1234568",
    (decimal, 1.5e9, 8, 3): "+1.5e+09",
    (decimal, -1e150, 8, 3): " -1e+150",
    (decimal, math.nan, 3, 1): "  -",
    (decimal, 0.99996, 9, 4): "  +1.0000",
    (fitting, 1.5e-300, 5, *SIGNED): "#####",  # not cut to a wrong one
    (fitting, 3.26e-5, 7, *UNSIGNED): "3.3e-05",
    (fitting, 3.26e-5, 5, *UNSIGNED): "3e-05",
    (seconds, -0.004): "0.00 s",
    (seconds, 59.996): "1 min 00 s",
    (seconds, 12.345): "12.35 s",
    (seconds, -185): "-3 min 05 s",
    (seconds, 3599): "59 min 59 s",
    (seconds, 3599.6): "1 h 00 min",
    (seconds, 86340): "23 h 59 min",
    (seconds, 86399): "1 d 00 h",
    (seconds, 3 * 86400 + 4 * 3600): "3 d 04 h",
    (seconds, 9.9e8): "11458 d 08 h",
    (seconds, 1e9): "1.0e+09 s",
    (seconds, math.inf): "-",
    (about, 0.5): "0.5 s",
    (about, 9.94): "9.9 s",
    (about, 9.95): "10 s",
    (about, 119): "119 s",
    (about, 120): "2 min",
    (about, 7199): "120 min",
    (about, 7200): "2 h",
    (about, 172_799): "48 h",
    (about, 172_800): "2 days",
    (factor, 0.125): "1/8",
    (factor, -0.5): "-1/2",
    (factor, 0.3): "0.3",
    (factor, 999.96): "999.96",
    (factor, 1.0): "1",
    (factor, 2.0**18): "262144",
    (factor, 0.0): "0",
    (factor, 5e-324): "4.94065646e-324",
    (two_digits, 0.000294): "0.00029",
    (two_digits, 9.94): "9.9",
    (two_digits, 9.95): "10",
    (two_digits, 99_999): "99999",
    (two_digits, 99_999.5): "1.0e+05",
    # near the separatrix, the distance from it
    (energy_share, MODEL, 0.0, 4 * W0): "4",
    (energy_share, MODEL, 0.0, 2 * W0): "1",
    (energy_share, MODEL, NEAR_THE_TOP, 0.0): "1 - 2.5e-13",
    (energy_share, MODEL, math.pi, 2e-6 * W0): "1 + 1.0e-12",
    (energy_share, MODEL, math.acos(2 * 0.9e-3 - 1), 0.0): "1 - 9.0e-04",
    (energy_share, MODEL, math.acos(2 * 1.1e-3 - 1), 0.0): "0.9989",
    (motion_text, Scene(), Scene().exact()): "exact period 2.13914 s  E/Es 0.2298  libration",
    (counted, 0, "run"): "0 runs",
    (file_size, 640): "640 bytes",
    (file_size, 96_400): "96.4 kB",
    (z_text, Scene(), 3): "z = h·w0 = 0.157",
    (regime, MODEL, NEAR_THE_TOP, 0.0): "libration",
    (regime, MODEL, NEAR_THE_TOP, 1e-5): "rotation",
    (regime, MODEL, 0.0, 2 * W0): "separatrix",
}


@given(ANY, st.integers(1, 14), st.integers(0, 6))
def test_a_number_is_exactly_as_wide_as_asked_and_never_nan_or_inf(value, width, digits):
    for text in (decimal(value, width, digits), fitting(value, width, *SIGNED)):
        assert len(text) == width
        assert "n" not in text
        assert (text.strip() == "-") == (value is None or not math.isfinite(value))


@pytest.mark.parametrize("call", TEXTS, ids=lambda call: TEXTS[call])
def test_numbers_and_the_exact_motion_as_text(call):
    write, *arguments = call
    assert write(*arguments) == TEXTS[call]
