"""The tour on the lab's screen, with a clock that is moved by hand."""

from dataclasses import replace

import pytest

from pendu_tui.engine.scenes import SCENES, Scene, Shot
from pendu_tui.tui.playback.lesson import Lesson, tour
from pendu_tui.tui.playback.live import Live
from pendu_tui.tui.playback.shown import Shown
from pendu_tui.tui.screens.lab import LabScreen
from pendu_tui.tui.screens.lines import InsightLine, LessonPanel
from pendu_tui.tui.views.lab import TimeChart
from tests.tui.harness import Theatre, lab, on_stage

STEPS = tour().pages


def words(text: str) -> str:
    return " ".join(text.split())


def panel(theatre: Theatre) -> str:
    return words(theatre.text(LessonPanel))


@pytest.mark.usefixtures("uncomputed")
async def test_it_is_walked_on_the_smallest_terminal_with_every_sentence_in_full():
    async with lab(SCENES["spin"], (60, 16)) as theatre:
        # a page shows its own picture, whatever was there
        await theatre.press("f3", "x", "f2", "T")
        for number, page in enumerate(STEPS):
            shot = page.shot
            assert (theatre.stage.view, theatre.scene) == (shot.view, page)
            assert theatre.stage.shown == Shown().through(page)
            title = f"Tour {number + 1} of {len(STEPS)}: {page.name}"
            assert panel(theatre).startswith(title)
            assert panel(theatre).endswith(words(page.watch))
            region = theatre.pane(LessonPanel).region
            assert (region.width, region.height, region.bottom) == (60, 6, 15)  # above the key line
            assert max(map(len, theatre.text(LessonPanel).splitlines())) <= 60
            assert not theatre.pane(InsightLine).is_on_screen
            assert shot.view != "lab" or theatre.pane(TimeChart).size.height >= 5
            assert ("enter end" in panel(theatre)) == (page is STEPS[-1])
            await theatre.press("enter")
            if page is STEPS[-1]:
                break
            assert panel(theatre).startswith(f"{title} 1 2 answer")
            asked = f"{shot.question} 1: {shot.answers[0]} 2: {shot.answers[1]}"
            assert panel(theatre).endswith(words(asked))
            choice = 1 + number % 2
            await theatre.press(str(choice))
            result = "Right." if choice == shot.right else "Not quite."
            assert panel(theatre).startswith(f"{title} enter continue")
            told = f"{result} {shot.right}: {shot.answers[shot.right - 1]} {shot.truth}"
            assert panel(theatre).endswith(words(told))
            await theatre.press("enter")
        assert not theatre.pane(LessonPanel).is_on_screen
        assert (theatre.stage.view, theatre.playhead.paused) == ("lab", False)
        await theatre.press("u")
        assert theatre.scene == SCENES["spin"]


async def test_leaving_it_restores_view_and_settings_and_u_the_run():
    async with lab(SCENES["spin"]) as theatre:
        await theatre.run(2)
        await theatre.press("enter", "backspace", "1", "greater_than_sign")
        assert theatre.scene == SCENES["spin"]  # its keys do nothing yet
        before = theatre.stage.shown
        t = theatre.sample.t
        await theatre.press("T", "u")  # which does not leave it
        assert theatre.pane(LessonPanel).size.height == 4
        await theatre.click(LessonPanel)  # goes on, as enter does
        assert words(STEPS[0].shot.question) in panel(theatre)
        await theatre.press("enter", "enter", "escape")
        assert theatre.pane(InsightLine).is_on_screen
        assert (theatre.stage.view, theatre.stage.shown) == ("lab", before)
        assert (theatre.playhead.speed, theatre.playhead.paused) == (2, False)
        await theatre.press("u")
        assert (theatre.scene, theatre.sample.t) == (SCENES["spin"], t)
        await theatre.press("p")
        names = [*SCENES]
        assert theatre.scene.name == names[names.index("spin") + 1]
        await theatre.press("T")
        assert words(STEPS[1].watch) in panel(theatre)


@pytest.mark.parametrize(("scene", "key"), [("euler-caught", "1"), ("resonance", "o")])
async def test_after_it_its_run_has_neither_the_line_nor_the_hidden_methods_of_another(scene, key):
    async with lab(SCENES[scene]) as theatre:
        await theatre.press(key)
        before = theatre.stage.shown
        await theatre.press("T", "escape")
        has_same_cast = theatre.scene.cast == SCENES[scene].cast
        hidden = before.hidden if has_same_cast else frozenset()
        assert theatre.stage.shown == before._replace(line=None, hidden=hidden)
        await theatre.press("u")
        assert theatre.stage.shown == before


def guided(lesson: Lesson, scene: Scene, size: tuple[int, int] = (120, 40)):
    """A lab as a command with a lesson begins it."""

    def make(clock):
        screen = LabScreen(Live(scene, clock=lambda: 0.0), clock)
        screen.guide = lesson
        return screen

    return on_stage(make, size)


async def test_the_command_begins_with_it_unless_its_options_alter_the_scene():
    async with guided(tour(), STEPS[0].altered(h=0.1)) as theatre:
        assert not theatre.stage.is_guided
    async with guided(tour(), STEPS[0]) as theatre:
        assert theatre.sample.run == 1
        while not theatre.playhead.paused:
            theatre.frames()
            assert theatre.now < 30
        assert words(STEPS[0].shot.question) in panel(theatre)


async def test_of_a_page_that_is_too_long_the_end_is_kept_and_a_page_has_its_own_shot():
    page = replace(STEPS[-1], name=70 * "n", watch=100 * "too " + "long.")
    known = replace(SCENES["drift"], shot=Shot(log=False))
    async with guided(Lesson("Page", [page, known]), page, (60, 16)) as theatre:
        assert panel(theatre).startswith("Page 1 of 2")
        assert panel(theatre).endswith("long.")
        assert theatre.text(LessonPanel).count("\n") == 5
        await theatre.press("P")
        texts = [each.text.partition(" ")[0] for each in theatre.app.screen.entries]
        assert texts.count("scene") == 2
        await theatre.press("down", "enter")
        assert not theatre.stage.shown.log
