"""Notices lie where they cover no number."""

import asyncio
import itertools

from textual.notifications import Notification
from textual.widgets._toast import Toast

from engine.scenes import DEFAULT_SCENE
from tui.playback.live import Live
from tui.screens.app import PenduApp
from tui.screens.lines import InsightLine
from tui.screens.live import LiveScreen


async def test_the_notice_of_a_mark_lies_on_the_insight_line():
    app = PenduApp(LiveScreen(Live(DEFAULT_SCENE, clock=lambda: 0.0), lambda: 0.0))
    async with app.run_test(size=(80, 24), notifications=True) as pilot:
        await pilot.press("m")
        async with asyncio.timeout(20):
            while not (toasts := app.screen.query(Toast)) or not toasts.first().region:
                await pilot.pause(0.01)
        assert toasts.first().region.height == 1
        assert app.screen.query_one(InsightLine).region.contains_region(toasts.first().region)


async def test_equal_notices_replace_each_other():
    app = PenduApp(LiveScreen(Live(DEFAULT_SCENE.altered(h=5e-10), clock=lambda: 0.0), lambda: 0.0))
    async with app.run_test(size=(80, 24), notifications=True) as pilot:
        await pilot.press(*["minus"] * 9)
        assert len(app._notifications) == 1
        async with asyncio.timeout(20):
            while len(app.screen.query(Toast)) != 1:
                await pilot.pause(0.01)
        await pilot.press("m")
        assert len(app._notifications) == 2


async def test_a_notice_may_expire_while_another_is_about_to_be_shown(monkeypatch):
    app = PenduApp(LiveScreen(Live(DEFAULT_SCENE, clock=lambda: 0.0), lambda: 0.0))
    async with app.run_test(size=(80, 24), notifications=True) as pilot:
        app.notify("one")
        await pilot.pause()
        assert app._notifications
        expires = itertools.chain([False], itertools.repeat(True))
        monkeypatch.setattr(Notification, "has_expired", property(lambda self: next(expires)))
        app.notify("another")
        monkeypatch.undo()
        await pilot.pause()
        assert "another" in [notice.message for notice in app._notifications]


async def test_a_moment_is_marked_only_once_and_the_second_time_a_notice_says_so():
    live = Live(DEFAULT_SCENE, clock=lambda: 0.0)
    app = PenduApp(LiveScreen(live, lambda: 0.0))
    async with app.run_test(size=(80, 24), notifications=True) as pilot:
        await pilot.press("m", "m")
        assert [notice.message for notice in app._notifications] == [
            "Mark at 0.00 s",
            "Already marked",
        ]
    assert [event.kind for event in live.events].count("mark") == 1
