"""Themes change while the lab runs, and everything is drawn anew."""

from itertools import chain

import pytest
from rich.color import Color
from textual.app import ScreenStackError
from textual.drivers import web_driver

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.tui.drawing.picture import PALETTES, TEXT
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.app import PenduApp, portable
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.terminal.driver import PatientParser
from pendu_tui.tui.terminal.options import TerminalOptions
from pendu_tui.tui.views import VIEWS
from tests.tui.drawn import screen
from tests.tui.harness import key_of, lab


async def test_a_theme_changes_all_colours_and_no_character():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press("space")
        inks = (0, 1, 2, 3, TEXT)
        seen = {}
        for theme in ("dark", "light"):
            theatre.app.action_use_theme(theme)
            await theatre.settled()
            await theatre.pilot.pause()
            seen[theme] = screen(theatre.app)
            used = theatre.app.current_theme
            own = PALETTES[theme]
            assert used.dark == (theme == "dark")
            assert (used.primary, used.error) == (own.exact, own.warn)
            assert {used.background, used.surface, used.panel} == {own.background}
            palette = {Color.parse(PALETTES[theme].colour(ink)) for ink in inks}
            assert {style.color for row in seen[theme] for _, style in row} >= palette
        for dark, light in zip(*map(chain.from_iterable, seen.values()), strict=True):
            assert dark[0] == light[0]
            assert dark[0] == " " or dark[1].color != light[1].color


def colours(app) -> set[Color]:
    """All colours on the screen, in front and behind."""
    styles = [style for row in screen(app) for _, style in row]
    return {each for style in styles for each in (style.color, style.bgcolor)} - {None}


@pytest.mark.usefixtures("uncomputed")
async def test_the_theme_ansi_uses_the_terminals_own_colours_and_no_color_none(monkeypatch):
    async with lab() as theatre:
        theatre.app.action_use_theme("ansi")
        await theatre.run(1)
        for key in (*map(key_of, VIEWS), "i", "escape", "ctrl+p"):
            await theatre.press(key)
            found = colours(theatre.app)
            assert len(found) > 3
            assert all(each.is_system_defined or each.is_default for each in found)
    monkeypatch.setenv("NO_COLOR", "1")
    async with lab() as theatre:
        for theme in PALETTES:
            theatre.app.action_use_theme(theme)
            await theatre.pilot.pause()
            assert all(colour.is_default for colour in colours(theatre.app))


async def test_the_app_has_what_was_asked_for_and_ends_with_the_first_error(monkeypatch):
    with pytest.raises(ZeroDivisionError):  # without a terminal there is nobody to read it
        async with lab() as theatre:
            theatre.app.call_later(lambda: 1 / 0)
    monkeypatch.setenv("NO_COLOR", "")  # which means nothing
    monkeypatch.setattr(web_driver, "XTermParser", None)
    screen = LabScreen(Live(DEFAULT_SCENE))
    app = PenduApp(screen, TerminalOptions("light", "half", fps=5))
    assert not app.no_color
    assert (app.theme, screen.fps, app.character_filter.enabled) == ("light", 5, True)
    assert web_driver.XTermParser is PatientParser
    for error in (ScreenStackError(), bug := ZeroDivisionError(), OSError()):
        app._handle_exception(error)
    assert app.return_value is bug


def test_a_wide_character_has_two_cells_of_a_picture():
    svg = portable('<text x="10" y="1" textLength="30">世&lt;</text>')
    wide = '<text x="10" y="1" textLength="20">世</text>'
    assert svg == f'{wide}<text x="30" y="1" textLength="10">&lt;</text>'
    assert not portable('<text x="10" y="1" textLength="0"></text>')
