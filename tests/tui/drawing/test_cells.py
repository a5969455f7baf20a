"""A picture on a screen: which of its rows are sent, and how they look."""

from typing import ClassVar

from rich.style import Style
from textual.app import App, ComposeResult
from textual.strip import Strip

from tui.drawing.cells import CellWidget
from tui.drawing.palette import NOBODY, TEXT
from tui.drawing.picture import Picture


class Drawn(CellWidget):
    """Shows its size, and keeps the lines that it painted last."""

    painted: ClassVar[list[Strip]] = []

    def draw(self) -> None:
        self.show(Picture.of_line(f"{self.room.width}x{self.room.height}", TEXT))

    def render_lines(self, crop):
        Drawn.painted = [*super().render_lines(crop)]
        return self.painted


class CellApp(App[None]):
    """One widget of cells."""

    def compose(self) -> ComposeResult:
        yield Drawn()


async def test_only_rows_that_changed_are_made_anew():
    app = CellApp()
    async with app.run_test(size=(4, 4)) as pilot:
        cells = app.query_one(Drawn)
        cells.show(Picture([[(letter, TEXT)] for letter in "abcd"]))
        await pilot.pause()
        assert cells.text == "a\nb\nc\nd"
        before = cells.painted
        cells.show(Picture([[(letter, TEXT)] for letter in "abC"]))
        await pilot.pause()
        assert cells.text == "a\nb\nC"
        kept = [old is new for old, new in zip(before, cells.painted, strict=True)]
        assert kept == [True, True, False, False]


async def test_a_row_may_bring_its_own_style():
    app = CellApp()
    async with app.run_test(size=(4, 4)):
        cells = app.query_one(Drawn)
        cells.show(Picture([[("x", Style(color="#010203", reverse=True)), ("y", NOBODY)]]))
        x, y = list(cells.render_line(0))[:2]
        assert (x.text, x.style.color.name, x.style.reverse) == ("x", "#010203", True)
        assert x.style.bgcolor == y.style.bgcolor


async def test_a_picture_is_drawn_for_the_room_that_there_is():
    app = CellApp()
    async with app.run_test(size=(8, 4)) as pilot:
        await pilot.resize_terminal(9, 6)
        await pilot.pause()
        assert app.query_one(Drawn).text == "9x6"
