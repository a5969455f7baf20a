"""A picture on a screen: which of its rows are sent, and how they look."""

from typing import ClassVar

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.app import App, ComposeResult
from textual.filter import LineFilter
from textual.geometry import Region
from textual.strip import Strip

from pendu_tui.tui.drawing.cells import CellWidget
from pendu_tui.tui.drawing.picture import NOBODY, PALETTES, TEXT, Picture
from tests.tui.harness import until


class Drawn(CellWidget):
    """Shows its size, and keeps the lines that it painted last."""

    painted: ClassVar[list[Strip]] = []

    def draw(self) -> None:
        self.show(Picture([[(f"{self.room.width}x{self.room.height}", TEXT)]]))

    def render_lines(self, crop):
        Drawn.painted = [*super().render_lines(crop)]
        return self.painted


class Loud(LineFilter):
    def apply(self, segments, background):
        return [Segment(text.upper(), style) for text, style, _ in segments]


class CellApp(App[None]):
    filters: ClassVar[list[LineFilter]] = []

    def compose(self) -> ComposeResult:
        yield Drawn()

    def get_line_filters(self):
        return self.filters


async def test_a_picture_fits_the_room_and_only_rows_that_changed_are_made_anew():
    app = CellApp()
    async with app.run_test(size=(8, 6)) as pilot:
        cells = app.query_one(Drawn)
        await pilot.resize_terminal(4, 4)
        await until(pilot, lambda: cells.text == "4x4")
        cells.show(Picture([[(letter, TEXT)] for letter in "abcd"]))
        await pilot.pause()
        before = cells.painted
        cells.show(Picture([[(letter, TEXT)] for letter in "abC"]))
        await pilot.pause()
        assert cells.text == "a\nb\nC"
        assert [each.text for each in cells.painted] == ["a   ", "b   ", "C   ", "    "]
        assert cells.painted[2].crop(0, 4).text == "C   "
        kept = [old is new for old, new in zip(before, cells.painted, strict=True)]
        assert kept == [True, True, False, False]
        # a row may bring its own style
        cells.show(Picture([[("x", Style(color="#010203", reverse=True)), ("y", NOBODY)]]))
        x, y = list(cells.render_line(0))[:2]
        assert (x.text, x.style.color.name, x.style.reverse) == ("x", "#010203", True)
        assert x.style.bgcolor == y.style.bgcolor
        app.theme = "textual-light"
        await pilot.pause()
        assert [*cells.painted[0]][1].style.color.name == PALETTES["light"].text.lower()


async def test_the_front_of_a_line_is_cut_off_where_textual_would_cut_it(monkeypatch):
    app = CellApp()
    async with app.run_test(size=(8, 3)) as pilot:
        cells = app.query_one(Drawn)
        cells.styles.border = ("round", "red")
        await pilot.pause()
        for text in ("abc", "abx", "世x"):
            end = "def"[: 6 - cell_len(text)]
            cells.show(Picture([[(text, TEXT), (end, NOBODY)], [("no room", TEXT)]]))
            await pilot.pause()
            line = cells.painted[1]
            assert [each.text for each in cells.painted[1:]] == [f"│{text}def│", "╰──────╯"]
            for end in range(1, 9):
                assert line.crop(0, end) == Strip([*line]).crop(0, end)
        recoloured = Picture([[("b", 0), ("y", 1)]]).changes(Picture([[("a", 0), ("y", 0)]]), 2)
        assert [*recoloured] == [(0, 2, 0)]
        cells.show(Picture([[("世bcdef", TEXT)]]))
        await pilot.pause()
        assert cells.painted[1].text == "│世bcde│"
        monkeypatch.setattr(CellApp, "filters", [Loud()])
        app.refresh_css(animate=False)
        await pilot.pause()
        for text in ("loud", "more"):
            cells.show(Picture([[(text, TEXT)]]))
            await pilot.pause()
            assert cells.painted[1].text == f"│{text.upper()}  │"
        for text in ("part", "next"):
            cells.show(Picture([[(text, TEXT)]]))
            lines = cells.render_lines(Region(0, 1, 8, 2))
            assert [each.text for each in lines] == [f"│{text.upper()}  │", "╰──────╯"]
        (line,) = cells.render_lines(Region(0, 0, 8, 1))
        assert line.text == "╭──────╮"
        cells.on_show()
        assert (cells.text, cells.drawable) == ("6x1", True)
        cells.display = False
        await pilot.pause()
        assert not cells.drawable
