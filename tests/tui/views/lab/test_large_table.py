"""For a projector: large digits and thick lines."""

import itertools
import textwrap

import pytest

from tests.tui.harness import FPS, lab
from tui.drawing.cells import PRESENT
from tui.views.lab.error_table import ErrorTable
from tui.views.lab.large_table import CELL, HEIGHT, LargeTable, labelled, large
from tui.views.lab.time_chart import TimeChart


def test_a_number_in_large_digits():
    assert [row.rstrip() for row in large("-4.3e+07")] == textwrap.dedent(
        """\
            ╻ ╻     ╺━┓ ╭─╴     ┏━┓ ╺━┓
        ╺━╸ ┗━┫      ━┫ ├─  ╺╋╸ ┃ ┃   ┃
              ╹ •   ╺━┛ ╰─╴     ┗━┛   ╹"""
    ).split("\n")


def test_all_characters_of_a_number_are_of_one_width_and_differ():
    seen = [large(character) for character in "0123456789+-.ex "]
    assert len(set(map(tuple, seen))) == len(seen)
    assert {len(row) for rows in seen for row in rows} == {3}
    assert {len(rows) for rows in seen} == {HEIGHT}


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
        assert rows[0].startswith(" 1 e Explicit Euler: + grows")
        told = [labelled(each.energy_error) for each in theatre.source.sample.readings]
        assert [what for _, what in told] == ["% dE/E0", "% dE/E0", "dE/E0", "dE/E0"]
        numbers = [large(number) for number, _ in told]
        assert rows[1][: CELL - 1].rstrip() == f" {numbers[0][0]}".rstrip()
        assert rows[-1].endswith(f"{numbers[3][2]} dE/E0")
        assert max(map(len, rows)) <= columns
        assert dots(theatre.text(TimeChart)) > 1.5 * dots(thin)
        theatre.app.action_present()
        await theatre.pilot.pause()
        assert (table.is_on_screen, usual.is_on_screen) == (False, True)


def dots(text: str) -> int:
    """How many dots of braille there are."""
    return sum((ord(character) - 0x2800).bit_count() for character in text if "\u2800" <= character <= "\u28ff")


async def test_without_room_the_table_stays_small():
    async with lab(size=(60, 16)) as theatre:
        theatre.app.add_class(PRESENT)
        await theatre.run(1)
        assert theatre.stage.query_one(ErrorTable).is_on_screen
        assert not theatre.stage.query_one(LargeTable).is_on_screen


async def test_large_numbers_change_twice_a_second_at_most():
    async with lab(size=(120, 40)) as theatre:
        theatre.app.action_present()
        await theatre.run(1)
        seen = []
        for _ in range(3 * FPS):
            theatre.now += 1 / FPS
            theatre.stage.frame()
            seen.append(theatre.text(LargeTable))
        changes = sum(one != other for one, other in itertools.pairwise(seen))
        assert 4 <= changes <= 6
