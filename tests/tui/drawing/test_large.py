"""Large digits and thick lines, as pictures made of text."""

import textwrap

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tui.harness import lab
from tui.drawing.canvas import Canvas
from tui.drawing.cells import PRESENT
from tui.drawing.large import HEIGHT, large, thick
from tui.drawing.palette import NOBODY
from tui.views.lab.error_table import ErrorTable
from tui.views.lab.large_table import CELL, DIGITS, LargeTable
from tui.views.lab.time_chart import TimeChart
from tui.words.numbers import scientific


def block(text: str) -> list[str]:
    return textwrap.dedent(text).strip("\n").splitlines()


def test_a_number_as_half_blocks():
    assert large("-4.3e+07") == block(
        """
            █ █     ▀▀█ ▄▄▄  ▄  █▀█ ▀▀█
        ▀▀▀ ▀▀█     ▀▀█ █▀▀ ▀█▀ █ █  ▄▀
              ▀  ▀  ▀▀▀ ▀▀▀     ▀▀▀  ▀
        """
    )


@given(st.text("0123456789+-.e ", max_size=12))
def test_every_number_has_three_rows_of_four_columns_a_character(text):
    rows = large(text)
    assert len(rows) == HEIGHT
    assert max(map(len, rows)) <= 4 * len(text)


def test_digits_differ():
    assert len({tuple(large(digit)) for digit in "0123456789+-.e "}) == 15


def picture(points, columns=4, rows=2, owner=1):
    canvas = Canvas(columns, rows)
    for x, y in points:
        canvas.points(x, y, owner)
    return canvas.picture()


@given(points=st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)), max_size=12))
def test_every_dot_is_also_right_of_itself_and_below(points):
    grown = {(x + dx, y + dy) for x, y in points for dx in (0, 1) for dy in (0, 1)}
    expected = picture([(x, y) for x, y in grown if x < 8 and y < 8])
    seen = thick(picture(points))
    assert seen.text == expected.text
    assert np.array_equal(seen.owners, expected.owners)


def test_words_and_what_is_empty_stay():
    canvas = Canvas(6, 2)
    canvas.label(1, 0, "word", 2)
    canvas.points(1, 3, 1)  # its neighbour below and right is under the word
    seen = thick(canvas.picture())
    assert seen.text.splitlines()[0][1:5] == "word"
    assert list(seen.owners[0, 1:5]) == [2] * 4
    assert seen.owners[1, 0] == 1
    assert (seen.owners[1, 2:] == NOBODY).all()


@pytest.mark.parametrize("owner", [0, 3, -1])
def test_a_new_cell_belongs_to_whose_dot_it_is(owner):
    assert thick(picture([(1, 3)], owner=owner)).owners[:2, :2].tolist() == [[owner, owner], [owner, owner]]


@pytest.mark.parametrize(("columns", "lines"), [(80, 2), (120, 2), (200, 1)])
async def test_presented_the_table_is_large_and_lines_are_thick(columns, lines):
    async with lab(size=(columns, 40)) as theatre:
        await theatre.run(12)
        await theatre.settled()
        thin = theatre.text(TimeChart)
        theatre.app.action_present()
        await theatre.pilot.pause()
        await theatre.run(0)
        await theatre.settled()
        table, usual = theatre.stage.query_one(LargeTable), theatre.stage.query_one(ErrorTable)
        assert (table.is_on_screen, usual.is_on_screen) == (True, False)
        rows = table.text.splitlines()
        assert table.size.height == len(rows) == lines * (HEIGHT + 1)
        assert rows[0].startswith(" 1 e Explicit Euler: grows")
        numbers = [large(scientific(each.energy_error, DIGITS)) for each in theatre.source.sample.readings]
        assert rows[1][: CELL - 1].rstrip() == f" {numbers[0][0]}".rstrip()
        assert rows[-1].endswith(numbers[3][2])
        assert max(map(len, rows)) <= columns
        assert len([dot for dot in theatre.text(TimeChart) if dot > "\u2800"]) > len(
            [dot for dot in thin if dot > "\u2800"]
        )
        theatre.app.action_present()
        await theatre.pilot.pause()
        assert (table.is_on_screen, usual.is_on_screen) == (False, True)


async def test_where_there_is_no_room_the_table_stays_small():
    async with lab(size=(60, 16)) as theatre:
        theatre.app.add_class(PRESENT)
        await theatre.run(1)
        assert theatre.stage.query_one(ErrorTable).is_on_screen
        assert not theatre.stage.query_one(LargeTable).is_on_screen
