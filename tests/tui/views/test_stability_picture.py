"""The map of stability, in colours and by its characters alone."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.studies.stability import (
    CELL,
    CHAOTIC,
    GROWS,
    HOLDS,
    LOSES,
    OVER_THE_TOP,
    UNKNOWN,
    Grid,
)
from pendu_tui.tui.drawing.frame import Axis, Frame
from pendu_tui.tui.drawing.picture import PALETTES, Picture
from pendu_tui.tui.views import stability as drawing

STEPS = 1000
GRID = Grid((np.arange(12) + 0.5) * math.pi / 12, (np.arange(30) + 0.5) / 10, STEPS)


def half_lost() -> np.ndarray:
    """Every method holds below z = 1.5, and above loses a large swing later than a small one."""
    cells = GRID.unknown()
    cells[:15] = np.array((STEPS, 1e-13, HOLDS), CELL)
    cells[15:, :, :6] = np.array((5, 1.0, GROWS), CELL)
    cells[15:, :, 6:] = np.array((500, 1.0, GROWS), CELL)
    return cells


DARK = PALETTES["dark"]


FRAME = Frame(Axis(0.0, 3.0, {1.0: "1", 2.0: "2"}), Axis(0.0, math.pi, {math.pi / 2: "90"}), 30, 6)


def panel(cells, index, **options) -> str:
    values = drawing.scores(cells[:, index], STEPS)
    method = USUAL_CAST[index]
    rows = drawing.panel(FRAME, values, method, index, DARK, title=method.label, **options)
    return Picture(rows).text


def test_the_characters_alone_tell_held_from_lost_and_theory_is_where_it_belongs(snapshot):
    here = (0.55, math.radians(75))  # where the catching orbit is at z = 2.328
    striped = half_lost()
    striped[15:20, :, 0::2] = held = striped[0, 0, 0]  # the lower pixel of each row
    striped[20:, :, 1::2] = held
    striped[:5, :, 0::2] = striped[5:10, :, 1::2] = np.array((0, 0.0, UNKNOWN), CELL)
    texts = [panel(half_lost(), 3), panel(half_lost(), 2, here=here), panel(GRID.unknown(), 0)]
    texts += panel(half_lost(), 1), panel(striped, 0)
    snapshot("stability.txt", "\n\n".join(texts) + "\n")


@given(
    st.tuples(st.integers(1, 30), st.integers(1, 20)),
    st.tuples(st.integers(1, 40), st.integers(1, 30)),
    st.randoms(),
)
def test_no_failure_vanishes_however_small_the_picture(shape, size, random):
    values = np.array([[random.random() for _ in range(shape[1])] for _ in range(shape[0])])
    drawn = drawing.worst(values, *size)
    assert drawn.shape == size[::-1]
    assert drawn.min() == values.min()
    assert set(drawn.flat) <= set(values.flat)


def test_scores_go_from_unknown_and_lost_at_once_to_held_exactly():
    ends = [(0, 0.0, UNKNOWN), (0, 1.0, LOSES), (STEPS, 1e-12, HOLDS)]
    assert [*drawing.scores(np.array(ends, CELL), STEPS)] == [-1, 0, 2]


@pytest.mark.parametrize("theme", PALETTES)
@pytest.mark.parametrize("ink", range(10))
def test_colours_of_held_lost_and_unknown_swings_differ_for_every_method(theme: str, ink: int):
    palette = PALETTES[theme]
    held = {drawing.colour(score, ink, palette) for score in (1.0, 1.5, 1.9)}
    lost = {drawing.colour(score, ink, palette) for score in (0.0, 0.5, 0.9)}
    # sixteen colours have no shades of how soon
    assert len(lost) == (3 if palette.warn.startswith("#") else 1)
    assert not held & lost
    assert drawing.colour(-1, ink, palette) not in held | lost


RK4 = USUAL_CAST[3]
LADDER_GRID = Grid(np.array([math.pi / 2]), np.array([0.5, 1.0, 1.5, 2.0, 2.5]), 300, (RK4,))


def cells(*rows: tuple[int, float, int]) -> np.ndarray:
    """Outcomes (z, method, theta)."""
    return np.array([*rows], CELL).reshape(-1, 1, 1)


LADDER = cells(
    (300, 1e-3, HOLDS),
    (300, 2e-2, HOLDS),
    (300, 0.2, CHAOTIC),
    (40, 0.9, OVER_THE_TOP),
    (3, 5.0, GROWS),
)
BEGUN = cells((300, 1e-3, HOLDS), *[(0, 0.0, UNKNOWN)] * 4)
HELD = cells(*[(300, 1e-3, HOLDS)] * 5)
LOST = cells(*[(0, 2.0, GROWS)] * 5)


@pytest.mark.parametrize(
    ("outcomes", "z", "sentence"),
    [
        (LADDER, 1, "0.5 s, 90°: held, error 2e-2; lost at h 0.75 s"),
        (LADDER, 2, "0.75 s, 90°: chaotic; held at h 0.5 s"),
        (LADDER, 3, "1 s, 90°: over the top, step 41; held at h 0.5 s"),
        (LADDER, 4, "1.25 s, 90°: grows, step 4; held at h 0.5 s"),
        (HELD, 0, "0.25 s, 90°: held, error 1e-3; held at every h on this map"),
        (LOST, 0, "0.25 s, 90°: grows, step 1; lost at every h on this map"),
        (BEGUN, 0, "0.25 s, 90°: held, error 1e-3; not lost at any h so far"),
        (LADDER_GRID.unknown(), 0, "0.25 s, 90°: not computed yet"),
    ],
)
def test_a_verdict_tells_the_outcome_and_the_nearest_cliff(outcomes, z, sentence):
    assert drawing.verdict(LADDER_GRID, outcomes, 0, (z, 0), w0=2.0) == f"RK4 at h {sentence}"
