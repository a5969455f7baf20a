"""What lies over the lab is closed once, and nothing else with it."""

from textual.containers import VerticalScroll

from tests.tui.stage import lab
from tui.screens.help import Help
from tui.screens.text import TextScreen


async def opened(theatre) -> Help:
    await theatre.press("question_mark")
    reader = theatre.app.screen
    assert isinstance(reader, Help)
    return reader


async def test_asked_twice_it_closes_itself_only():
    async with lab() as theatre:
        reader = await opened(theatre)
        reader.dismiss()
        reader.dismiss()
        await theatre.pilot.pause()
        assert theatre.app.screen is theatre.stage


async def test_asked_while_something_lies_over_it_it_waits_until_it_is_asked_again():
    async with lab() as theatre:
        reader = await opened(theatre)
        above = TextScreen("Above", "it")
        await theatre.app.push_screen(above)
        reader.dismiss()
        await theatre.pilot.pause()
        assert theatre.app.screen is above
        await theatre.press("escape", "escape")
        assert theatre.app.screen is theatre.stage


async def test_with_reduced_motion_a_text_scrolls_at_once():
    async with lab() as theatre:
        theatre.app.animation_level = "none"
        reader = await opened(theatre)
        places: list[float] = []
        scroll = reader.query_one(VerticalScroll)
        scroll.watch(scroll, "scroll_y", lambda y: places.append(y), init=False)
        await theatre.press("pagedown")
        assert places == [scroll.scroll_target_y]
        assert places[0] > 0
