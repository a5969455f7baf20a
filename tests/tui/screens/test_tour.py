"""The tour on the lab's screen, at three sizes, with a clock that is moved by hand."""

import pytest

from engine.run.stepping import Stepping
from engine.scenes import SCENES
from tests.tui.harness import FPS, Theatre, lab, on_stage
from tui.playback.live import Live
from tui.screens.insight_line import InsightLine
from tui.screens.key_line import KeyLine
from tui.screens.live import LiveScreen
from tui.screens.still import normalised
from tui.screens.tour.panel import TourPanel
from tui.views.lab.error_table import ErrorTable
from tui.words.tour.steps import STEPS

SIZES = [(80, 24), (120, 40), (200, 60)]


@pytest.fixture(autouse=True)
def _few_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the stability map: they take no time."""
    monkeypatch.setattr("tui.views.stability.view.PASSES", (20, 300))


def words(text: str) -> str:
    return " ".join(text.split())


async def to_the_moment(theatre: Theatre) -> float:
    """Run until the lab is paused: the seconds that it took."""
    began = theatre.now
    while not theatre.source.playhead.paused:
        theatre.now += 1 / FPS
        theatre.stage.frame()
        assert theatre.now - began < 30
    await theatre.pilot.pause()
    return theatre.now - began


@pytest.mark.parametrize("size", SIZES, ids="{0[0]}x{0[1]}".format)
async def test_it_is_walked_from_the_first_step_to_the_last(size):
    async with lab(SCENES["spin"], size) as theatre:
        await theatre.press("T")
        for number, step in enumerate(STEPS, 1):
            await theatre.pilot.pause()
            assert theatre.stage.view == step.view
            assert theatre.source.scene == step.scene
            assert words(theatre.text(TourPanel)) == words(
                f"Tour {number} of 8: {step.title} enter skip backspace back esc leave {step.watch}"
            )
            assert 7 < await to_the_moment(theatre) < 13
            assert words(f"esc leave {step.sentence} {step.question}") in words(theatre.text(TourPanel))
            await theatre.press("enter" if number % 2 else "space")
            assert words(f"esc leave {step.question} {step.answer}") in words(theatre.text(TourPanel))
            await theatre.press("space" if number % 2 else "enter")
        await theatre.pilot.pause()
        assert not theatre.stage.query_one(TourPanel).is_on_screen
        assert (theatre.stage.view, theatre.source.scene) == ("lab", SCENES["spin"])
        assert not theatre.source.playhead.paused
        (told,) = theatre.app._notifications
        assert told.message.startswith("That was the tour.")


@pytest.mark.parametrize("size", [(60, 16), *SIZES], ids="{0[0]}x{0[1]}".format)
async def test_the_panel_takes_the_place_of_the_insight_line_and_covers_nothing(size):
    async with lab(size=size) as theatre:
        await theatre.press("T")
        await theatre.run(1)
        panel, keys = theatre.stage.query_one(TourPanel).region, theatre.stage.query_one(KeyLine).region
        assert 3 <= panel.height <= 5
        assert (panel.width, panel.bottom) == (size[0], keys.y)
        assert not theatre.stage.query_one(InsightLine).is_on_screen
        for widget in theatre.stage.query("#views CellWidget"):
            if widget.is_on_screen:
                assert widget.region.bottom <= panel.y
        assert len(theatre.text(ErrorTable).splitlines()) == 5


async def test_where_nothing_fits_there_is_the_message_alone_before_and_after_it():
    async with lab(size=(50, 12)) as theatre:
        await theatre.press("T")
        for widget in (TourPanel, InsightLine):
            assert not theatre.stage.query_one(widget).is_on_screen
        await theatre.press("escape")
        await theatre.pilot.pause()
        for widget in (TourPanel, InsightLine):
            assert not theatre.stage.query_one(widget).is_on_screen


async def test_on_the_smallest_terminal_the_last_sentence_is_there_in_full():
    async with lab(size=(60, 16)) as theatre:
        await theatre.press("T")
        for step in STEPS:
            await theatre.press("enter")
            assert words(step.question) in words(theatre.text(TourPanel))
            await theatre.press("enter")
            assert words(step.answer) in words(theatre.text(TourPanel))
            await theatre.press("enter")


async def test_leaving_it_restores_view_and_settings_and_it_resumes_at_the_same_step():
    async with lab(SCENES["spin"]) as theatre:
        await theatre.run(2)
        await theatre.press("1", "greater_than_sign")
        before = theatre.stage.shown
        await theatre.press("T", "enter", "enter", "enter", "enter")
        assert theatre.stage.view == "phase"
        assert not theatre.stage.shown.hidden
        await theatre.press("escape")
        await theatre.pilot.pause()
        assert not theatre.stage.query_one(TourPanel).is_on_screen
        assert theatre.stage.query_one(InsightLine).is_on_screen
        assert (theatre.stage.view, theatre.stage.shown) == ("lab", before)
        assert (theatre.source.playhead.speed, theatre.source.playhead.paused) == (2, False)
        await theatre.press("T")
        await theatre.pilot.pause()
        assert words(f"{STEPS[1].sentence} {STEPS[1].question}") in words(theatre.text(TourPanel))
        assert theatre.source.playhead.paused
        assert theatre.stage.view == "phase"


async def test_after_a_run_of_ones_own_the_step_begins_again():
    async with lab() as theatre:
        await theatre.press("T", "enter", "T", "p", "T")
        await theatre.pilot.pause()
        assert theatre.source.scene == STEPS[0].scene
        assert words(STEPS[0].watch) in words(theatre.text(TourPanel))


async def test_u_brings_back_the_run_from_before_the_tour():
    async with lab(SCENES["spin"]) as theatre:
        await theatre.run(3)
        t = theatre.source.sample.t
        await theatre.press("T", *["enter"] * 10, "escape")
        assert theatre.source.scene == STEPS[3].scene
        await theatre.press("u")
        assert (theatre.source.scene, theatre.source.sample.t) == (SCENES["spin"], t)
        assert theatre.source.stepping == Stepping(SCENES["spin"].h)


async def test_while_a_step_runs_space_pauses_and_the_views_keep_their_other_keys():
    async with lab() as theatre:
        await theatre.press("T", "space")
        assert theatre.source.playhead.paused
        assert words(STEPS[0].watch) in words(theatre.text(TourPanel))
        await theatre.press("space", "f3")
        await theatre.pilot.pause()
        assert not theatre.source.playhead.paused
        assert theatre.stage.view == "phase"
        await theatre.press("question_mark", "escape")
        assert theatre.stage.query_one(TourPanel).is_on_screen


async def test_a_change_of_the_run_is_noticed():
    async with lab() as theatre:
        await theatre.press("T", "plus")
        theatre.stage.frame()
        assert "This is your own run now" in theatre.text(TourPanel)
        await theatre.press("enter")
        assert words(STEPS[0].watch) in words(theatre.text(TourPanel))


async def test_a_click_on_the_panel_goes_on_and_outside_a_tour_its_keys_do_nothing():
    async with lab() as theatre:
        await theatre.press("enter", "backspace", "escape")
        assert not theatre.stage.query(TourPanel)
        await theatre.press("T")
        await theatre.pilot.click(TourPanel)
        await theatre.pilot.pause()
        assert words(STEPS[0].sentence) in words(theatre.text(TourPanel))


async def test_the_command_begins_with_it():
    def make(clock):
        screen = LiveScreen(Live(SCENES["drift"], clock=lambda: 0.0), clock)
        screen.begins_with_tour = True
        return screen

    async with on_stage(make, (80, 24)) as theatre:
        await theatre.pilot.pause()
        assert "Tour 1 of 8" in theatre.text(TourPanel)
        assert theatre.source.sample.run == 1


async def test_as_it_looks(text_snapshot):
    async with lab() as theatre:
        await theatre.press("T")
        await to_the_moment(theatre)
        theatre.stage.show_now()
        await theatre.settled()
        await theatre.pilot.pause()
        text_snapshot("tour-120x40", normalised(theatre.app.export_screenshot()))
