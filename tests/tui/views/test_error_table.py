"""The table of the lab: its rows as text, and the meaning of its heads under the pointer."""

from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.tui.drawing.picture import GOOD, QUIET, TEXT, WARN
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.views.error_table import COLUMNS, ErrorTable, extra_column, table
from pendu_tui.tui.words.cards import head_text
from tests.tui.harness import after
from tests.tui.harness import lab as on_screen


def lab(seconds: float = 12.0) -> Live:
    return after(DEFAULT_SCENE, seconds)


def test_red_is_for_failures_alone_and_signs_stand_for_colours():
    def verdicts(live):
        shown = table(live, live.sample, Shown(), 80)[1:]
        return [(words.strip(), ink) for _, (words, ink), *_ in shown]

    live = lab(20.0)
    words = (("+ grows", TEXT), ("= bounded", GOOD), ("= bounded", GOOD), ("- loses", TEXT))
    assert verdicts(live) == [*words]
    *others, rk4 = live.sample.readings
    readings = (*others, rk4._replace(diverged_at=0.8))
    live.history.sample = live.sample._replace(readings=readings)
    assert verdicts(live) == [*words[:3], ("! failed", WARN)]
    assert {ink for _, ink in table(live, live.sample, Shown(), 80)[4][2:]} == {QUIET}
    assert [ink for words, ink in verdicts(lab(1.0))] == [QUIET] * 4


async def test_a_head_under_the_pointer_says_what_it_means():
    async with on_screen() as theatre:
        shown = theatre.stage.query_one(ErrorTable)
        head = theatre.text(ErrorTable).splitlines()[0]
        first, second = shown._head[:2]
        for at, name in ((len(first) - 1, first), (len(first), second)):
            await theatre.pilot.hover(ErrorTable, offset=(at, 0))
            assert shown.tooltip == head_text(name.strip())
        await theatre.pilot.hover(ErrorTable, offset=(head.index("verdict"), 2))
        assert shown.tooltip is None


async def test_a_click_on_a_row_shows_its_method_alone():
    async with on_screen() as theatre:
        for row, places in ((0, [0, 1, 2, 3]), (4, [3]), (1, [0, 1, 2, 3]), (1, [0])):
            await theatre.click(ErrorTable, 5, row)
            await theatre.run(0.1)
            assert theatre.stage.shown.places(DEFAULT_SCENE.cast) == places


def test_every_head_has_a_meaning():
    for column in (*COLUMNS, *map(extra_column, SCENES["stiff-limit"].equations.extra_columns)):
        assert head_text(column.head.narrow) == head_text(column.head.wide) is not None
