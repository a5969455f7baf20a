"""The phase portrait as pictures made of text."""

import math

import numpy as np
import pytest

from pendu_tui.engine.methods import USUAL_CAST
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.drawing.picture import EXACT, FAINT
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.views.portrait import (
    SPARSE,
    PhasePoint,
    Portrait,
    method_points,
    phase_picture,
)
from pendu_tui.tui.views.viewport import Viewport
from tests.tui.drawn import cells, places

DRIFT = SCENES["drift"]
SMALL = Viewport.portrait(46, 15, DRIFT)
PORTRAIT = Portrait.of(SMALL, DRIFT.equations)
PLAIN = phase_picture(PORTRAIT, [])


def test_what_is_not_a_number_is_not_drawn():
    nowhere = PhasePoint(math.nan, math.nan, 0, "e", ring=(np.full(3, math.nan), np.zeros(3)))
    assert phase_picture(PORTRAIT, [nowhere]) == PLAIN


@pytest.mark.parametrize(("theta", "omega"), [(0.0, 0.0), (-3.0, -5.0), (1.0 + math.tau, 2.0)])
def test_points_are_drawn_where_their_state_is_with_their_letters_beside_it(theta, omega):
    points = [PhasePoint(theta, omega, i, each.letter) for i, each in enumerate(USUAL_CAST)]
    shown = cells(phase_picture(PORTRAIT, points)).values()
    assert {(point.letter, point.ink) for point in points} <= set(shown)
    picture = phase_picture(PORTRAIT, [points[2]])
    column, row = int(SMALL.x(theta)) // 2, int(SMALL.y(omega)) // 4
    mine = places(picture, 2)
    assert (column, row) in mine
    assert cells(picture)[row, column + 2][0] == "v"
    assert all(abs(c - column) <= 2 and abs(r - row) <= 1 for c, r in mine)


def test_a_trail_is_faint_and_where_the_method_was():
    theta, omega = np.linspace(0.5, 1.0, SPARSE + 1), np.linspace(1.0, 2.0, SPARSE + 1)
    picture = phase_picture(PORTRAIT, [PhasePoint(1.5, 3.0, 1, "s", (theta, omega))])
    pairs = zip(theta.tolist(), omega.tolist(), strict=True)
    expected = {(int(SMALL.x(a)) // 2, int(SMALL.y(b)) // 4) for a, b in pairs}
    assert places(picture, 1 + FAINT) == expected


@pytest.mark.parametrize(("z", "joined"), [(0.25, False), (0.35, True), (0.95, True), (1.1, False)])
def test_steps_are_joined_that_are_neither_close_nor_far_apart(z, joined):
    live = Live(DRIFT.altered(h=z / DRIFT.w0))
    points = method_points(live, live.sample, Shown(), None)
    assert {point.chords > 0 for point in points} == {joined}


def test_a_moving_point_takes_the_place_of_a_word():
    lines = PLAIN.text.splitlines()
    row = next(y for y, line in enumerate(lines) if "libration" in line)
    column = lines[row].index("libration") + 4
    picture = phase_picture(PORTRAIT, [PhasePoint(*SMALL.at_cell(column, row), 0, "e")])
    assert cells(picture)[row, column][1] == 0
    assert "libration" not in picture.text


def ring_around(theta: float, radius: float):
    angle = np.linspace(0, math.tau, 64, endpoint=False)
    ring = theta + radius * np.cos(angle), DRIFT.w0 * radius * np.sin(angle)
    return phase_picture(PORTRAIT, [PhasePoint(math.nan, math.nan, 3, "r", ring=ring)])


def test_a_ring_is_closed_and_over_the_top_it_does_not_cross_the_picture():
    picture = ring_around(1.0, 0.5)
    for row in range(int(SMALL.y(1.2)) // 4, int(SMALL.y(-1.2)) // 4 + 1):
        columns = [column for column, at in places(picture, 3) if at == row]
        assert min(columns) < SMALL.x(0.8) / 2 < SMALL.x(1.2) / 2 < max(columns)
    columns = {column for column, _ in places(ring_around(math.pi, 0.5), 3)}
    assert {column < 8 for column in columns} == {True, False}
    assert not any(8 <= column <= 37 for column in columns)


def test_the_crosshair_meets_at_its_state_and_the_orbit_passes_there():
    state = SMALL.at_cell(30, 4)
    plain = cells(PLAIN)
    picture = phase_picture(PORTRAIT, [], crosshair=state, orbit=state)
    assert (30, 4) in places(picture, EXACT)
    changed = [place for place, cell in cells(picture).items() if plain.get(place) != cell]
    assert sum(column == 30 for _, column in changed) > SMALL.rows / 2
    assert sum(row == 4 for row, _ in changed) > SMALL.columns / 2
