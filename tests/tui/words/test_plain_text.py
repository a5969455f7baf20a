"""The lab in words, held against the lab; and the list of events, in order and with their times."""

import re

import pytest

from pendu_tui.engine.methods import RK4, VELOCITY_VERLET, Cast
from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES
from pendu_tui.recordings.files import GOLDEN
from pendu_tui.recordings.recording import Recording
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.replay import Replay
from pendu_tui.tui.playback.source import Source
from pendu_tui.tui.screens.app import PenduApp
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.views.lab import EventList
from pendu_tui.tui.words.insight import insight_text
from pendu_tui.tui.words.plain_text import (
    description,
    event_lines,
    method_sentence,
    numbered,
    tell,
)
from tests.tui.harness import after, lab

DRIFT = SCENES["drift"]


class Hour:
    """A clock that goes on by sleeping."""

    now = 100.0

    def read(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def said(source: Source, seconds: float, only: Cast | None = None) -> list[str]:
    """The sentences on so many seconds of the clock, after the description."""
    clock, sentences = Hour(), []
    end = clock.now + seconds
    first = description(source, only)
    tell(source, sentences.append, lambda: clock.now >= end, clock.read, clock.sleep, only=only)
    assert sentences[: len(first)] == first
    return sentences[len(first) :]


def test_the_default_scene_after_twenty_seconds():
    live = after(DRIFT, 20)
    text = " ".join(description(live))
    for part in ('20.00 s of run 1 of the scene "drift"', "57.3° 0 rad/s", "z = 0.157"):
        assert part in text
    for index, number in enumerate(("7.15 s", "0.079", "0.0057", "32 min")):
        assert number in method_sentence(live, index)
    error = after(DRIFT, 3).sample.readings[3].energy_error
    assert f"{error:+.2g}; undecided: 1 of 4 swings" in method_sentence(after(DRIFT, 3), 3)


def test_every_scene_has_an_insight_sentences_and_events_that_fit_the_smallest_pane():
    for scene in SCENES.values():
        live = Live(scene, clock=lambda: 0.0)
        for _ in range(3):
            for index, method in enumerate(scene.cast):
                sentence = method_sentence(live, index)
                assert re.fullmatch(r"[A-Zr].*\.", sentence)
                assert method.label.split()[-1] in sentence
            live.step(200)
            assert 10 < len(insight_text(live)) <= 110
        assert all(len(str(line)) <= 46 for line in event_lines(live))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda live: live.pause(True), "is paused"),
        (lambda live: live.set_speed(0.5), "0.5 times real time"),
        (lambda live: live.change(Stepping(-0.05)), "time runs backwards"),
        (lambda live: live.change(Stepping(0.2, equal_cost=True)), "at equal cost"),
        (lambda live: live.start(SCENES["spin"]), "one turn takes 0.98 s"),
        (lambda live: setattr(live, "failure", "mine fails."), "mine fails."),
    ],
)
def test_the_description_follows_changes(change, words):
    live = after(DRIFT, 1)
    assert words not in " ".join(description(live))
    change(live)
    assert words in " ".join(description(live))


async def test_d_opens_the_description_and_closes_it():
    async with lab() as theatre:
        await theatre.run(20)
        await theatre.press("d")
        text = theatre.app.screen.text
        assert "\n".join(description(theatre.source)[1:]) in text
        assert "dE/E0" in text.splitlines()[-1]
        await theatre.press("d")
        assert theatre.app.screen is theatre.stage


def test_every_event_has_a_sentence():
    sentences = said(Live(DRIFT, clock=lambda: 0.0), 20.5)
    times = [text.partition(" s: ")[0] for text in sentences]
    assert times == ["7.15", "8.75", "8.75", "17.25", "17.25"]
    assert "Explicit Euler over the top" in sentences[0]


def test_at_another_speed_the_same_events_come_earlier():
    assert said(Live(DRIFT, 4.0, clock=lambda: 0.0), 20.5 / 4) == said(
        Live(DRIFT, clock=lambda: 0.0), 20.5
    )


def test_of_some_methods_nothing_is_said_of_the_others():
    sentences = "\n".join(said(Live(DRIFT, clock=lambda: 0.0), 20.5, (RK4, VELOCITY_VERLET)))
    assert "RK4: - loses" in sentences
    assert "Verlet: = bounded" in sentences
    assert "Euler" not in sentences


def test_a_replay_ends_at_its_end():
    with Recording.open(GOLDEN / "drift.mcap") as recording:
        replay = Replay(recording)
        assert description(replay)[0].startswith("The replay runs in real time")
        assert len(said(replay, 1000)) < recording.length + 30
        assert replay.playhead.position == recording.length


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
