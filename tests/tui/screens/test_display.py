"""Themes and pixels change while the lab runs, and everything is drawn anew."""

import re

import pytest
from rich.color import Color

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.tui.drawing.picture import PALETTES, TEXT
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.views import VIEWS
from tests.tui.conftest import lines_of
from tests.tui.harness import key_of, lab
from tests.tui.monkey import small_studies


@pytest.fixture(autouse=True)
def small(tmp_path):
    with small_studies(tmp_path):
        yield


async def picture(theatre) -> str:
    await theatre.pilot.pause()
    await theatre.settled()
    await theatre.pilot.pause()
    return theatre.app.export_screenshot()


async def test_a_theme_changes_all_colours_and_no_character():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press("space")
        before = await picture(theatre)
        theatre.app.action_use_theme("light")
        after = await picture(theatre)
        assert lines_of(before) == lines_of(after)
        colours = {found.upper() for found in re.findall(r"fill: (#[0-9a-fA-F]{6})", after)}
        inks = (0, 1, 2, 3, TEXT)
        old, new = (
            {PALETTES[theme].colour(ink).upper() for ink in inks} for theme in ("dark", "light")
        )
        assert not colours & old
        assert colours >= new


def colours(app) -> set[Color]:
    """All colours on the screen, in front and behind."""
    strips = app.screen._compositor.render_strips()
    styles = [segment.style for strip in strips for segment in strip if segment.style]
    return {each for style in styles for each in (style.color, style.bgcolor)} - {None}


async def test_the_theme_ansi_uses_the_terminals_own_colours_and_no_others():
    async with lab() as theatre:
        theatre.app.action_use_theme("ansi")
        await theatre.run(1)
        for key in (*map(key_of, VIEWS), "i"):
            await theatre.press(key)
            await theatre.pilot.pause(0.3)
            found = colours(theatre.app)
            assert len(found) > 3
            assert all(each.is_system_defined or each.is_default for each in found)


async def test_no_color_leaves_no_colour_whatever_the_theme(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    async with lab() as theatre:
        for theme in PALETTES:
            theatre.app.action_use_theme(theme)
            await theatre.pilot.pause()
            assert all(colour.is_default for colour in colours(theatre.app))


def test_an_empty_no_color_means_nothing(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "")
    assert not PenduApp(LabScreen(Live(DEFAULT_SCENE))).no_color
