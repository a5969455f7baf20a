"""What lies over the lab: dialogs that close once, notices that cover no number, and "too small"."""

from contextlib import ExitStack
from unittest.mock import Mock

from textual.events import Resize
from textual.geometry import Size
from textual.screen import Screen
from textual.widgets._toast import Toast
from textual.widgets._tooltip import Tooltip

from pendu_tui.engine.scenes import DEFAULT_SCENE
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.dialogs import TextScreen
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.screens.lines import InsightLine, LessonPanel, StatusLine, TooSmall
from pendu_tui.tui.views.error_table import ErrorTable
from tests.tui.drawn import looks, screen
from tests.tui.harness import lab, until


async def test_a_text_closes_only_itself_however_often_it_is_dismissed():
    async with lab() as theatre:
        await theatre.press("question_mark")
        help_screen = theatre.app.screen
        assert "\n\n\n" not in help_screen.text  # panes without keys are not in it
        above = TextScreen("Above", "[b]it")
        await theatre.app.push_screen(above)
        assert "[b]it" in "".join(cell for row in screen(theatre.app) for cell, _ in row)
        help_screen.dismiss()
        await theatre.pilot.pause()
        assert theatre.app.screen is above
        await theatre.press("escape")
        help_screen.dismiss()
        help_screen.dismiss()
        await theatre.pilot.pause()
        assert theatre.app.screen is theatre.stage
        await theatre.press("i")
        await theatre.pilot.click(offset=(0, 0))
        assert theatre.app.screen is theatre.stage
        theatre.app.call_later(theatre.stage.action_start_values)  # and the app ends meanwhile


async def test_what_lies_over_the_lab_can_be_as_narrow_as_a_terminal():
    async with lab() as theatre:
        theatre.app._disable_notifications = False
        for opening in ("question_mark", "i", "ctrl+p"):
            await theatre.press(opening)
            theatre.app.notify(f"{opening}: words that take more than a line")
            await theatre.pilot.pause()
            assert theatre.app.screen.query(Toast)
            for size in ((12, 30), (1, 1)):
                await theatre.pilot.resize_terminal(*size)
            await theatre.press("escape")
            assert theatre.app.screen is theatre.stage


async def test_an_outdated_size_is_ignored_or_two_would_call_each_other_up_for_ever(monkeypatch):
    arranged = []

    async def arrange(self, event):
        arranged.append(event.size)

    async with lab(size=(80, 24)) as theatre:
        await theatre.press("i")
        monkeypatch.setattr(Screen, "_on_resize", arrange)
        for size in (Size(70, 11), Size(80, 24)):
            theatre.app.screen.post_message(Resize(size, size))
            await theatre.pilot.pause()
    assert arranged == [Size(80, 24)]


async def test_notices_lie_on_the_insight_line_and_replace_each_other(snapshot, monkeypatch):
    monkeypatch.setattr(PenduApp, "TOOLTIP_DELAY", 0.01)
    live = Live(DEFAULT_SCENE.altered(h=5e-10), clock=lambda: 0.0)
    live.tick(0.0)
    app = PenduApp(LabScreen(live, lambda: 0.0))
    async with app.run_test(size=(80, 24), tooltips=True, notifications=True) as pilot:
        await pilot.press("m")
        await pilot.hover(ErrorTable, offset=(30, 0))
        for over in (Toast, Tooltip):
            await until(
                pilot, lambda over=over: any(each.region for each in app.screen.query(over))
            )
        snapshot("notice.txt", looks(app))
        await pilot.press("m", *["minus"] * 9)
        (refused,) = app._notifications
        assert "not a usable" in refused.message
        assert (refused.severity, refused.markup, refused.timeout) == ("warning", False, 15)
        app.notify("replaced before it is shown")
        app.notify("\x1b[2J" + 996 * "x")
        await pilot.pause()
        (shown,) = app._notifications
        assert shown.message == "\N{REPLACEMENT CHARACTER}[2J" + 996 * "x"
        assert [event.kind for event in live.events].count("mark") == 1


async def test_below_60x16_a_message_gives_the_size_needed_and_the_keys_still_work():
    async with lab(size=(50, 12)) as theatre:
        assert "Terminal too small: 50x12, need 60x16" in looks(theatre.app)
        assert not theatre.pane(StatusLine).is_on_screen
        await theatre.press("greater_than_sign")
        assert theatre.playhead.speed == 2
        await theatre.pilot.resize_terminal(80, 24)
        await theatre.settled()
        await theatre.run(0.1)
        assert "2×" in theatre.text(StatusLine)
        assert not theatre.pane(TooSmall).is_on_screen
        for size, heights in (((119, 23), [6, 1]), ((120, 24), [4, 2])):
            await theatre.pilot.resize_terminal(*size)
            await theatre.pilot.pause()
            lines = map(theatre.pane, (LessonPanel, InsightLine))
            assert [line.styles.height.value for line in lines] == heights


async def test_ctrl_z_stops_the_program_while_the_terminal_is_the_shells_but_not_a_visitors(
    monkeypatch,
):
    acts = []
    suspended = ExitStack()
    suspended.callback(acts.append, "back")
    monkeypatch.setattr(PenduApp, "suspend", lambda app: suspended)
    monkeypatch.setattr("pendu_tui.tui.screens.app.stop", lambda: acts.append("stopped"))
    monkeypatch.setattr("pendu_tui.tui.screens.app.CAN_STOP", True)
    async with lab() as theatre:
        for is_web in (False, True):
            monkeypatch.setattr(PenduApp, "is_web", is_web)
            await theatre.press("i", "ctrl+z")
            assert acts == ["stopped", "back"]
        theatre.app.refresh = Mock()
        theatre.app.app_resume_signal.publish(theatre.app)
        await theatre.pilot.pause()
        theatre.app.refresh.assert_any_call()
