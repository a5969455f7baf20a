"""Notices lie where they cover no number."""

from textual.widgets._toast import Toast

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.screens.lines import InsightLine
from tests.tui.harness import lab, until


async def test_a_moment_is_marked_once_and_the_notice_lies_on_the_insight_line():
    app = PenduApp(LabScreen(Live(DEFAULT_SCENE, clock=lambda: 0.0), lambda: 0.0))
    async with app.run_test(size=(80, 24), notifications=True) as pilot:
        await pilot.press("m")
        await until(pilot, lambda: any(toast.region for toast in app.screen.query(Toast)))
        region = app.screen.query_one(Toast).region
        assert region.height == 1
        assert app.screen.query_one(InsightLine).region.contains_region(region)
        await pilot.press("m")
        notices = [notice.message for notice in app._notifications]
        assert notices == ["Mark at 0.00 s", "Already marked"]
        assert [event.kind for event in app.lab.source.events].count("mark") == 1


async def test_equal_notices_replace_each_other():
    async with lab(DEFAULT_SCENE.altered(h=5e-10)) as theatre:
        await theatre.press(*["minus"] * 9, "m")
        assert len(theatre.app._notifications) == 2
