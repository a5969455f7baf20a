"""A lesson leads a lab from page to page: to the moment, the question, and the answer."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from pendu_tui.engine.run.stepping import Stepping
from pendu_tui.engine.scenes import SCENES, Shot
from pendu_tui.tui.cli.scene import read_scenes
from pendu_tui.tui.playback.lesson import Lesson, LessonState
from pendu_tui.tui.playback.live import Live
from tests.tui.harness import FPS, Clocked

DOCUMENTATION = Path(__file__).parents[3] / ".github/docs/lab.md"
QUESTION = Shot(
    moment=1.0,
    sentence="A second has passed.",
    question="Which one is exact?",
    answers=("Neither.", "RK4.", "All."),
    truth="Each has an error.",
)
ASKS = replace(SCENES["drift"], name="asks", shot=QUESTION, speed=2.0)
TELLS = replace(SCENES["crossover"], name="tells", shot=Shot(moment=0.4, sentence="Here."))
SHOWS = replace(
    SCENES["spin"], name="shows", watch="It spins.", shot=Shot(equal_cost=True, under=0.1)
)


@pytest.fixture
def live() -> Live:
    return Live(SCENES["drift"], clock=lambda: 0.0)


@pytest.fixture
def lesson(live) -> Lesson:
    lesson = Lesson("Page", [ASKS, TELLS, SHOWS])
    lesson.begin(live, lesson.index)
    return lesson


def test_a_page_begins_with_its_scene_speed_and_cost_whatever_the_lab_did_before(lesson, live):
    live.change(live.stepping.toggled())
    lesson.begin(live, 1)
    assert (live.scene, live.playhead.speed, live.stepping) == (TELLS, 4.0, Stepping(0.2))
    assert len(live.changes) == 1  # that at the start
    lesson.begin(live, 2)
    assert live.stepping.equal_cost
    assert (live.stepping.smallest, live.ghost) == (SHOWS.h, None)
    assert not lesson.follow(live, live.sample)  # it has no moment
    run = live.sample.run
    lesson.begin(live, 2)
    assert live.sample.run == run


def test_forward_goes_to_the_moment_the_truth_and_the_next_page_and_ends_after_the_last(
    lesson, live
):
    stages = []
    while lesson.forward(live):
        stages.append((lesson.title, lesson.stage, round(live.sample.t, 6), lesson.text))
    asked = (QUESTION.sentence, "Which one is exact?  1: Neither.  2: RK4.  3: All.")
    assert stages == [
        ("Page 1 of 3: asks", "asked", 1.0, asked),
        ("Page 1 of 3: asks", "answered", 1.0, ("1: Neither.", QUESTION.truth)),
        ("Page 2 of 3: tells", "watching", 0.0, (TELLS.watch,)),
        ("Page 2 of 3: tells", "told", 0.4, ("Here.",)),
        ("Page 3 of 3: shows", "watching", 0.0, ("It spins.",)),
    ]
    assert lesson.index == 0
    assert [lesson.index_of(name) for name in ("tells", "drift")] == [1, -1]


def test_the_lab_pauses_at_the_moment_and_again_after_the_user_went_back(lesson, live):
    lesson.begin(live, 1)
    clocked = Clocked(live)
    times = []
    for _ in range(30):
        before = live.sample
        clocked.run(1 / FPS)
        if lesson.follow(live, before):
            times.append(live.sample.t)
            live.step(-2)
            live.pause(False)
    assert times == pytest.approx([0.4] * len(times))
    assert len(times) > 1


def test_a_question_stays_asked_when_the_user_goes_back_before_its_moment(lesson, live):
    lesson.begin(live, 0)
    lesson.forward(live)
    assert lesson.stage == "asked"
    before = live.sample
    live.step(-2)
    assert not lesson.follow(live, before)
    live.change(live.stepping.reversed())
    assert not lesson.is_astray(live)  # it has told what it tells
    assert lesson.state == LessonState(0, "asked")
    lesson.begin(live, 1)
    lesson.forward(live)
    lesson.follow(live, live.sample)
    assert lesson.stage == "told"


def test_where_time_returns_the_pause_comes_at_the_start(live):
    lesson = Lesson("Page", [replace(ASKS, shot=replace(QUESTION, returns=True))])
    lesson.begin(live, 0)
    clocked = Clocked(live)
    latest = 0.0
    before = live.sample
    while not lesson.follow(live, before):
        before = live.sample
        latest = max(latest, clocked.run(1 / FPS).t)
        assert clocked.now < 9
    assert latest == pytest.approx(1.0, abs=0.1)
    assert (live.sample.t, live.sample.step) == (pytest.approx(0.0, abs=1e-12), 40)
    end = live.sample
    lesson.begin(live, 0)
    lesson.forward(live)
    assert live.sample == end._replace(run=3)
    lesson.begin(live, 0)
    live.step(20)
    live.change(live.stepping.reversed())
    assert not lesson.is_astray(live)  # it turned where the page does
    live.step(5)
    assert lesson.forward(live)
    assert live.sample == end._replace(run=4)
    state = LessonState(0, "answered", 2)
    lesson.state = state
    assert lesson.state == state


def test_an_answer_is_judged_and_back_goes_to_the_question_and_from_there_to_the_page_before(
    lesson, live
):
    lesson.begin(live, 1)
    lesson.back(live)
    lesson.forward(live)
    for choice, result in ((1, "Right. "), (2, "Not quite. "), (None, "")):
        lesson.answer(choice)
        assert lesson.text == (f"{result}1: Neither.", QUESTION.truth)
        lesson.back(live)
        assert (lesson.index, lesson.stage) == (0, "asked")
    lesson.back(live)
    assert (lesson.index, lesson.stage, live.sample.step) == (0, "watching", 0)
    assert not live.playhead.paused


def test_after_a_change_of_the_run_it_waits_until_the_user_begins_the_page_again(lesson, live):
    live.start(ASKS.altered(omega=0.1))
    assert lesson.is_astray(live)
    before = live.sample
    Clocked(live).run(2.0)
    assert not lesson.follow(live, before)
    lesson.forward(live)
    assert (lesson.stage, live.scene) == ("watching", ASKS)
    live.step(3)
    live.change(live.stepping.reversed())
    assert lesson.is_astray(live)
    lesson.begin(live, 0)
    live.change(live.stepping.reversed())
    assert lesson.is_astray(live)


def test_the_lesson_in_the_documentation_is_walked_as_it_stands(tmp_path, live):
    (text,) = re.findall("```toml\n(.*?)```", DOCUMENTATION.read_text(encoding="utf-8"), re.DOTALL)
    file = tmp_path / "lesson.toml"
    file.write_text(text, encoding="utf-8")
    lesson = Lesson("Page", read_scenes(file).values())
    lesson.begin(live, 0)
    stages = []
    while lesson.forward(live):
        stages.append(lesson.stage)
    assert stages == ["asked", "answered", "watching", "told"]
    verlet, rk4 = (abs(reading.energy_error) for reading in live.sample.readings[2:])
    assert rk4 > verlet
