"""The lab on a terminal that is too small, and that grows again."""

from pendu_tui.tui.screens.lines import StatusLine, TooSmall
from tests.tui.harness import lab


async def test_below_60x16_a_message_gives_the_size_needed_and_the_keys_still_work():
    async with lab(size=(50, 12)) as theatre:
        assert "Terminal too small: 50x12, need 60x16" in theatre.text(TooSmall)
        assert not theatre.stage.query_one(StatusLine).is_on_screen
        await theatre.press("greater_than_sign")
        assert theatre.source.playhead.speed == 2
        await theatre.pilot.resize_terminal(80, 24)
        await theatre.run(0.1)
        assert "2×" in theatre.text(StatusLine)
        assert not theatre.stage.query_one(TooSmall).is_on_screen
