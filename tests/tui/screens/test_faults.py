"""What fails in a pane, a dialog or a worker costs the lab no more than that."""

import asyncio

import pytest
from textual.widgets import Static

from engine.scenes import DEFAULT_SCENE
from recordings.library import resolve
from recordings.live_recorder import LiveRecorder
from recordings.recording import Recording
from recordings.verify import verify
from tests.tui.harness import Theatre, lab, on_stage, player
from tests.tui.pty_lab import PtyLab
from tests.tui.terminal.test_lab_terminal import PENDU
from tui.drawing.faults import LOG, sentence
from tui.playback.live import Live
from tui.screens.dialogs.start_form import StartForm
from tui.screens.dialogs.text import TextScreen
from tui.screens.insight_line import InsightLine
from tui.screens.key_line import KeyLine
from tui.screens.live import LiveScreen
from tui.views.accuracy.pane import AccuracyPane
from tui.views.lab.error_table import ErrorTable
from tui.views.lab.event_list import EventList
from tui.views.lab.time_chart import TimeChart
from tui.views.stability.pane import StabilityPane

BROKEN = ZeroDivisionError("the drawing")


def broken(*_: object, **__: object) -> None:
    raise BROKEN


def recorded_lab(path):
    def make(clock):
        live = Live(DEFAULT_SCENE, clock=lambda: 0.0)
        live.record(LiveRecorder(path))
        return LiveScreen(live, clock)

    return on_stage(make, (120, 40))


def notices(theatre: Theatre) -> list[str]:
    return [notice.message for notice in theatre.app._notifications]


async def goes_on(theatre: Theatre) -> None:
    """The lab follows the clock and its keys, and what is whole is drawn."""
    t = theatre.source.sample.t
    await theatre.run(1.0)
    assert theatre.source.sample.t > t
    theatre.stage.frame()
    await theatre.press("space")
    assert theatre.source.playhead.paused
    assert "paused" in theatre.text("StatusLine")
    await theatre.press("space")


@pytest.mark.parametrize("place", ["paint", "_pieces", "on_resize"])
async def test_a_pane_that_cannot_be_drawn_says_so_and_the_lab_records_on(tmp_path, faults, monkeypatch, place):
    path = tmp_path / "run.mcap"
    async with recorded_lab(path) as theatre:
        await goes_on(theatre)
        monkeypatch.setattr(ErrorTable, place, broken)
        await theatre.run(1.0)
        await theatre.pilot.resize_terminal(121, 41)
        await goes_on(theatre)
        if place == "paint":
            assert "the drawing" in theatre.text(ErrorTable)
        assert faults == [BROKEN]  # once, however often it is tried
        monkeypatch.undo()
        await theatre.pilot.resize_terminal(120, 40)
        await theatre.run(1.0)
        assert "dE/E0" in theatre.text(ErrorTable)
        theatre.source.close()
    faults.clear()
    assert verify(path).identical
    with Recording.open(path) as recording:
        assert recording.length > 3


async def test_a_chart_that_cannot_be_built_says_so_until_one_can(faults, monkeypatch):
    async with lab() as theatre:
        await theatre.settled()
        monkeypatch.setattr("tui.drawing.time_chart.time_chart", broken)
        monkeypatch.setattr(TimeChart, "show_picture", broken)
        await theatre.run(1.0)
        await theatre.settled()
        assert "the drawing" in theatre.text(TimeChart)
        monkeypatch.undo()
        await theatre.run(1.0)
        await theatre.settled()
        assert "the drawing" not in theatre.text(TimeChart)
    assert faults == [BROKEN]
    faults.clear()


async def test_an_accuracy_chart_that_cannot_be_built_says_so(faults, monkeypatch):
    async def nothing(*_):
        for none in ():
            yield none

    monkeypatch.setattr("tui.views.accuracy.view.computed", nothing)
    monkeypatch.setattr("tui.views.accuracy.pane.charted", broken)
    async with lab() as theatre:
        await theatre.press("f4")
        await theatre.run(1.0)
        await theatre.pilot.pause(0.1)
        assert "the drawing" in theatre.text(AccuracyPane)
        await goes_on(theatre)
    assert faults == [BROKEN]
    faults.clear()


@pytest.mark.parametrize(
    ("key", "view", "pane"), [("f4", "accuracy", AccuracyPane), ("f5", "stability", StabilityPane)]
)
async def test_a_computation_that_fails_says_so_at_its_pane(faults, monkeypatch, key, view, pane):
    async def computed(*_):
        raise BROKEN
        yield

    monkeypatch.setattr(f"tui.views.{view}.view.computed", computed)
    async with lab() as theatre:
        await theatre.press(key)
        await theatre.pilot.pause()
        assert str(theatre.stage.query_one(pane).border_subtitle) == sentence(BROKEN)
        await goes_on(theatre)
    assert faults == [BROKEN]
    faults.clear()


async def test_a_worker_that_fails_is_reported(faults):
    async def work() -> None:
        raise BROKEN

    async with lab() as theatre:
        theatre.stage.query_one(EventList).run_worker(work())
        await theatre.pilot.pause()
        await goes_on(theatre)
        assert any("the drawing" in notice for notice in notices(theatre))
    assert [fault.__cause__ or fault.error for fault in faults] == [BROKEN]
    faults.clear()


async def test_a_dialog_whose_handler_fails_stays_and_can_be_closed(faults, monkeypatch):
    async with lab() as theatre:
        monkeypatch.setattr("tui.screens.dialogs.start_form.scene_from", broken)
        await theatre.press("i", "1")
        form = theatre.app.screen
        assert isinstance(form, StartForm)
        assert notices(theatre) == [sentence(BROKEN)]
        await theatre.press("escape")
        await goes_on(theatre)
    assert faults == [BROKEN]
    faults.clear()


async def test_a_dialog_that_has_become_deaf_is_closed(faults, monkeypatch):
    async with lab() as theatre:
        await theatre.press("question_mark")
        assert isinstance(theatre.app.screen, TextScreen)
        theatre.app.screen.query_one(Static).call_later(broken)
        async with asyncio.timeout(20):
            while theatre.app.screen is not theatre.stage:
                await asyncio.sleep(0.01)  # the pilot would wait for the deaf one
        await goes_on(theatre)
    assert faults == [BROKEN]
    faults.clear()


async def test_a_dialog_that_cannot_be_composed_can_be_closed(faults, monkeypatch):
    monkeypatch.setattr(StartForm, "compose", broken)
    async with lab() as theatre:
        await theatre.press("i", "escape")
        assert theatre.app.screen is theatre.stage
        await goes_on(theatre)
    assert faults == [BROKEN]
    faults.clear()


async def test_a_key_that_fails_is_reported(faults, monkeypatch):
    monkeypatch.setattr(LiveScreen, "action_alone", broken)
    async with lab() as theatre:
        await theatre.press("X")
        await goes_on(theatre)
        assert notices(theatre) == [sentence(BROKEN)]
    assert faults == [BROKEN]
    faults.clear()


async def test_a_table_of_a_view_that_cannot_be_made_says_so(faults, monkeypatch):
    monkeypatch.setattr("tui.views.phase.view.fact_rows", broken)
    async with lab() as theatre:
        await theatre.press("f3")
        await goes_on(theatre)
        assert "the drawing" in theatre.text("#facts")
    assert faults == [BROKEN]
    faults.clear()


async def test_a_replay_goes_on_too(faults, monkeypatch):
    async with player(resolve("drift")) as theatre:
        monkeypatch.setattr(InsightLine, "paint", broken)
        monkeypatch.setattr(KeyLine, "on_click", broken)
        await theatre.pilot.click(KeyLine)
        await goes_on(theatre)
        assert "the drawing" in theatre.text(InsightLine)
    assert faults == [BROKEN]
    faults.clear()


async def test_what_fails_before_the_lab_is_on_stage_ends_the_program(monkeypatch):
    monkeypatch.setattr(LiveScreen, "compose", broken)
    monkeypatch.setattr("rich.traceback.Traceback", lambda **_: "")  # takes seconds to draw
    with pytest.raises(ZeroDivisionError):
        async with lab():
            pass


FAILING = """
from tui.words import insight
from tui.screens import insight_line
def broken(source, hidden):
    raise ZeroDivisionError("the insight")
insight_line.insight = broken
"""


def test_the_real_program_goes_on_too_and_its_log_has_the_traceback(tmp_path):
    program = [*PENDU[:2], FAILING + PENDU[2]]
    with PtyLab("live", program=program, PENDU_RECORDINGS=str(tmp_path)) as session:
        session.wait_for("the insight")
        session.wait_for("REC 1 s")
        session.type("q")
        assert session.end() == 0
    log = (tmp_path / LOG).read_text()
    assert log.count("Traceback") == 1
    assert 'raise ZeroDivisionError("the insight")' in log or "in broken" in log
    (recording,) = tmp_path.glob("*.mcap")
    assert verify(recording).identical
