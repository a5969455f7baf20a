"""The lab at every size, and while the size changes."""

from tests.tui.harness import lab
from tui.screens.lines import StatusLine, TooSmall


def on_screen(theatre, kind) -> list[tuple[int, int, int, int]]:
    """Where the visible widgets of a kind are: x, y, width, height."""
    return [tuple(widget.region) for widget in theatre.stage.query(kind) if widget.is_on_screen]


async def test_below_60x16_a_message_gives_the_size_needed_and_the_keys_still_work():
    async with lab(size=(50, 12)) as theatre:
        assert "Terminal too small: 50x12, need 60x16" in theatre.text(TooSmall)
        assert not on_screen(theatre, StatusLine)
        await theatre.press("greater_than_sign")
        assert theatre.source.playhead.speed == 2
        await theatre.pilot.resize_terminal(80, 24)
        await theatre.run(0.1)
        assert "2×" in theatre.text(StatusLine)
        assert not on_screen(theatre, TooSmall)
