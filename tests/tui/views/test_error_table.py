"""The table of the lab: its rows as text, and the meaning of its heads under the pointer."""

from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.tui.views.error_table import COLUMNS, ErrorTable, extra_column
from pendu_tui.tui.words.cards import head_text
from tests.tui.harness import lab


async def test_a_head_under_the_pointer_says_what_it_means():
    async with lab() as theatre:
        shown = theatre.pane(ErrorTable)
        head = theatre.text(ErrorTable).splitlines()[0]
        first, second = shown._head[:2]
        for at, name in ((len(first) - 1, first), (len(first), second)):
            await theatre.pilot.hover(ErrorTable, offset=(at, 0))
            assert shown.tooltip == head_text(name.strip())
        await theatre.pilot.hover(ErrorTable, offset=(head.index("verdict"), 2))
        assert shown.tooltip is None


async def test_a_click_on_a_row_shows_its_method_alone():
    async with lab() as theatre:
        for row, places in ((0, [0, 1, 2, 3]), (4, [3]), (1, [0, 1, 2, 3]), (1, [0])):
            await theatre.click(ErrorTable, 5, row)
            await theatre.run(0.1)
            assert theatre.stage.shown.places(DEFAULT_SCENE.cast) == places


def test_every_head_has_a_meaning():
    for column in (*COLUMNS, *map(extra_column, SCENES["stiff-limit"].equations.extra_columns)):
        assert head_text(column.head.narrow) == head_text(column.head.wide) is not None
