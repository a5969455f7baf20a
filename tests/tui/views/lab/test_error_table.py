"""The heads of the table's columns: what they mean, under the pointer."""

from engine.scenes import SCENES
from tests.tui.harness import lab
from tui.views.lab.error_table import COLUMNS, ErrorTable, extra_columns
from tui.words.cards import head_text


async def test_a_head_under_the_pointer_says_what_it_means():
    for size in ((80, 24), (160, 50)):
        async with lab(size=size) as theatre:
            shown = theatre.stage.query_one(ErrorTable)
            head = theatre.text(ErrorTable).splitlines()[0]
            for start, words in (
                ("theta", "angle from"),
                ("dE/E0", "error"),
                ("verdict", "long run"),
                ("largest", "largest"),
            ):
                await theatre.pilot.hover(ErrorTable, offset=(head.index(start) + 1, 0))
                assert words in str(shown.tooltip)
            await theatre.pilot.hover(ErrorTable, offset=(head.index("verdict"), 2))
            assert shown.tooltip is None


def test_every_head_has_a_meaning():
    for column in (*COLUMNS, *extra_columns(SCENES["stiff-limit"].equations)):
        assert head_text(column.head) == head_text(column.wide_head) is not None


async def test_the_longest_name_is_written_in_full():
    async with lab(SCENES["stiff-limit"], (80, 24)) as theatre:
        assert " Implicit midpoint " in theatre.text(ErrorTable)
