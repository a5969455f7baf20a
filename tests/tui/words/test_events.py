"""The list of events: inputs and milestones, in order and with their times."""

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.views.lab import EventList
from pendu_tui.tui.words.plain_text import event_lines, numbered
from tests.tui.harness import after

DRIFT = SCENES["drift"]


def texts(source: Source) -> list[str]:
    return [line.text for line in event_lines(source)]


def test_the_events_of_the_first_twenty_seconds():
    lines = event_lines(after(DRIFT, 20))
    assert str(lines[1]) == " 7.15 s Explicit Euler over the top, 5.1 E0"
    assert [str(line)[8:] for line in lines[2:4]] == ["Explicit Euler: + grows", "RK4: - loses"]
    assert [line.t for line in lines] == pytest.approx([0.0, 7.15, 8.75, 8.75, 17.25, 17.25])
    assert "".join(line.method.letter if line.method else "-" for line in lines) == "-eersv"


def test_events_of_hidden_methods_are_not_listed():
    live = after(SCENES["crossover"], 36)
    assert "33.40 s RK4's error > Verlet's" in map(str, event_lines(live))
    shown = "".join(map(str, event_lines(live, {"velocity_verlet"})))
    assert "RK4: - loses" in shown
    assert "Verlet" not in shown


def test_changes_and_marks_are_listed_and_pauses_are_not():
    live = after(DRIFT, 1)
    live.mark()
    live.pause(True)
    live.pause(False)
    live.set_speed(2)
    live.change(Stepping(0.1))
    live.step(1)
    live.mark("question 2")
    live.change(Stepping(-0.1))
    live.change(Stepping(0.4, equal_cost=True))
    live.start(DRIFT.altered(theta=2.0))
    assert numbered(event_lines(live)) == [
        " 1  0.00 s start drift, h 0.05 s",
        " 1  1.00 s mark 1",
        " 1  1.00 s h 0.1 s",
        " 1  1.10 s mark 2: question 2",
        " 1  1.10 s time runs back, h 0.1 s",
        " 1  1.10 s h 0.4 s, equal cost",
        " 2  0.00 s start 114.6° 0 rad/s, h 0.05 s",
        " 2  0.00 s h 0.2 s, equal cost",
    ]


def test_a_step_back_removes_what_comes_later():
    live = after(DRIFT, 9)
    live.step(-20)
    assert texts(live)[-1] == "Explicit Euler over the top, 5.1 E0"
    live.step(-20)
    assert texts(live) == ["start drift, h 0.05 s"]
    live.change(Stepping(0.1))
    assert len(texts(live)) == 3  # of two runs
    live.step(-1)
    assert len(texts(live)) == 2


async def test_the_pane_shows_the_newest_last_and_only_where_there_is_room():
    live = after(DRIFT, 20)
    app = PenduApp(LabScreen(live, clock=lambda: 20.0))
    async with app.run_test(size=(120, 40)) as pilot:
        await pilot.pause()
        pane = app.lab.query_one(EventList)
        app.lab.show_now()
        shown = pane.text.splitlines()
        assert shown == [str(line) for line in event_lines(live)][-pane.size.height :]
        assert pane.size.height >= 4
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert not pane.is_on_screen
