"""Rows of characters on a screen: which of them are sent, and how thick lines are."""

import gc
from typing import ClassVar

from hypothesis import given
from hypothesis import strategies as st
from rich.segment import Segment
from rich.style import Style
from textual.app import App, ComposeResult
from textual.strip import Strip

from tests.tui.drawing.test_canvas import dots
from tui.drawing.canvas import Canvas
from tui.drawing.cells import CellWidget
from tui.drawing.painted import Line
from tui.drawing.palette import NOBODY, TEXT


class CellApp(App[None]):
    """A widget of cells that keeps what it asked to be sent."""

    def compose(self) -> ComposeResult:
        yield CellWidget()

    def on_mount(self) -> None:
        self.cells = self.query_one(CellWidget)
        self.sent: list[int] = []
        self.cells._refresh_rows = self.sent.extend


async def test_only_rows_that_changed_are_sent_and_no_more_than_asked_for():
    rows = [[(letter, TEXT)] for letter in "abcd"]
    app = CellApp()
    async with app.run_test(size=(4, 4)):
        assert not app.cells.show(rows, at_once=2)
        assert app.cells.text == "a\nb\n\n"
        assert app.cells.show(rows, at_once=2)
        assert app.cells.text == "a\nb\nc\nd"
        rows[2] = [("C", TEXT)]
        assert app.cells.show(rows)
        assert app.cells.show(rows[:3], at_once=0)
        assert app.sent == [0, 1, 2, 3, 2, 3]
        assert app.cells.text == "a\nb\nC"


async def test_a_row_may_bring_its_own_style():
    app = CellApp()
    async with app.run_test(size=(4, 4)):
        app.cells.show([[("x", Style(color="#010203", reverse=True)), ("y", NOBODY)]])
        x, y = list(app.cells.render_line(0))[:2]
        assert (x.text, x.style.color.name, x.style.reverse) == ("x", "#010203", True)
        assert x.style.bgcolor == y.style.bgcolor


class Drawn(CellWidget):
    """Tells its size; keeps what was painted of it."""

    painted: ClassVar[list[str]] = []

    def draw(self) -> None:
        self.show([[(f"{self.room.width}x{self.room.height}", TEXT)]])

    def render_lines(self, crop):
        lines = super().render_lines(crop)
        self.painted.append(lines[0].text.strip())
        return lines


async def test_what_is_painted_is_drawn_for_the_room_that_it_has_from_the_first_paint_on():
    app = App()
    app.compose = lambda: [Drawn()]
    Drawn.painted.clear()
    async with app.run_test(size=(8, 4)) as pilot:
        await pilot.resize_terminal(9, 6)
    assert list(dict.fromkeys(Drawn.painted)) == ["8x4", "9x6"]


@given(st.sets(st.tuples(st.integers(0, 7), st.integers(0, 7))))
def test_thick_lines_cover_the_thin_ones_and_are_two_dots_thick(points):
    canvas = Canvas(4, 2)
    for x, y in points:
        canvas.points(x, y, 1)
    thin = canvas.picture()
    grown = dots(thin.thick())
    assert points <= grown
    for x, y in grown:
        assert (x ^ 1, y) in grown
        assert {(x, y - 1), (x, y + 1)} & grown
    assert {(x // 2, y // 4) for x, y in grown} == {(x // 2, y // 4) for x, y in points}
    assert thin.thick().owners is thin.owners


def test_thick_lines_leave_words_alone():
    canvas = Canvas(6, 1)
    canvas.label(0, 0, "wörd\u2802", TEXT)
    assert canvas.picture().thick().text[:4] == "wörd"


def test_a_row_that_has_been_cut_leaves_nothing_to_the_collector():
    def cut(kind):
        gc.collect()
        [kind([Segment("abc")], 3).divide(cuts) for cuts in ([3], [1, 3])]
        return gc.collect()

    assert cut(Strip) > 0
    assert cut(Line) == 0


def test_a_row_is_cut_like_any_strip():
    row = [Segment("abc"), Segment("de")]
    for cuts in ([5], [2, 5], [2], [1, 4, 9]):
        assert Line(row, 5).divide(iter(cuts)) == Strip(row, 5).divide(cuts)
