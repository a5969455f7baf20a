"""Trails that are kept from frame to frame look like trails that are drawn anew."""

import math

from hypothesis import given
from hypothesis import strategies as st

from tui.drawing.canvas import Canvas
from tui.drawing.trails import Trails

COLUMNS, ROWS, LENGTH = 4, 3, 5
OWNERS = (3, 4, 5)
COORDINATES = st.floats(-2, 14) | st.sampled_from([math.nan, math.inf])
POINTS = st.lists(st.tuples(COORDINATES, COORDINATES), min_size=len(OWNERS), max_size=len(OWNERS))


def ground() -> Canvas:
    canvas = Canvas(COLUMNS, ROWS)
    canvas.line([0, 8], [0, 12], owner=1)
    return canvas


@given(st.lists(POINTS, max_size=3 * LENGTH))
def test_they_show_the_last_points_of_each_owner_later_owners_in_front(frames):
    trails = Trails(ground(), OWNERS, LENGTH)
    for points in frames:
        trails.add(points)
    anew = ground()
    for place, owner in enumerate(OWNERS):
        for points in frames[-LENGTH:]:
            anew.points(*points[place], owner)
    picture, expected = trails.canvas.picture(), anew.picture()
    assert picture.text == expected.text
    assert picture.owners.tolist() == expected.owners.tolist()


def test_the_ground_stays_as_it_is():
    before = ground()
    Trails(before, OWNERS, LENGTH).add([(1.0, 1.0)] * len(OWNERS))
    assert before.picture().text == ground().picture().text
