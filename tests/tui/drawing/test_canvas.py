import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tui.drawing.canvas import Canvas, Picture
from tui.drawing.palette import TEXT

DOT_OF_BIT = {0: (0, 0), 1: (0, 1), 2: (0, 2), 3: (1, 0), 4: (1, 1), 5: (1, 2), 6: (0, 3), 7: (1, 3)}
COLUMNS, ROWS = 10, 6
ANY = st.floats(allow_nan=True, allow_infinity=True)
NEAR = st.integers(-240, 400).map(lambda eighths: eighths / 8)  # moving them by 40 rounds nothing


def dots(picture):
    """The dots of a picture, read back from its characters as Unicode defines them."""
    return {
        (2 * column + right, 4 * row + down)
        for row, line in enumerate(picture.characters.tolist())
        for column, character in enumerate(line)
        if character != ord(" ")
        for bit, (right, down) in DOT_OF_BIT.items()
        if (character - 0x2800) >> bit & 1
    }


def drawn(draw, columns=COLUMNS, rows=ROWS):
    canvas = Canvas(columns, rows)
    draw(canvas)
    return canvas.picture()


def test_a_dot_is_where_it_was_put():
    for x in range(4):
        for y in range(8):
            assert dots(drawn(lambda canvas, x=x, y=y: canvas.points(x + 0.5, y + 0.5, 0), 2, 2)) == {(x, y)}


@given(st.lists(st.tuples(ANY, ANY)))
def test_points_outside_or_not_finite_are_the_only_ones_not_drawn(points):
    x, y = np.array(points).reshape(-1, 2).T
    picture = drawn(lambda canvas: canvas.points(x, y, 0))
    inside = {(int(i), int(j)) for i, j in points if 0 <= i < 2 * COLUMNS and 0 <= j < 4 * ROWS}
    assert dots(picture) == inside


def test_dots_of_several_owners_share_a_cell_and_the_last_one_owns_it():
    canvas = Canvas(2, 1)
    canvas.points([0, 2], [0, 0], 0)
    canvas.points(1, 3, 1)
    assert canvas.picture().row(0) == [("⢁", 1), ("⠁", 0)]


def test_a_row_has_as_few_spans_as_possible():
    canvas = Canvas(6, 1)
    canvas.points([0, 2, 6], [0, 0, 0], 2)
    assert canvas.picture().row(0) == [("⠁⠁ ⠁  ", 2)]


def test_a_line_has_one_dot_in_each_column_of_dots_or_row_where_it_is_steep():
    canvas = Canvas(10, 3)
    canvas.line([0, 19.9, 15], [0, 6, 11.9], 0)
    assert canvas.picture().text == "⠉⠑⠒⠢⠤⣀⡀\n      ⠈⠉⠑⡲\n       ⢀⠎"


@given(st.lists(st.tuples(NEAR, NEAR), min_size=2, max_size=6))
def test_the_dots_of_a_line_touch_each_other_and_the_line(points):
    """On a canvas large enough for all of it."""
    x, y = np.array(points).T + 40
    found = sorted(dots(drawn(lambda canvas: canvas.line(x, y, 0), 60, 30)))
    for i, j in zip(x, y, strict=True):  # every corner is reached to a dot
        assert min(max(abs(int(i) - right), abs(int(j) - down)) for right, down in found) <= 1
    for i, j in found:
        away = min(distance_to_segment(i + 0.5, j + 0.5, *pair) for pair in zip(x, y, x[1:], y[1:], strict=False))
        assert away <= 0.7072  # half the diagonal of a dot: the line passes through each of them
    if len(found) > 1:
        for i, j in found:
            assert any((i + right, j + down) in found for right in (-1, 0, 1) for down in (-1, 0, 1) if right or down)


def distance_to_segment(px, py, x0, y0, x1, y1):
    length = (x1 - x0) ** 2 + (y1 - y0) ** 2
    share = 0.0 if length == 0 else min(max(((px - x0) * (x1 - x0) + (py - y0) * (y1 - y0)) / length, 0), 1)
    return np.hypot(px - x0 - share * (x1 - x0), py - y0 - share * (y1 - y0))


@given(st.lists(st.tuples(NEAR, NEAR), min_size=2, max_size=4))
def test_a_line_that_leaves_the_canvas_is_the_same_inside_it(points):
    x, y = np.array(points).T
    y = y + 0.0314159  # so that no line runs exactly between two dots, where rounding decides
    small = dots(drawn(lambda canvas: canvas.line(x, y, 0)))
    large = dots(drawn(lambda canvas: canvas.line(x + 40, y + 40, 0), 60, 30))
    large = {(i - 40, j - 40) for i, j in large if 40 <= i < 40 + 2 * COLUMNS and 40 <= j < 40 + 4 * ROWS}
    assert small == large


@given(st.lists(st.tuples(ANY, ANY), max_size=5))
def test_any_numbers_make_a_line(points):
    x, y = np.array(points).reshape(-1, 2).T
    assert drawn(lambda canvas: canvas.line(x, y, 0)).characters.shape == (ROWS, COLUMNS)


@pytest.mark.parametrize("far", [1e20, 1e300, np.nan, np.inf])
def test_a_line_from_far_away_has_no_more_dots_than_the_canvas_is_long(far):
    assert len(dots(drawn(lambda canvas: canvas.line([far, 5, -far], [far, 5, -far], 0)))) <= 2 * COLUMNS + 4 * ROWS


def test_a_line_is_broken_where_a_point_is_not_a_number():
    assert drawn(lambda canvas: canvas.line([0, 5, np.nan, 10, 15], [0, 10, 3, 10, 0], 0), 8, 3).text == (
        "⢣     ⢠⠃\n ⢣   ⢠⠃\n  ⠣  ⠇"
    )


def test_a_disc_is_round_because_dots_are_square():
    assert drawn(lambda canvas: canvas.disc(6, 6, 4, 0), 6, 3).text == " ⢀⣤⣤⡀\n ⣿⣿⣿⣿\n ⠈⠛⠛⠁"
    assert drawn(lambda canvas: canvas.disc(6, 6, 4, 0, hollow=True), 6, 3).text == " ⢀⠤⠤⡀\n ⡇  ⢸\n ⠈⠒⠒⠁"


@given(ANY, ANY)
def test_a_disc_is_clipped_to_the_canvas(x, y):
    inside = dots(drawn(lambda canvas: canvas.disc(x, y, 2.5, 0)))
    assert all(np.hypot(i + 0.5 - x, j + 0.5 - y) <= 2.5 for i, j in inside)
    assert inside or not (0 <= x <= 2 * COLUMNS and 0 <= y <= 4 * ROWS)


def test_a_label_covers_dots_and_is_cut_off_at_the_edge():
    canvas = Canvas(6, 1)
    canvas.label(3, 0, "label", 1)
    canvas.line([0, 12], [0, 0], 0)
    assert canvas.picture().row(0) == [("⠉⠉⠉", 0), ("lab", 1)]
    assert not canvas.is_free(3, 0)
    assert canvas.is_free(2, 0)
    assert not canvas.is_free(6, 0)


def test_a_text_is_wrapped_and_centred():
    picture = Picture.of_text("A chart needs 20×5 characters.", 12, 5, TEXT)
    assert picture.text == "\n  A chart\n needs 20×5\ncharacters.\n"
    assert Picture.of_text("too long for this", 3, 2, TEXT).characters.shape == (2, 3)


def test_pictures_are_stacked_and_written_on():
    picture = Picture.stacked(Canvas(4, 1).picture(), Canvas(4, 2).picture())
    picture.write(2, 2, "abc", 1)
    assert picture.text == "\n\n  ab"
    assert picture.row(2) == [("  ab", 1)]


def test_a_picture_without_columns_has_empty_rows():
    picture = Canvas(0, 2).picture()
    assert [picture.row(y) for y in range(2)] == [[], []]
    assert picture.text == "\n"
