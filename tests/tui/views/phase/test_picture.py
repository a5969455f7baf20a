"""The phase portrait as pictures made of text."""

import math

import numpy as np
import pytest

from engine.methods import USUAL_CAST
from engine.scenes import SCENES
from tests.tui.drawn import cells
from tui.drawing.palette import EXACT, FAINT
from tui.views.phase.picture import SPARSE, PhasePoint, phase_picture
from tui.views.phase.portrait import Portrait
from tui.views.phase.viewport import Viewport

DRIFT = SCENES["drift"]
SMALL = Viewport.portrait(46, 15, DRIFT)
PORTRAIT = Portrait.of(SMALL, DRIFT.equations)


def dots(picture, ink: int) -> set[tuple[int, int]]:
    return {(column, row) for (row, column), (_, colour) in cells(picture).items() if colour == ink}


def test_the_portrait():
    assert phase_picture(PORTRAIT, []).text == PICTURE


PICTURE = """\
          ⢀⣀⡠⠤⠒⠒⠉⠉⠁         ⠉⠉⠙⠒⠲⠤⣄⣀⡀
⣀⣀⣀⣀⣀⠤⠤⠔⠒⠉⠁     ⣀ rotation ⠤⠤⣄⣀     ⠉⠙⠒⠦⠤⢤⣀⣀⣀⣀
           ⣀⠤⠒⢊⣩⣤⠶⢶⣛⣛⠿⠯⠭⠽⢿⣛⣛⡶⠶⣬⣍separatrix
5     ⢀⡠⠔⠊⢉⣠⡴⠞⣋⠥⠒⠉⠁         ⠉⠙⠲⢬⣙⠳⢦⣌⡉⠓⠦⣄⡀
⠤⠤⠤⠔⠒⠉⠁⢀⣤⠞⠋⡡⠔⠉     ⣀⠤⠤⠔⠒⠦⠤⢤⣀    ⠈⠙⠦⣌⠙⠳⣤⡀⠉⠙⠒⠦⠤⠤
    ⢀⣤⠞⠋ ⡠⠊     ⢀⠔⠉        ⠈⠙⢦⡀    ⠈⠳⣄ ⠙⠳⣤⡀
  ⣠⠶⠋  ⢀⠎      ⡔⠁             ⠙⡆     ⠈⢧   ⠙⠶⣄
0⣿⡁    ⢸      ⠰⡅   libration   ⡹      ⢸     ⢈⣿
  ⠙⠶⣄  ⠈⢧⡀     ⠳⣄             ⡠⠃     ⢀⠎   ⣠⠶⠋
    ⠈⠛⢦⣄ ⠙⢦⡀    ⠈⠳⢤⣀       ⣀⠤⠊     ⢀⠔⠁ ⣠⡴⠛⠁
⠉⠉⠉⠓⠲⠤⣄⡈⠛⢦⣄⡉⠳⢤⣀    ⠈⠉⠉⠓⠒⠊⠉⠉     ⣀⠤⠊⢁⣠⡴⠛⢁⡠⠤⠒⠊⠉⠉
-5     ⠉⠓⠦⢬⣙⠳⢦⣌⡙⠲⠤⣄⣀⣀     ⣀⣀⡠⠤⠒⢉⣠⡴⠞⣋⠥⠔⠊⠁
⣀⣀⣀⣀⣀      ⠈⠙⠒⠮⢽⣛⡶⠶⣤⣬⣭⣍⣉⣩⣭⣤⣤⠶⢶⣛⠯⠕⠒⠉       ⣀⣀⣀⣀
    ⠈⠉⠉⠓⠲⠤⣄⣀⡀     rotation ⠉⠉⠁    ⢀⣀⡠⠤⠒⠊⠉⠉
-pi       -pi/2 ⠤⠤⡄    0    ⡠⠤⠤ pi/2        pi"""


@pytest.mark.parametrize(
    ("theta", "omega"), [(0.0, 0.0), (1.0, 2.0), (-3.0, -5.0), (1.0 + math.tau, 2.0)]
)
def test_a_point_is_drawn_where_its_state_is_with_its_letter_beside_it(theta, omega):
    picture = phase_picture(PORTRAIT, [PhasePoint(theta, omega, 2, "v")])
    column, row = int(SMALL.x(theta)) // 2, int(SMALL.y(omega)) // 4
    mine = dots(picture, 2)
    assert (column, row) in mine
    assert cells(picture)[row, column + 2][0] == "v"
    assert all(abs(c - column) <= 2 and abs(r - row) <= 1 for c, r in mine)


def test_every_method_has_its_letter_where_several_coincide():
    points = [PhasePoint(1.0, 2.0, i, method.letter) for i, method in enumerate(USUAL_CAST)]
    picture = phase_picture(PORTRAIT, points)
    for point in points:
        assert (point.letter, point.ink) in cells(picture).values()


def test_dots_of_different_methods_in_one_cell_all_stay():
    blank = Portrait.of(
        SMALL.zoomed(0.01, 46, 30), DRIFT.equations
    )  # so close that no curve passes the corner
    viewport = blank.viewport
    a = (viewport.theta_at(20.5), viewport.omega_at(8.5))  # two dots of cell (10, 2)
    b = (viewport.theta_at(21.5), viewport.omega_at(11.5))

    def cell(*trails) -> int:
        tracks = [(np.array([theta]), np.array([omega])) for theta, omega in trails]
        points = [PhasePoint(math.nan, math.nan, 0, "e", track) for track in tracks]
        return ord(cells(phase_picture(blank, points))[2, 10][0])

    assert cell(a, b) - 0x2800 == (cell(a) - 0x2800) | (cell(b) - 0x2800)
    assert cell(a) != cell(b)


def test_a_trail_is_faint_and_where_the_method_was():
    theta, omega = np.linspace(0.5, 1.0, SPARSE + 1), np.linspace(1.0, 2.0, SPARSE + 1)
    picture = phase_picture(PORTRAIT, [PhasePoint(1.5, 3.0, 1, "s", (theta, omega))])
    expected = {
        (int(SMALL.x(a)) // 2, int(SMALL.y(b)) // 4)
        for a, b in zip(theta.tolist(), omega.tolist(), strict=True)
    }
    assert dots(picture, 1 + FAINT) == expected


def test_a_moving_point_takes_the_place_of_a_word():
    row = next(y for y, line in enumerate(PICTURE.splitlines()) if "libration" in line)
    column = PICTURE.splitlines()[row].index("libration") + 4
    picture = phase_picture(PORTRAIT, [PhasePoint(*SMALL.at_cell(column, row), 0, "e")])
    assert cells(picture)[row, column][1] == 0
    assert "libration" not in picture.text


def ring_around(theta: float, radius: float) -> tuple[np.ndarray, np.ndarray]:
    angle = np.linspace(0, math.tau, 64, endpoint=False)
    return theta + radius * np.cos(angle), DRIFT.w0 * radius * np.sin(angle)


def test_a_ring_is_closed():
    picture = phase_picture(PORTRAIT, [PhasePoint(0.0, 0.0, 3, "r", ring=ring_around(1.0, 0.5))])
    for row in range(int(SMALL.y(1.2)) // 4, int(SMALL.y(-1.2)) // 4 + 1):
        columns = [column for column, at in dots(picture, 3) if at == row]
        assert min(columns) < SMALL.x(0.8) / 2 < SMALL.x(1.2) / 2 < max(columns)


def test_a_ring_over_the_top_does_not_cross_the_picture():
    picture = phase_picture(
        PORTRAIT, [PhasePoint(math.nan, math.nan, 3, "r", ring=ring_around(math.pi, 0.5))]
    )
    columns = [column for column, _ in dots(picture, 3)]
    assert any(column < 8 for column in columns)
    assert any(column > 37 for column in columns)
    assert not any(8 <= column <= 37 for column in columns)


def test_the_crosshair_meets_at_its_state_and_the_orbit_passes_there():
    state = SMALL.at_cell(30, 4)
    plain = phase_picture(PORTRAIT, [])
    picture = phase_picture(PORTRAIT, [], crosshair=state, orbit=state)
    assert (30, 4) in dots(picture, EXACT)
    changed = {place for place, cell in cells(picture).items() if cells(plain).get(place) != cell}
    assert len([row for row, column in changed if column == 30]) > SMALL.rows / 2
    assert len([column for row, column in changed if row == 4]) > SMALL.columns / 2


def test_what_is_not_a_number_is_not_drawn():
    nowhere = PhasePoint(math.nan, math.nan, 0, "e", ring=(np.full(3, math.nan), np.zeros(3)))
    assert phase_picture(PORTRAIT, [nowhere]).text == PICTURE
