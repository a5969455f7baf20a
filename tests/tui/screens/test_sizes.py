"""The lab at every size, and while the size changes."""

import random

import pytest

from tests.tui.harness import eventful, lab, player
from tui.screens.lines import StatusLine, TooSmall
from tui.screens.replay import SeekBar
from tui.views import VIEWS
from tui.views.lab.error_table import ErrorTable
from tui.views.lab.pendulums import Pendulum
from tui.views.lab.time_chart import TimeChart


def on_screen(theatre, kind) -> list[tuple[int, int, int, int]]:
    """Where the visible widgets of a kind are: x, y, width, height."""
    return [tuple(widget.region) for widget in theatre.stage.query(kind) if widget.is_on_screen]


@pytest.mark.parametrize(
    ("size", "pendulums", "charts"),
    [
        ((60, 16), 1, 0),
        ((80, 24), 1, 1),
        ((120, 30), 1, 1),
        ((81, 50), 1, 1),
        ((120, 40), 4, 1),
        ((200, 60), 4, 2),
    ],
)
async def test_what_fits_is_shown_and_nothing_is_cut_off(size, pendulums, charts):
    async with lab(size=size) as theatre:
        await theatre.run(1)
        assert len(on_screen(theatre, Pendulum)) == pendulums
        assert len(on_screen(theatre, TimeChart)) == charts
        assert len(theatre.text(ErrorTable).splitlines()) == 5
        for widget in theatre.stage.query("CellWidget"):
            if widget.is_on_screen:
                x, y, width, height = widget.region
                assert x + width <= size[0]
                assert y + height <= size[1]
                assert min(width, height) >= 1


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


@pytest.mark.slow
async def test_a_storm_of_sizes_in_every_view_leaves_the_lab_whole():
    storm = random.Random(7)
    async with lab() as theatre:
        for name in VIEWS:
            await theatre.stage.run_action(f"view({name!r})")
            for _ in range(8):
                await theatre.pilot.resize_terminal(storm.randint(1, 220), storm.randint(1, 70))
                await theatre.run(0.1)
        await theatre.stage.run_action("view('lab')")
        await theatre.pilot.resize_terminal(120, 40)
        await theatre.run(0.1)
        assert len(on_screen(theatre, Pendulum)) == 4
        assert "running" in theatre.text(StatusLine)


async def test_the_replay_has_one_row_more_at_every_size(tmp_path):
    path = eventful(tmp_path / "eventful.mcap")
    async with player(path, size=(80, 24)) as theatre:
        for width, height in ((60, 16), (80, 24), (120, 40)):
            await theatre.pilot.resize_terminal(width, height)
            await theatre.run(0.1)
            ((_, _, bar, one),) = on_screen(theatre, SeekBar)
            assert (bar, one) == (width, 1)
            assert len(theatre.text(SeekBar).rstrip()) <= width
