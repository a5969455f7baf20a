"""The list of events: inputs and milestones, in order and with their times."""

import pytest

from engine.methods import USUAL_CAST
from engine.run.judgement import Milestone
from engine.run.stepping import Stepping
from engine.scenes import SCENES
from recordings.recording import Recording
from tests.tui.harness import after, recorded
from tui.playback.live import Live
from tui.playback.replay import Replay
from tui.screens.app import PenduApp
from tui.screens.live import LiveScreen
from tui.views.lab.event_list import EventList
from tui.words.events import event_lines, milestone_text, numbered
from tui.words.insight import insight

DRIFT = SCENES["drift"]


def texts(live: Live) -> list[str]:
    return [line.text for line in event_lines(live)]


def test_the_events_of_the_first_twenty_seconds():
    lines = event_lines(after(DRIFT, 20))
    assert [str(line) for line in lines] == [
        "   0.00 start drift, h 0.05 s",
        "   7.15 Explicit Euler over the top, 5.1 E0",
        "   9.00 Explicit Euler gains energy",
        "   9.00 RK4 loses energy",
        "  18.00 Symplectic Euler stays bounded",
        "  18.00 Verlet stays bounded",
    ]
    assert "".join(line.method.letter if line.method else "-" for line in lines) == "-eersv"


def test_changes_and_marks_are_listed_and_pauses_are_not():
    live = after(DRIFT, 1)
    live.mark()
    live.pause(True)
    live.pause(False)
    live.set_speed(2)
    live.set_stepping(Stepping(0.1))
    live.step(1)
    live.mark("question 2")
    live.set_stepping(Stepping(-0.1))
    live.set_stepping(Stepping(0.4, equal_cost=True))
    live.start(DRIFT.altered(theta=2.0))
    assert texts(live) == [
        "start drift, h 0.05 s",
        "mark 1",
        "h 0.1 s",
        "mark 2: question 2",
        "time reversed, h 0.1 s",
        "time forwards again, h 0.4 s, equal cost",
        "start 114.6° 0 rad/s, h 0.05 s",
        "h 0.2 s, equal cost",
    ]
    assert [line.run for line in event_lines(live)] == [1] * 6 + [2] * 2


def test_where_there_are_several_runs_each_event_has_the_number_of_its_own():
    live = after(DRIFT, 1)
    assert numbered(event_lines(live)) == ["   0.00 start drift, h 0.05 s"]
    live.start(SCENES["spin"])
    assert numbered(event_lines(live)) == [
        " 1    0.00 start drift, h 0.05 s",
        " 2    0.00 start spin, h 0.02 s",
    ]


def test_an_energy_close_to_that_of_the_start_is_given_as_the_difference():
    milestone = Milestone("over the top", USUAL_CAST[3], 10, 0.5, 0.0034)
    assert milestone_text(milestone) == "RK4 over the top, +0.34 %"


def test_an_error_that_passes_anothers_is_listed_and_is_the_news_of_the_moment():
    live = after(SCENES["crossover"], 36)
    assert "  33.40 RK4's error passes Verlet's" in map(str, event_lines(live))
    found = insight(live)
    assert (found.kind, found.values) == ("errors cross", {"t": 33.4})


def test_marks_next_to_a_recording_have_the_time_of_their_step(tmp_path):
    larger, backwards = (lambda live, h=h: live.set_stepping(Stepping(h)) for h in (0.1, -0.02))
    path = recorded(tmp_path / "run.mcap", 2.0, larger, 2.0, backwards, 1.0)
    with Recording.open(path) as recording:
        replay = Replay(recording, clock=lambda: 0.0)
        times = []
        for position in (1.0, 3.0, 4.5):
            replay.seek(position)
            replay.mark(f"at {position}")
            times.append(replay.sample.t)
        marks = [line for line in event_lines(replay) if line.text.startswith("mark")]
        assert [line.text for line in marks] == [
            "mark 1: at 1.0",
            "mark 2: at 3.0",
            "mark 3: at 4.5",
        ]
        assert [line.t for line in marks] == pytest.approx(times)
        replay.seek(3.5)
        assert "mark 3: at 4.5" not in [line.text for line in event_lines(replay)]


def test_a_step_back_removes_what_comes_later():
    live = after(DRIFT, 9)
    live.step(-20)
    assert texts(live)[-1] == "Explicit Euler over the top, 5.1 E0"
    live.step(-20)
    assert texts(live) == ["start drift, h 0.05 s"]
    changed = after(DRIFT, 3)
    changed.set_stepping(Stepping(0.1))
    changed.step(10)
    assert texts(changed) == ["start drift, h 0.05 s", "h 0.1 s"]
    changed.step(-30)
    assert texts(changed) == ["start drift, h 0.05 s"]


async def test_the_pane_shows_the_newest_last_and_only_where_there_is_room():
    live = after(DRIFT, 20)
    app = PenduApp(LiveScreen(live, clock=lambda: 20.0))
    async with app.run_test(size=(120, 40)) as pilot:
        await pilot.pause()
        pane = app.source_screen.query_one(EventList)
        app.source_screen.show_now()
        assert (
            pane.text.splitlines() == [str(line) for line in event_lines(live)][-pane.size.height :]
        )
        assert pane.size.height >= 4
        await pilot.pause()
        app.source_screen.show_now()
        assert (
            pane.text.splitlines() == [str(line) for line in event_lines(live)][-pane.size.height :]
        )
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert not pane.is_on_screen
