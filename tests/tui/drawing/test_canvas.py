from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pendu_tui.tui.drawing.canvas import Canvas
from pendu_tui.tui.drawing.picture import EXACT, FAINT, FRAME, TEXT, Picture, faint
from tests.tui.drawn import cells
from tests.tui.drawn import inks as inks_of

DOTS = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3))  # by bit
COLUMNS, ROWS = 10, 6
ANY = st.floats(allow_nan=True, allow_infinity=True)
NEAR = st.integers(-240, 400).map(lambda eighths: eighths / 8)  # moving them by 40 rounds nothing
ENDS = st.tuples(NEAR, NEAR, NEAR, NEAR)


def dots_of(character, row, column):
    """The dots of a cell, read back from its character as Unicode defines them."""
    return {
        (2 * column + right, 4 * row + down)
        for bit, (right, down) in enumerate(DOTS)
        if (ord(character) - 0x2800) >> bit & 1
    }


def dots(picture):
    found = cells(picture).items()
    return set().union(*(dots_of(character, *cell) for cell, (character, _) in found))


def drawn(draw, columns=COLUMNS, rows=ROWS):
    canvas = Canvas(columns, rows)
    draw(canvas)
    return canvas.picture()


@example([(2 * COLUMNS, 0.0), (0.0, 4 * ROWS)])
@given(st.lists(st.tuples(ANY, ANY)))
def test_points_outside_or_not_finite_are_the_only_ones_not_drawn(points):
    x, y = np.array(points).reshape(-1, 2).T
    inside = {(int(i), int(j)) for i, j in points if 0 <= i < 2 * COLUMNS and 0 <= j < 4 * ROWS}
    assert dots(drawn(lambda canvas: canvas.points(points, 0))) == inside
    assert dots(drawn(lambda canvas: canvas.scatter(x, y, 0))) == inside


METHODS = st.integers(0, 3)
INKS = st.one_of(METHODS, METHODS.map(faint), st.sampled_from([EXACT, FRAME, TEXT]))
SEVERAL = st.dictionaries(INKS, st.sets(st.tuples(st.integers(0, 19), st.integers(0, 23))))


def shown_cells(points):
    canvas = Canvas(COLUMNS, ROWS)
    for ink, some in points.items():
        canvas.points(some, ink)
    return cells(canvas.picture())


@given(SEVERAL, st.randoms())
def test_every_dot_is_shown_in_its_own_ink_and_an_ink_alone_in_a_cell_is_whole(points, random):
    """The order of drawing changes no cell of methods."""
    shown = shown_cells(points)
    again = shown_cells(dict(random.sample([*points.items()], len(points))))
    assert {cell for cell in again.items() if cell[1][1] >= 0} <= {*shown.items()}
    for cell in {(j // 4, i // 2) for some in points.values() for i, j in some}:
        present = {
            ink: own
            for ink, some in points.items()
            if (own := {(i, j) for i, j in some if (j // 4, i // 2) == cell})
        }
        character, ink = shown[cell]
        assert dots_of(character, *cell) <= present[ink]
        assert rank(ink) == max(map(rank, present))
        if len([each for each in present if rank(each) == rank(ink)]) == 1 or ink < 0:
            assert dots_of(character, *cell) == present[ink]


def rank(ink):
    """Methods, then their faint inks, then all others."""
    return 0 if ink < 0 else 1 if ink >= FAINT else 2


LINE = st.tuples(
    st.lists(st.integers(0, 4 * ROWS - 1), min_size=80, max_size=80),
    st.integers(0, 70),
    st.integers(8, 80),
)


@example([([1] * 80, 0, 16), ([1] * 80, 0, 80), ([1] * 80, 16, 64)])
@given(st.lists(LINE, min_size=2, max_size=6))
def test_no_line_keeps_a_smaller_share_of_its_columns_than_the_smallest_equal_part(lines):
    """An equal part is one of the methods in the cell; they may begin and end anywhere."""
    canvas = Canvas(40, ROWS)
    owners = {}
    for ink, (heights, begin, size) in enumerate(lines):
        points = list(enumerate(heights))[begin : begin + size]
        canvas.points(points, ink)
        for x, y in points:
            owners.setdefault((y // 4, x // 2), set()).add(ink)
    drawn = cells(canvas.picture())
    shares, parts = [], []
    for ink in range(len(lines)):
        columns = {}
        for (_, column), inks in owners.items():
            if ink in inks:
                columns[column] = max(columns.get(column, 0), 1 / len(inks))
        shown = {column for (_, column), (_, owner) in drawn.items() if owner == ink}
        shares.append((len(shown) + 1) / len(columns))
        parts.append(sum(columns.values()) / len(columns))
    assert min(shares) >= min(parts)


@pytest.mark.parametrize(
    ("heights", "text"),
    [((1, 1), "⠒⠒⠒⠒⠒⠒"), ((0, 3), "⠁⡀⠁⡀⠁⡀"), ((0, 1, 3), "⠁⠂⡀⠁⠂⡀")],
)
def test_flat_lines_in_a_row_of_cells_keep_their_heights_and_never_meet(heights, text):
    canvas = Canvas(6, 1)
    for ink, height in enumerate(heights):
        canvas.line(0, height + 0.5, 12, height + 0.5, ink)
    picture = canvas.picture()
    assert picture.text == text
    assert [ink for _, ink in picture.rows[0]] == [place % len(heights) for place in range(6)]


@pytest.mark.parametrize("end", [(12, 0), (12, 24), (0, 24)])
def test_trails_in_one_place_are_all_seen(end):
    trails = {faint(ink) for ink in range(3)}
    canvas = Canvas(6, 6)
    for ink in trails:
        canvas.line(0, 0, *end, ink)
    assert inks_of(canvas.picture()) == trails
    assert "⠉" not in canvas.picture().text  # where they are flat, they never meet


def test_a_letter_stands_where_no_other_method_is():
    canvas = Canvas(3, 1)
    canvas.points([(0, 0)], 1)
    canvas.points([], 2)
    canvas.points([(2, 0)], 0)
    for ink in (faint(1), FRAME):
        canvas.points([(2, 1)], ink)
    canvas.label_near([(0, 0), (1, 0), (2, 0)], "e", 0)
    assert canvas.picture().text == "⠁e"
    canvas.points([(4, 0)], 1)
    canvas.label_near([(2, 0), (0, 0)], "v", 0)  # on others before not at all
    assert canvas.picture().text == "⠁ev"


def test_of_other_inks_the_one_drawn_first_lies_below():
    canvas = Canvas(2, 1)
    canvas.points([(0, 0), (2, 0)], FRAME)
    canvas.points([(1, 3)], TEXT)
    canvas.points([(0, 1)], FRAME)
    assert canvas.picture().rows == ((("⢀", TEXT), ("⠁", FRAME)),)
    assert canvas.inks_at(0, 0) == {FRAME, TEXT}


def test_a_line_has_one_dot_in_each_column_of_dots_or_row_where_it_is_steep():
    assert drawn(lambda canvas: canvas.line(0, 0, 19.9, 6, 0), 10, 2).text == "⠉⠑⠒⠢⠤⣀⡀\n      ⠈⠉⠑⠒"
    assert drawn(lambda canvas: canvas.line(0, 0, 12, 0, 0, dotted=True), 6, 1).text == "⠁⠈ ⠁⠈"
    assert drawn(lambda canvas: canvas.line(12, 0, 0, 0, 0, dotted=True), 6, 1).text == " ⠁⠈ ⠁⠈"


@example((0.875, 0.125, 1.875, 1.0))  # its first dot is beyond its end
@example((1.875, 1.0, 0.875, 0.125))
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


@example([(1.875, 1.0), (0.875, 0.125)])
@given(st.lists(st.tuples(ANY, ANY), min_size=2, max_size=5))
def test_a_path_has_the_dots_of_its_lines(points):
    lines = Canvas(COLUMNS, ROWS)
    for (x0, y0), (x1, y1) in pairwise(points):
        lines.line(x0, y0, x1, y1, 0)
    assert drawn(lambda canvas: canvas.path(*np.array(points).T, 0)) == lines.picture()


def test_a_line_from_far_away_is_drawn_where_it_is_visible():
    found = dots(drawn(lambda canvas: canvas.line(-1e300, 5, 1e300, 5, 0)))
    assert found == {(x, 5) for x in range(2 * COLUMNS)}
    assert not dots(drawn(lambda canvas: canvas.line(0, 5, np.nan, 5, 0)))


@pytest.mark.parametrize(
    ("x", "y", "radius", "hollow", "text"),
    [
        (6, 6, 4, False, "  ⣀⣀⡀\n ⢸⣿⣿⣿\n ⠈⠛⠛⠋"),
        (6, 6, 4, True, "  ⣀⣀⡀\n ⢸  ⢸\n ⠈⠒⠒⠊"),
        (6, 6, 2, True, "\n  ⢰⣲\n"),
        (6, 6, 2.5, False, "\n  ⣾⣿⡆\n  ⠈⠉"),
        (-2, 6, 4, False, "⡀\n⣿\n⠋"),
        (13, 6, 4, False, "     ⢀\n     ⣿\n     ⠙"),
        (6, -2, 4, False, " ⠈⠛⠛⠋\n\n"),
        (6, 14, 4, False, "\n\n  ⣀⣀⡀"),
        (6, np.nan, 4, False, "\n\n"),
    ],
)
def test_a_disc_is_round_because_dots_are_square(x, y, radius, hollow, text):
    assert drawn(lambda canvas: canvas.disc(x, y, radius, 0, hollow=hollow), 6, 3).text == text


def test_a_label_covers_dots_and_is_cut_off_at_the_edge():
    canvas = Canvas(6, 1)
    canvas.label(3, 0, " abel", 1)
    canvas.line(0, 0, 12, 0, 0)
    assert canvas.picture().rows == ((("⠉⠉⠉ ", 0), ("ab", 1)),)
    assert [canvas.is_free(column, 0) for column in (-1, 0, 2, 3, 6)] == [False, True, True] + [
        False
    ] * 2
    assert [canvas.is_free(1, 0, columns) for columns in (2, 3)] == [True, False]
    assert [canvas.is_free(4, row, 2) for row in (-1, 0, 1)] == [False] * 3


def test_what_is_drawn_on_a_copy_is_not_on_the_original():
    canvas = Canvas(2, 1)
    canvas.points([(0, 0)], 0)
    before = canvas.picture()
    other = canvas.copy()
    other.points([(3, 3)], 0)
    other.label(1, 0, "x", 0)
    assert canvas.picture() == before


def test_pictures_are_compared_row_by_row():
    picture = Picture((*Canvas(4, 2).picture().rows, (("ab", 1),)))
    assert picture.text == "\n\nab"
    assert list(picture.changes(Canvas(4, 2).picture(), 4)) == [(2, 4, 0)]
    old = Picture(((("abc", 1), ("d", 2), ("ef", 3)),))
    new = Picture(((("abc", 1), ("x", 2), ("ef", 3)),))
    assert list(new.changes(old, 6)) == [(0, 4, 1)]  # "abcx" is sent
    assert list(new.changes(old, 8)) == [(0, 8, 0)]  # up to the end, where a row may be wide
    assert list(new.changes(new, 6)) == []
    longer = Picture(((("abc", 1), ("xyz", 2), ("ef", 3)),))
    assert list(longer.changes(old, 8)) == [(0, 8, 0)]  # the end moves
    assert Canvas(0, 2).picture().text == "\n"
