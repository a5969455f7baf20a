import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.methods import GENERAL
from engine.stability.grid import Grid
from engine.stability.outcomes import CELL, GROWS, HOLDS, LOSES, UNKNOWN
from tui.drawing.palette import PALETTES
from tui.drawing.picture import Picture
from tui.views.stability.picture import (
    CATCHING,
    LIMIT,
    THRESHOLD,
    character,
    colour,
    panel,
    picture,
    scores,
    theory,
    worst,
)

STEPS = 1000


def cell(steps: int, error: float, fate: int) -> np.ndarray:
    return np.array((steps, error, fate), CELL)


def half_lost(fate: int = GROWS) -> tuple[Grid, np.ndarray]:
    """A made-up map: every method holds below z = 1.5, and above loses a large swing later than a small one."""
    grid = Grid((np.arange(12) + 0.5) * math.pi / 12, (np.arange(30) + 0.5) / 10, STEPS)
    cells = grid.unknown()
    cells[:15] = cell(STEPS, 1e-6, HOLDS)
    cells[15:, :, :6] = cell(5, 1.0, fate)
    cells[15:, :, 6:] = cell(500, 1.0, fate)
    return grid, cells


def text(lines: list) -> str:
    return Picture(lines).text


def test_a_panel_without_colour_is_readable_characters():
    grid, cells = half_lost()
    assert text(panel(grid, cells, 3, columns=34, rows=6, palette=None)) == (
        "    4 r RK4\n"
        "    ###############2222222222222|2\n"
        "135 ###############2222222222222|2\n"
        "    ###############2222222222222|2\n"
        " 90 ###############.............|.\n"
        " 45 ###############.............|.\n"
        "    ###############.............|.\n"
        "              1         2 z"
    )


def test_theory_is_drawn_where_it_belongs():
    grid, cells = half_lost()
    assert text(panel(grid, cells, 2, columns=34, rows=6, palette=None)) == (
        "    3 v Velocity Verlet\n"
        "    #########:#####22222|222222222\n"  # Greene's z = 0.986, the linear limit 2
        "135 #########:#####22222|222222222\n"
        "    #########:#####22222|222222222\n"  # the catching orbit, unstable at q = 105 deg:
        " 90 #########:#####.....|..o......\n"  # z = 2.328 at 75 deg
        " 45 #########:#####.....|o........\n"  # and 2.108 at 45 deg
        "    #########:#####.....|.........\n"
        "              1         2 z"
    )


def test_theory_is_drawn_for_the_methods_that_it_is_about():
    grid, _ = half_lost()
    signs = {method.key: {sign for _, _, sign in theory(method, grid, 6)} for method in GENERAL}
    assert signs["velocity_verlet"] == {LIMIT, THRESHOLD, CATCHING}
    assert signs["symplectic_euler"] == {LIMIT, THRESHOLD}
    assert signs["explicit_euler"] == set()
    assert all(
        signs[key] == {LIMIT} for key in ("rk4", "forest_ruth", "blanes_moan_4", "blanes_moan_6")
    )


def test_the_whole_picture_fits_eighty_columns_and_names_every_method():
    grid, cells = half_lost()
    for palette in (None, *PALETTES.values()):
        lines = picture(grid, cells, 80, palette).text.splitlines()
        assert max(map(len, lines)) <= 80
        assert len(lines) <= 24
        for index, method in enumerate(grid.methods, 1):
            assert any(f"{index} {method.letter} {method.label}" in line for line in lines)


def test_you_are_here_is_marked():
    grid, cells = half_lost()
    lines = text(panel(grid, cells, 0, 34, 6, None, here=(0.95, math.radians(75)))).splitlines()
    assert lines[4][4 + 9] == "@"


def test_what_is_not_computed_yet_is_blank():
    grid, _ = half_lost()
    lines = text(panel(grid, grid.unknown(), 0, 34, 6, None)).splitlines()
    assert all(line[4:].strip() == "" for line in lines[1:-1])


@given(
    st.tuples(st.integers(1, 30), st.integers(1, 20)),
    st.tuples(st.integers(1, 40), st.integers(1, 30)),
    st.randoms(),
)
def test_no_failure_vanishes_however_small_the_picture(shape, character_set, random):
    values = np.array([[random.random() for _ in range(shape[1])] for _ in range(shape[0])])
    drawn = worst(values, *character_set)
    assert drawn.shape == (character_set[1], character_set[0])
    assert drawn.min() == values.min()
    if character_set[0] >= shape[0] and character_set[1] >= shape[1]:
        assert set(drawn.flat) <= set(values.flat)


def test_scores_rise_from_lost_at_once_to_held_exactly():
    order = [
        cell(0, 0.0, UNKNOWN),
        cell(0, 1.0, LOSES),
        cell(10, 1.0, GROWS),
        cell(999, 1.0, GROWS),
        cell(STEPS, 0.5, HOLDS),
        cell(STEPS, 1e-3, HOLDS),
        cell(STEPS, 1e-12, HOLDS),
    ]
    rising = scores(np.array(order, CELL), STEPS)
    assert (np.diff(rising) > 0).all()
    assert rising[[0, 1, -1]].tolist() == [-1, 0, 2]


@given(st.integers(0, 10**6 - 1))
def test_a_lost_swings_character_is_the_power_of_ten_it_survived(survived: int):
    score = float(scores(np.array([cell(survived, 1.0, GROWS)], CELL), 10**6)[0])
    assert character(score, 10**6) == ("." if survived < 10 else str(int(math.log10(survived))))


@pytest.mark.parametrize(
    ("error", "sign"), [(1e-9, "#"), (0.9e-4, "#"), (1.1e-4, "+"), (0.09, "+"), (0.11, "-")]
)
def test_a_held_swings_character_is_its_energy_error(error: float, sign: str):
    assert (
        character(float(scores(np.array([cell(STEPS, error, HOLDS)], CELL), STEPS)[0]), STEPS)
        == sign
    )


@pytest.mark.parametrize("theme", PALETTES)
@pytest.mark.parametrize("ink", range(10))
def test_colours_of_held_lost_and_unknown_swings_differ_for_every_method(theme: str, ink: int):
    palette = PALETTES[theme]
    held = {colour(score, ink, palette) for score in (1.0, 1.5, 1.9)}
    lost = {colour(score, ink, palette) for score in (0.0, 0.5, 0.9)}
    assert len(lost) == (
        3 if palette.warn.startswith("#") else 1
    )  # sixteen colours have no shades of how soon
    assert not held & lost
    assert colour(-1, ink, palette) not in held | lost
