"""Notices lie where they cover no number."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from textual.widgets._toast import Toast

from engine.scenes import DEFAULT_SCENE, Scene
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.lines import InsightLine
from tui.screens.live import LiveScreen


@asynccontextmanager
async def noticed(*keys: str, scene: Scene = DEFAULT_SCENE) -> AsyncIterator[Any]:
    """A lab after some keys, with a notice on its screen."""
    app = PenduApp(LiveScreen(Live(scene, clock=lambda: 0.0), lambda: 0.0))
    async with app.run_test(size=(80, 24), notifications=True) as pilot:
        await pilot.press(*keys)
        async with asyncio.timeout(20):
            while not (toasts := app.screen.query(Toast)) or not toasts.first().region:
                await pilot.pause(0.01)
        yield app


async def test_the_notice_of_a_mark_lies_on_the_insight_line():
    async with noticed("m") as app:
        region = app.screen.query_one(Toast).region
        assert region.height == 1
        assert app.screen.query_one(InsightLine).region.contains_region(region)


async def test_equal_notices_replace_each_other():
    async with noticed(*["minus"] * 9, "m", scene=DEFAULT_SCENE.altered(h=5e-10)) as app:
        assert len(app._notifications) == 2


async def test_a_moment_is_marked_only_once_and_the_second_time_a_notice_says_so():
    async with noticed("m", "m") as app:
        words = [notice.message for notice in app._notifications]
        assert words == ["Mark at 0.00 s", "Already marked"]
        events = app.source_screen.source.events
        assert [event.kind for event in events].count("mark") == 1
