"""What lies over the lab is closed once, and nothing else with it."""

from textual.containers import VerticalScroll

from tests.tui.harness import lab
from tui.screens.text import TextScreen


async def opened(theatre) -> TextScreen:
    await theatre.press("question_mark")
    help_screen = theatre.app.screen
    assert isinstance(help_screen, TextScreen)
    return help_screen


async def test_asked_twice_it_closes_itself_only():
    async with lab() as theatre:
        help_screen = await opened(theatre)
        help_screen.dismiss()
        help_screen.dismiss()
        await theatre.pilot.pause()
        assert theatre.app.screen is theatre.stage


async def test_asked_while_something_lies_over_it_it_waits_until_it_is_asked_again():
    async with lab() as theatre:
        help_screen = await opened(theatre)
        above = TextScreen("Above", "it")
        await theatre.app.push_screen(above)
        help_screen.dismiss()
        await theatre.pilot.pause()
        assert theatre.app.screen is above
        await theatre.press("escape", "escape")
        assert theatre.app.screen is theatre.stage


async def test_with_reduced_motion_a_text_scrolls_at_once():
    async with lab() as theatre:
        theatre.app.animation_level = "none"
        help_screen = await opened(theatre)
        places: list[float] = []
        scroll = help_screen.query_one(VerticalScroll)
        scroll.watch(scroll, "scroll_y", lambda y: places.append(y), init=False)
        await theatre.press("pagedown")
        assert places == [scroll.scroll_target_y]
        assert places[0] > 0
