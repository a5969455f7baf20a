"""One swing of the map in words, and the warning on the status line."""

import math

import numpy as np
import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.studies import stability as fates
from pendu_tui.engine.studies.stability import Grid
from pendu_tui.tui.screens.lines import limit_warning
from pendu_tui.tui.views.stability import note, verdict

VERLET, RK4 = USUAL_CAST[2:]
GRID = Grid(np.array([math.pi / 2]), np.array([0.5, 1.0, 1.5, 2.0, 2.5]), 300, (RK4,))


def cells(*rows: tuple[int, float, int]) -> np.ndarray:
    """Outcomes (z, method, theta)."""
    return np.array([*rows], fates.CELL).reshape(-1, 1, 1)


LADDER = cells(
    (300, 1e-3, fates.HOLDS),
    (300, 2e-2, fates.HOLDS),
    (300, 0.2, fates.HOLDS),
    (40, 0.9, fates.OVER_THE_TOP),
    (3, 5.0, fates.GROWS),
)
BEGUN = cells((300, 1e-3, fates.HOLDS), *[(0, 0.0, fates.UNKNOWN)] * 4)
HELD = cells(*[(300, 1e-3, fates.HOLDS)] * 5)
LOST = cells(*[(0, 2.0, fates.GROWS)] * 5)


@pytest.mark.parametrize(
    ("outcomes", "z", "sentence"),
    [
        (LADDER, 1, "0.5 s, 90°: held, energy error 2.0e-02; lost at h 1 s"),
        (LADDER, 3, "1 s, 90°: lost at step 41, over the top; held at h 0.75 s"),
        (LADDER, 4, "1.25 s, 90°: lost at step 4, grows; held at h 0.75 s"),
        (HELD, 0, "0.25 s, 90°: held, energy error 1.0e-03; held at every h on this map"),
        (LOST, 0, "0.25 s, 90°: lost at step 1, grows; lost at every h on this map"),
        (BEGUN, 0, "0.25 s, 90°: held, energy error 1.0e-03; no loss found yet"),
        (GRID.unknown(), 0, "0.25 s, 90°: not computed yet"),
    ],
)
def test_a_verdict_tells_the_outcome_and_the_nearest_cliff(outcomes, z, sentence):
    assert verdict(GRID, outcomes, 0, (z, 0), w0=2.0) == f"RK4 at h {sentence}"


@pytest.mark.parametrize(
    ("theta", "z", "text"), [(0.5, 1.43, "held, larger wobble, 6e-01"), (1.0, 1.52, "chaotic")]
)
def test_a_symplectic_swing_wobbles_at_a_resonance_or_is_chaotic(theta, z, text):
    (cell,) = fates.outcomes(VERLET, np.array([theta]), np.array([z]), 2000)
    assert note(cell) == text


@pytest.mark.parametrize(
    ("zs", "warning"),
    [
        ([2.82] * 4, "unstable: e, s v (z > 2)"),
        ([2.9] * 4, "unstable: e, s v (z > 2), r (z > 2.83)"),
        ([0.725, 0.725, 0.725, 2.9], "unstable: e, r (z > 2.83)"),  # at equal cost
    ],
)
def test_a_step_beyond_a_linear_limit_is_warned_of(zs, warning):
    assert limit_warning(dict(zip(USUAL_CAST, zs, strict=True))) == warning
