"""The heads of the table's columns: what they mean, under the pointer."""

from textual.widgets import Tooltip

from engine.scenes import SCENES
from tests.tui.harness import lab
from tui.views.lab.error_table import COLUMNS, ErrorTable, extra_columns
from tui.views.phase.pane import PhasePane
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


async def test_tab_goes_from_head_to_head_and_says_what_each_means_and_esc_leaves():
    async with lab(size=(80, 24)) as theatre:
        await theatre.stage.mount(tooltip := Tooltip())  # under test, Textual has none
        heads = theatre.text(ErrorTable).splitlines()[0].replace("per s", "per_s").split()[1:]
        said = []
        for _ in heads:
            await theatre.press("tab")
            assert isinstance(theatre.stage.focused, ErrorTable)
            assert tooltip.display
            said.append(str(tooltip.content))
        assert said == [head_text(head.replace("_", " ")) for head in heads]
        await theatre.press("shift+tab")
        assert str(tooltip.content) == said[-2]
        await theatre.press("escape")
        assert theatre.stage.focused is None
        assert not tooltip.display
        await theatre.pilot.resize_terminal(120, 40)
        await theatre.press("tab")  # where there is phase space, it comes first, as before
        assert isinstance(theatre.stage.focused, PhasePane)


def test_every_head_has_a_meaning():
    for column in (*COLUMNS, *extra_columns(SCENES["stiff-limit"].equations)):
        assert head_text(column.wide[0]) is not None
        assert head_text(column.wide[0]) == head_text(column.narrow[0])


async def test_the_longest_name_is_written_in_full():
    async with lab(SCENES["stiff-limit"], (80, 24)) as theatre:
        assert " Implicit midpoint " in theatre.text(ErrorTable)


async def test_a_head_that_is_left_out_in_a_narrow_terminal_hands_over_to_the_last_one():
    async with lab(size=(80, 24)) as theatre:
        table = theatre.stage.query_one(ErrorTable)
        await theatre.press(*["tab"] * (len(table._head) - 1))
        await theatre.pilot.resize_terminal(60, 16)
        await theatre.pilot.pause()
        assert table._chosen is not None
        assert table._chosen >= len(table._head)
        table.draw()
        assert theatre.text(ErrorTable).startswith("method")
