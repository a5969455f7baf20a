"""The heads of the table's columns: what they mean, under the pointer."""

from tests.tui.harness import lab
from tui.views.lab.error_table import COLUMNS, SPRING, ErrorTable
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
    for column in (*COLUMNS, *SPRING):
        assert head_text(column.wide[0]) is not None
        assert head_text(column.wide[0]) == head_text(column.narrow[0])
