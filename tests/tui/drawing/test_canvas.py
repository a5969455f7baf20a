from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.palette import NOBODY, TEXT
from pendu_tui.tui.drawing.picture import Picture

DOTS = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3))  # by bit
COLUMNS, ROWS = 10, 6
ANY = st.floats(allow_nan=True, allow_infinity=True)
NEAR = st.integers(-240, 400).map(lambda eighths: eighths / 8)  # moving them by 40 rounds nothing
ENDS = st.tuples(NEAR, NEAR, NEAR, NEAR)


def dots(picture):
    """The dots of a picture, read back from its characters as Unicode defines them."""
    return {
        (2 * column + right, 4 * row + down)
        for row, line in enumerate(picture.text.split("\n"))
        for column, character in enumerate(line)
        if character != " "
        for bit, (right, down) in enumerate(DOTS)
        if (ord(character) - 0x2800) >> bit & 1
    }


def drawn(draw, columns=COLUMNS, rows=ROWS):
    canvas = Canvas(columns, rows)
    draw(canvas)
    return canvas.picture()


@given(st.lists(st.tuples(ANY, ANY)))
def test_points_outside_or_not_finite_are_the_only_ones_not_drawn(points):
    x, y = np.array(points).reshape(-1, 2).T
    inside = {(int(i), int(j)) for i, j in points if 0 <= i < 2 * COLUMNS and 0 <= j < 4 * ROWS}
    assert dots(drawn(lambda canvas: canvas.points(points, 0))) == inside
    assert dots(drawn(lambda canvas: canvas.scatter(x, y, 0))) == inside


def test_dots_of_several_inks_share_a_cell_which_has_the_last_one():
    canvas = Canvas(2, 1)
    canvas.points([(0, 0), (2, 0)], 0)
    canvas.scatter(np.array([1]), np.array([3]), 1)
    assert canvas.picture().rows == ((("⢁", 1), ("⠁", 0)),)
    assert [canvas.ink_at(column, 0) for column in (0, 1)] == [1, 0]


def test_a_row_has_as_few_spans_as_possible():
    canvas = Canvas(6, 2)
    canvas.points([(0, 0), (2, 0), (6, 0)], 2)
    assert canvas.picture().rows == ((("⠁⠁ ⠁  ", 2),), (("      ", NOBODY),))


def test_a_line_has_one_dot_in_each_column_of_dots_or_row_where_it_is_steep():
    path = np.array([[0, 19.9, 15], [0, 6, 11.9]])
    assert drawn(lambda canvas: canvas.path(*path, 0), 10, 3).text == (
        "⠉⠑⠒⠢⠤⣀⡀\n      ⠈⠉⠑⡲\n       ⢀⠎"
    )
    assert drawn(lambda canvas: canvas.line(0, 0, 12, 0, 0, dotted=True), 6, 1).text == "⠁⠈ ⠁⠈"


@given(ENDS)
def test_the_dots_of_a_line_touch_each_other_and_the_line(ends):
    """On a canvas large enough for all of it."""
    x0, y0, x1, y1 = (end + 40 for end in ends)
    found = dots(drawn(lambda canvas: canvas.line(x0, y0, x1, y1, 0), 60, 30))
    for i, j in ((x0, y0), (x1, y1)):  # both ends are reached to a dot
        assert min(max(abs(int(i) - right), abs(int(j) - down)) for right, down in found) <= 1
    length = (x1 - x0) ** 2 + (y1 - y0) ** 2 or 1.0
    for i, j in found:
        across, down = i + 0.5 - x0, j + 0.5 - y0
        share = min(max((across * (x1 - x0) + down * (y1 - y0)) / length, 0), 1)
        distance = np.hypot(across - share * (x1 - x0), down - share * (y1 - y0))
        assert distance <= 0.7072  # half the diagonal of a dot: the line passes through it
        near = {(i + right, j + down) for right in (-1, 0, 1) for down in (-1, 0, 1)}
        assert len(found) == 1 or len(found & near) > 1


@given(ENDS)
def test_a_line_that_leaves_the_canvas_is_the_same_inside_it(ends):
    x0, y0, x1, y1 = ends
    y0, y1 = y0 + 0.0314159, y1 + 0.0314159  # between two dots rounding would decide
    small = dots(drawn(lambda canvas: canvas.line(x0, y0, x1, y1, 0)))
    large = dots(drawn(lambda canvas: canvas.line(x0 + 40, y0 + 40, x1 + 40, y1 + 40, 0), 60, 30))
    moved = {(i - 40, j - 40) for i, j in large}
    assert small == {(i, j) for i, j in moved if 0 <= i < 2 * COLUMNS and 0 <= j < 4 * ROWS}


@given(st.lists(st.tuples(ANY, ANY), min_size=2, max_size=5))
def test_a_path_has_the_dots_of_its_lines(points):
    lines = Canvas(COLUMNS, ROWS)
    for (x0, y0), (x1, y1) in pairwise(points):
        lines.line(x0, y0, x1, y1, 0)
    assert drawn(lambda canvas: canvas.path(*np.array(points).T, 0)) == lines.picture()


@pytest.mark.parametrize("far", [1e20, 1e300])
def test_a_line_from_far_away_is_drawn_where_it_is_visible(far):
    found = dots(drawn(lambda canvas: canvas.line(-far, 5, far, 5, 0)))
    assert found == {(x, 5) for x in range(2 * COLUMNS)}
    assert not dots(drawn(lambda canvas: canvas.line(0, 5, np.nan, 5, 0)))


@pytest.mark.parametrize(
    ("hollow", "text"), [(False, " ⢀⣤⣤⡀\n ⣿⣿⣿⣿\n ⠈⠛⠛⠁"), (True, " ⢀⠤⠤⡀\n ⡇  ⢸\n ⠈⠒⠒⠁")]
)
def test_a_disc_is_round_because_dots_are_square(hollow, text):
    assert drawn(lambda canvas: canvas.disc(6, 6, 4, 0, hollow=hollow), 6, 3).text == text


@given(ANY, ANY)
def test_a_disc_is_clipped_to_the_canvas(x, y):
    inside = dots(drawn(lambda canvas: canvas.disc(x, y, 2.5, 0)))
    assert all(np.hypot(i + 0.5 - x, j + 0.5 - y) <= 2.5 for i, j in inside)
    assert inside or not (0 <= x <= 2 * COLUMNS and 0 <= y <= 4 * ROWS)


def test_a_label_covers_dots_and_is_cut_off_at_the_edge():
    canvas = Canvas(6, 1)
    canvas.label(3, 0, "label", 1)
    canvas.line(0, 0, 12, 0, 0)
    assert canvas.picture().rows == ((("⠉⠉⠉", 0), ("lab", 1)),)
    assert [canvas.is_free(column, 0) for column in (2, 3, 6)] == [True, False, False]
    assert canvas.ink_at(3, 0) == 1


def test_what_is_drawn_on_a_copy_is_not_on_the_original():
    canvas = Canvas(2, 1)
    other = canvas.copy()
    other.points([(0, 0)], 0)
    other.label(1, 0, "x", 0)
    assert canvas.picture() == Canvas(2, 1).picture()


def test_a_text_is_wrapped_and_centred():
    picture = Picture.of_text("A chart needs 20×5 characters.", 12, 5, TEXT)
    assert picture.text == "\n  A chart\n needs 20×5\ncharacters.\n"
    assert len(Picture.of_text("too long for this", 3, 2, TEXT).rows) == 2


def test_pictures_are_compared_row_by_row():
    picture = Picture((*Canvas(4, 2).picture().rows, (("ab", 1),)))
    assert picture.text == "\n\nab"
    assert picture.changed_rows(Canvas(4, 2).picture()) == [2]
    assert Canvas(0, 2).picture().text == "\n"
