import math

import numpy as np
import pytest

from engine.methods import USUAL_CAST
from engine.stability.outcomes import (
    CAUGHT,
    CELL,
    GROWS,
    HOLDS,
    LOSES,
    OVER_THE_TOP,
    UNKNOWN,
    outcomes,
)
from tui.screens.status_line import limit_warning
from tui.views.stability.words import note, verdict

EULER, _, VERLET, RK4 = USUAL_CAST
ZS = np.array([0.5, 1.0, 1.5, 2.0, 2.5])


def cells(*rows: tuple[int, float, int]) -> np.ndarray:
    return np.array(list(rows), CELL)


LADDER = cells(
    (300, 1e-3, HOLDS),
    (300, 2e-2, HOLDS),
    (300, 0.2, HOLDS),
    (40, 0.9, OVER_THE_TOP),
    (3, 5.0, GROWS),
)


@pytest.mark.parametrize(
    ("at", "sentence"),
    [
        (1, "RK4 at h 0.5 s, 90°: held, energy error 2.0e-02; lost at h 1 s"),
        (3, "RK4 at h 1 s, 90°: lost at step 41, over the top; held at h 0.75 s"),
        (4, "RK4 at h 1.25 s, 90°: lost at step 4, grows; held at h 0.75 s"),
    ],
)
def test_a_verdict_says_what_happens_and_where_the_nearest_cliff_is(at: int, sentence: str):
    assert verdict(RK4, math.pi / 2, ZS, LADDER, at, w0=2.0) == sentence


def test_a_verdict_says_when_there_is_no_cliff_or_no_verdict_yet():
    held, lost = cells(*[(300, 1e-3, HOLDS)] * 5), cells(*[(0, 2.0, GROWS)] * 5)
    assert verdict(RK4, 1.0, ZS, held, 0, 1.0).endswith("; held at every h on this map")
    assert verdict(RK4, 1.0, ZS, lost, 0, 1.0).endswith("; lost at every h on this map")
    assert verdict(RK4, 1.0, ZS, cells(*[(0, 0.0, UNKNOWN)] * 5), 0, 1.0).endswith(
        "not computed yet"
    )


@pytest.mark.parametrize(
    ("cell", "text"),
    [
        ((300, 2.34e-3, HOLDS), "held, 2e-03"),
        ((300, 2.34e-3, CAUGHT), "caught, 2e-03"),
        ((80, 0.5, LOSES), "loses, step 81"),
        ((3, 0.5, GROWS), "grows, step 4"),
        ((0, 0.0, UNKNOWN), "…"),
    ],
)
def test_a_note_fits_behind_a_methods_name(cell, text):
    assert note(np.array(cell, CELL)) == text


@pytest.mark.parametrize(
    ("theta", "z", "what"), [(0.5, 1.43, "held, larger wobble, 6e-01"), (1.0, 1.52, "chaotic")]
)
def test_a_symplectic_swing_wobbles_at_a_resonance_or_is_chaotic(theta: float, z: float, what: str):
    (cell,) = outcomes(VERLET, np.array([theta]), np.array([z]), 2000)
    assert note(cell) == what


@pytest.mark.parametrize(
    ("z", "warning"),
    [
        (0.5, ""),
        (2.0, ""),
        (2.05, "unstable: e, s v (z > 2)"),
        (2.82, "unstable: e, s v (z > 2)"),
        (2.9, "unstable: e, s v (z > 2), r (z > 2.83)"),
    ],
)
def test_a_step_beyond_a_linear_limit_is_warned_of(z: float, warning: str):
    assert limit_warning(USUAL_CAST, [z] * 4) == warning


def test_at_equal_cost_only_the_dearest_method_may_be_beyond_its_limit():
    assert limit_warning(USUAL_CAST, [0.7, 0.7, 0.7, 2.8]) == ""
    assert limit_warning(USUAL_CAST, [0.725, 0.725, 0.725, 2.9]) == "unstable: e, r (z > 2.83)"
