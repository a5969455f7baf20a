"""The tour on the lab's screen, with a clock that is moved by hand."""

import pytest

from pendu_tui.engine.scenes import SCENES
from pendu_tui.tui.playback.lesson import tour
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.screens.lines import InsightLine, LessonPanel
from pendu_tui.tui.views.lab import TimeChart
from tests.tui.harness import FPS, Theatre, lab, on_stage

STEPS = tour().pages


@pytest.fixture(autouse=True)
def _few_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the stability map: they take no time."""
    monkeypatch.setattr("pendu_tui.tui.views.stability.PASSES", (20, 300))


def words(text: str) -> str:
    return " ".join(text.split())


def panel(theatre: Theatre) -> str:
    return words(theatre.text(LessonPanel))


async def test_it_is_walked_on_the_smallest_terminal_with_every_sentence_in_full():
    async with lab(SCENES["spin"], (60, 16)) as theatre:
        await theatre.press("T")
        for number, shot in enumerate(STEPS):
            await theatre.pilot.pause()
            assert (theatre.stage.view, theatre.source.scene) == (shot.shot.view, shot)
            assert theatre.stage.shown == Shown().through(shot)
            assert words(shot.watch) in panel(theatre)
            assert f"Tour {number + 1} of {len(STEPS)}: " in panel(theatre)
            region = theatre.stage.query_one(LessonPanel).region
            assert (region.width, region.bottom) == (60, 15)  # the key line is below
            assert not theatre.stage.query_one(InsightLine).is_on_screen
            assert shot.shot.view != "lab" or theatre.stage.query_one(TimeChart).size.height >= 5
            await theatre.press("enter")
            if shot is STEPS[-1]:
                break
            assert words(shot.shot.question) in panel(theatre)
            assert words(f"1: {shot.shot.answers[0]} 2: {shot.shot.answers[1]}") in panel(theatre)
            await theatre.press(str(1 + number % 2))
            right = shot.shot.right
            result = "Right." if right == 1 + number % 2 else "Not quite."
            assert f"{result} {right}: {shot.shot.answers[right - 1]}" in panel(theatre)
            assert words(shot.shot.truth) in panel(theatre)
            await theatre.press("enter")
        await theatre.pilot.pause()
        assert not theatre.stage.query_one(LessonPanel).is_on_screen
        assert (theatre.stage.view, theatre.source.playhead.paused) == ("lab", False)
        assert "h is" not in theatre.text(InsightLine)  # the last page has no new step
        await theatre.press("u")
        assert theatre.source.scene == SCENES["spin"]


async def test_leaving_it_restores_view_and_settings_and_u_the_run():
    async with lab(SCENES["spin"]) as theatre:
        await theatre.run(2)
        await theatre.press("1", "greater_than_sign")
        before = theatre.stage.shown
        t = theatre.source.sample.t
        await theatre.press("T", "enter", "enter", "enter", "enter")
        assert theatre.stage.view == "phase"
        await theatre.press("escape")
        await theatre.pilot.pause()
        assert theatre.stage.query_one(InsightLine).is_on_screen
        assert (theatre.stage.view, theatre.stage.shown) == ("lab", before)
        assert (theatre.source.playhead.speed, theatre.source.playhead.paused) == (2, False)
        await theatre.press("u")
        assert (theatre.source.scene, theatre.source.sample.t) == (SCENES["spin"], t)
        await theatre.press("T")
        await theatre.pilot.pause()
        assert words(STEPS[1].watch) in panel(theatre)


async def test_while_a_shot_runs_the_other_keys_keep_their_meaning():
    async with lab() as theatre:
        await theatre.press("T", "space", "1", "2", "4")
        assert theatre.source.playhead.paused
        assert theatre.stage.shown.hidden == {"rk4"}
        await theatre.press("4", "space", "f3", "question_mark", "escape")
        await theatre.pilot.pause()
        assert not theatre.source.playhead.paused
        assert theatre.stage.view == "phase"
        assert theatre.stage.query_one(LessonPanel).is_on_screen


async def test_a_click_on_the_panel_goes_on_and_outside_a_tour_its_keys_do_nothing():
    async with lab() as theatre:
        await theatre.press("enter", "backspace", "escape")
        assert not theatre.stage.query_one(LessonPanel).is_on_screen
        await theatre.press("T")
        await theatre.pilot.click(LessonPanel)
        await theatre.pilot.pause()
        assert words(STEPS[0].shot.question) in panel(theatre)


async def test_the_command_begins_with_it():
    def make(clock):
        lesson = tour()
        screen = LabScreen(Live(lesson.page, clock=lambda: 0.0), clock)
        screen.guide = lesson
        return screen

    async with on_stage(make, (120, 40)) as theatre:
        await theatre.pilot.pause()
        assert theatre.source.sample.run == 1
        while not theatre.source.playhead.paused:
            theatre.now += 1 / FPS
            theatre.stage.frame()
            assert theatre.now < 30
        theatre.stage.show_now()
        assert words(STEPS[0].shot.question) in panel(theatre)
