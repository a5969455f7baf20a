"""Panes of the lab: when they are drawn, words that fit, clicks on events, and the table."""

from unittest.mock import Mock

import pytest
from textual.geometry import Size

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import DEFAULT_SCENE, SCENES
from pendu_tui.tui.drawing.picture import TEXT
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.views.error_table import COLUMNS, STEP_SIZE, ErrorTable, extra_column, table
from pendu_tui.tui.views.lab import EventList, TimeChart
from pendu_tui.tui.views.phase import PhasePane, SectionPane
from pendu_tui.tui.views.stage import Stage
from pendu_tui.tui.views.view import Pane
from pendu_tui.tui.words.cards import head_text
from tests.tui.harness import after, lab


async def test_a_click_on_an_event_goes_there_and_beside_them_opens_all():
    async with lab(size=(90, 32)) as theatre:
        await theatre.run(8)
        listed = theatre.pane(EventList)
        assert listed.text.splitlines()[1] == " 7.15 s Explicit Euler over th…"
        await theatre.click(listed, 8, 2)
        assert theatre.sample.t == pytest.approx(7.15)
        for row in (0, 3):  # on the border, and below the last one
            await theatre.click(listed, 5, row)
            assert theatre.app.screen.title == "Events"
            await theatre.press("escape")


@pytest.mark.parametrize(
    ("kind", "a_second"),
    [(Stage, 60), (SectionPane, 15), (PhasePane, 10), (ErrorTable, 5), (TimeChart, 3)],
)
@pytest.mark.parametrize("fps", [5, 8, 10, 20, 30, 60])
def test_a_pane_is_drawn_as_often_as_it_asks_at_any_number_of_frames(fps, kind, a_second):
    pane = kind()
    drawn = []
    pane.draw = lambda: drawn.append(pane.sample)
    passed = 60 // fps
    for frame in range(1, 10 * fps + 1):
        pane.follow(None, frame, Shown(), frame * passed)
    assert len(drawn) == min(10 * fps, fps * passed * a_second // 6)


async def test_what_needs_numpy_is_drawn_after_the_first_paint(monkeypatch):
    begin = LabScreen.begin
    monkeypatch.setattr(LabScreen, "begin", Mock())
    async with lab() as theatre:
        stage = theatre.stage
        assert {type(each) for each in stage.query(Pane) if not each.sample} == {
            PhasePane,
            TimeChart,
        }
        await begin(stage)
        assert all(each.sample for each in stage.query(Pane))


def test_a_text_that_is_longer_than_its_rows_ends_with_an_ellipsis():
    pane = Pane()
    pane.room = Size(10, 2)
    texts = "one two", "three four five"
    assert pane.words(*texts, rows=2) == [[("one two", TEXT)], [("three …", TEXT)]]
    assert pane.words(*texts, rows=3)[-1] == [("five", TEXT)]
    assert pane.words("one two-three", rows=1) == [[("one …", TEXT)]]


def test_a_step_size_that_does_not_fit_is_rounded():
    cells = [STEP_SIZE.cell(Mock(h=h), 6) for h in (0.0125, 0.06667, -0.0026)]
    assert cells == ["0.0125", " 0.067", "-3e-03"]
    live = after(DEFAULT_SCENE, 1)
    live.change(Stepping(0.001234, equal_cost=True))
    live.step(1)
    rows = table(live, live.sample, Shown(), 80)
    assert len({sum(len(text) for text, _ in row) for row in rows}) == 1  # heads are above them


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


async def test_tab_finds_phase_space_only_where_there_is_room_for_it():
    for rows, count in ((18, 0), (30, 1)):
        async with lab(size=(80, rows)) as theatre:
            assert len(theatre.stage.focus_chain) == count


async def test_a_click_on_a_row_shows_its_method_alone():
    async with lab() as theatre:
        for row, places in ((0, [0, 1, 2, 3]), (4, [3]), (1, [0, 1, 2, 3]), (1, [0])):
            await theatre.click(ErrorTable, 5, row)
            await theatre.run(0.1)
            assert theatre.stage.shown.places(DEFAULT_SCENE.cast) == places


def test_every_head_has_a_meaning():
    for column in (*COLUMNS, *map(extra_column, SCENES["stiff-limit"].equations.extra_columns)):
        assert head_text(column.head.narrow) == head_text(column.head.wide) is not None
