"""Every key of the lab does what the help says, and is in the help."""

import math

import pytest

from engine.methods import USUAL_CAST
from engine.scenes import DEFAULT_SCENE, SCENES
from recordings.live_recorder import LiveRecorder
from recordings.verify import verify
from tests.tui.harness import lab, on_stage
from tui.playback.live import Live
from tui.playback.shown import WINDOWS, quantities
from tui.screens.dialogs.start_form import StartForm
from tui.screens.dialogs.text import TextScreen, help_text
from tui.screens.extras import go_to
from tui.screens.keys import COMMON, LIVE, REPLAY
from tui.screens.live import LiveScreen
from tui.screens.status_line import StatusLine
from tui.views.lab.error_table import ErrorTable
from tui.views.lab.event_list import EventList
from tui.views.lab.time_chart import TimeChart
from tui.views.lab.view import LabView


async def test_time_space_pauses_and_goes_on_full_stop_and_comma_step():
    async with lab() as theatre:
        await theatre.run(1)
        step = theatre.source.sample.step
        await theatre.press("space")
        await theatre.run(1)
        assert theatre.source.sample.step == step
        assert "paused" in theatre.text(StatusLine)
        await theatre.press("full_stop", "full_stop", "comma")
        assert theatre.source.sample.step == step + 1
        await theatre.press("comma", "comma", "comma")
        assert theatre.source.sample.step == step - 2
        await theatre.press("space")
        await theatre.run(1)
        assert theatre.source.sample.step == step - 2 + 20
        assert "running" in theatre.text(StatusLine)


async def test_speed_less_and_greater_halve_and_double_and_0_is_real_time():
    async with lab() as theatre:
        await theatre.press("greater_than_sign", "greater_than_sign")
        assert theatre.source.playhead.speed == 4
        assert " 4× " in theatre.text(StatusLine)
        await theatre.run(1)
        assert theatre.source.sample.t == pytest.approx(4, abs=0.05)
        await theatre.press("0")
        assert theatre.source.playhead.speed == 1
        await theatre.press("less_than_sign")
        assert " 1/2× " in theatre.text(StatusLine)


async def test_the_run_r_restarts_plus_and_minus_change_h_b_reverses_p_and_capital_p_change_the_scene():
    async with lab() as theatre:
        await theatre.run(2)
        await theatre.press("plus")
        assert theatre.source.stepping.h == 0.1
        await theatre.press("minus", "minus")
        assert theatre.source.stepping.h == 0.02
        await theatre.press("b")
        assert theatre.source.stepping.h == -0.02
        await theatre.run(1)
        assert theatre.source.sample.t == pytest.approx(1, abs=0.05)
        await theatre.press("r")
        assert (theatre.source.stepping.h, theatre.source.sample.step, theatre.source.scene.theta) == (0.02, 0, 1.0)
        names = list(SCENES)
        await theatre.press("p")
        assert theatre.source.scene == SCENES[names[0]]  # 0.02 made it a scene of its own
        await theatre.press("p")
        assert theatre.source.scene == SCENES[names[1]]
        await theatre.press("P", "end", "enter")
        assert theatre.source.scene == SCENES[names[-1]]
        await theatre.press("P", "escape", "p")
        assert theatre.source.scene == SCENES[names[0]]
        await theatre.press("P", "up", "enter")  # from the first to the last
        assert names[-1] in theatre.text(StatusLine)


async def test_time_that_runs_backwards_pauses_at_0_and_keeps_what_each_method_misses_its_start_by():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press("b")
        for _ in range(40):
            theatre.now += 1 / 30
            theatre.stage.frame()
        assert theatre.source.sample.t == pytest.approx(0, abs=1e-9)
        assert theatre.source.playhead.paused
        (mark,) = [event for event in theatre.source.events if event.kind == "mark"]
        assert mark.text.startswith("Back at t = 0. Missed the start by e ")
        await theatre.press("space")
        theatre.now += 0.5
        theatre.stage.frame()
        assert theatre.source.sample.t < -0.3


async def test_settings_are_undone_one_after_the_other():
    async with lab() as theatre:
        await theatre.run(1)
        before = (theatre.source.stepping.h, theatre.source.playhead.speed, theatre.source.scene, theatre.stage.shown)
        await theatre.press("plus", "greater_than_sign", "p", "t", "y")
        await theatre.press("u", "u", "u", "u", "u")
        after = (theatre.source.stepping.h, theatre.source.playhead.speed, theatre.source.scene, theatre.stage.shown)
        assert after == before
        await theatre.press("u")  # there is nothing left to undo


async def test_a_run_that_another_start_replaced_is_brought_back_where_it_was_and_verifies(tmp_path):
    path = tmp_path / "run.mcap"

    def make(clock):
        live = Live(SCENES["drift"], clock=lambda: 0.0)
        live.record(LiveRecorder(path))
        return LiveScreen(live, clock)

    async with on_stage(make, (120, 40)) as theatre:
        await theatre.run(2)
        await theatre.press("plus")
        await theatre.run(2)
        before, milestones = theatre.source.sample, theatre.source.milestones
        for key in ("p", "r"):
            await theatre.press(key)
            await theatre.run(1)
        await theatre.press("u", "u")
        there = theatre.source.sample
        assert (there.step, there.t, there.readings) == (before.step, before.t, before.readings)
        assert (theatre.source.scene.name, theatre.source.stepping.h) == ("drift", 0.1)
        assert theatre.source.milestones == milestones
        await theatre.run(4)
        assert theatre.source.sample.t == pytest.approx(before.t + 4, abs=0.11)
        assert there.run == 5  # drift, the next, that again, that again, drift again
        theatre.source.close()
    assert verify(path).identical


async def test_what_is_shown_digits_t_y_e_and_w():
    async with lab() as theatre:
        await theatre.run(2)
        panes = theatre.stage.query_one(LabView).pendulums
        await theatre.press("1")
        await theatre.pilot.pause()
        assert [pane.is_on_screen for pane in panes] == [False, True, True, True, False, False]
        assert "Explicit" not in theatre.text(ErrorTable)
        await theatre.press("1", "5")
        assert theatre.stage.shown.exact
        dotted = panes[1].text
        await theatre.press("5")
        assert panes[1].text != dotted
        with_trails = panes[1].text
        await theatre.press("t")
        assert len(panes[1].text.split()) < len(with_trails.split())

        chart = theatre.stage.query_one(TimeChart)
        titles = [chart.border_title]
        for _ in quantities(DEFAULT_SCENE):
            await theatre.press("e")
            titles.append(chart.border_title)
        assert titles[0] == titles[-1] == "max |dE/E0| per half swing, all"
        assert len(set(titles)) == len(quantities(DEFAULT_SCENE))
        await theatre.press("y")
        assert chart.border_title == "energy error dE/E0, all"
        spans = set()
        for _ in WINDOWS:
            await theatre.press("w")
            spans.add(chart.border_title)
        assert len(spans) == len(WINDOWS)
        before = theatre.stage.shown
        await theatre.press("w", "W")
        assert theatre.stage.shown == before


async def test_capital_x_shows_one_method_alone_and_then_all_and_next_time_the_next_one():
    async with lab() as theatre:
        seen = []
        for _ in range(5):
            await theatre.press("X")
            seen.append("".join(USUAL_CAST[at].letter for at in theatre.stage.shown.places(USUAL_CAST)))
        assert seen == ["e", "esvr", "s", "esvr", "v"]
        await theatre.press("u")
        assert theatre.stage.shown.places(USUAL_CAST) == [0, 1, 2, 3]


async def test_a_click_on_a_row_or_a_pendulum_shows_that_method_alone_and_another_one_all():
    async with lab() as theatre:
        await theatre.run(1)
        for widget, offset in ((ErrorTable, (5, 3)), (theatre.stage.query_one(LabView).pendulums[2], (9, 5))):
            await theatre.pilot.click(widget, offset=offset)
            await theatre.run(0.1)
            assert theatre.stage.shown.places(USUAL_CAST) == [2]
            assert [line[:3] for line in theatre.text(ErrorTable).splitlines()[1:]] == ["3 v"]
            await theatre.pilot.click(ErrorTable, offset=(5, 1))
            await theatre.run(0.1)
            assert theatre.stage.shown.places(USUAL_CAST) == [0, 1, 2, 3]


async def test_a_click_on_an_event_goes_there_and_brackets_go_from_one_to_the_next():
    async with lab() as theatre:
        await theatre.run(12)
        first, over, *_ = [milestone.step for milestone in theatre.source.milestones]
        listed = theatre.stage.query_one(EventList)
        row = next(at for at, line in enumerate(listed.text.splitlines()) if "over the top" in line)
        await theatre.pilot.click(listed, offset=(8, row + 1))
        await theatre.pilot.pause()
        assert theatre.source.sample.step == first
        assert theatre.source.playhead.paused
        await theatre.press("]")
        assert theatre.source.sample.step == over
        await theatre.press("[", "[")
        assert theatre.source.sample.step == 0
        await theatre.press("r")
        go_to(theatre.stage, (1, first))
        await theatre.pilot.pause()
        assert "run 1" in [each.message for each in theatre.app._notifications][-1]


async def test_capital_o_puts_all_pendulums_on_one_pivot():
    async with lab() as theatre:
        view = theatre.stage.query_one(LabView)
        await theatre.press("O")
        await theatre.run(3)
        assert not any(pane.is_on_screen for pane in view.pendulums)
        assert view.overlay.is_on_screen
        for method in USUAL_CAST:
            assert method.letter in view.overlay.text
        await theatre.press("O")
        await theatre.run(0.1)
        assert not view.overlay.is_on_screen


async def test_a_listed_scene_starts_at_its_own_speed_and_u_brings_back_run_and_speed():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press("greater_than_sign", "P", "end", "enter")
        assert (theatre.source.scene.name, theatre.source.playhead.speed) == ("learned", 8.0)
        await theatre.press("u")
        assert (theatre.source.scene.name, theatre.source.playhead.speed) == ("drift", 2.0)
        assert theatre.source.sample.step == 20


async def test_the_form_takes_radians_and_degrees_and_starts_with_enter():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.press("i")
        form = theatre.app.screen
        assert isinstance(form, StartForm)
        await theatre.press(*"115deg", "tab", *"-2", "tab", *"0.01", "enter")
        await theatre.pilot.pause()
        scene = theatre.source.scene
        assert (scene.theta, scene.omega, scene.h) == (math.radians(115), -2.0, 0.01)
        assert (scene.length, scene.gravity, theatre.source.sample.step) == (1.0, 9.81, 0)


async def test_the_form_has_the_parameters_of_the_model_with_units_and_limits():
    async with lab(SCENES["stiff-slow"]) as theatre:
        await theatre.press("i")
        form = theatre.app.screen
        assert [field.id for field in form.query("Input")] == ["theta", "omega", "h", "length", "gravity", "stiffness"]
        assert "s⁻², 1 to 1e+18" in [str(label.render()) for label in form.query(".unit")]
        form.query_one("#stiffness").value = "0.5"
        await theatre.pilot.pause()
        assert "out of range" in str(form.query_one("#verdict").render())
        form.query_one("#stiffness").value = "400"
        await theatre.pilot.pause()
        assert str(form.query_one("#verdict").render()).endswith("h·omega_s = 0.4")
        await theatre.press("enter")
        await theatre.pilot.pause()
        assert theatre.source.scene == SCENES["stiff-slow"].altered(stiffness=400.0)


async def test_the_form_says_of_a_lab_whose_time_runs_backwards_that_a_run_begins_forward():
    async with lab() as theatre:
        await theatre.press("b", "i")
        form = theatre.app.screen
        assert form.query_one("#h").value == "0.05"
        assert "begins forward in time" in str(form.query_one("#verdict").render())
        await theatre.press("enter")
        await theatre.pilot.pause()
        assert theatre.source.stepping.h == 0.05


async def test_the_form_says_what_is_wrong_as_it_is_typed_and_does_not_start_that():
    async with lab() as theatre:
        await theatre.press("i")
        form = theatre.app.screen
        verdict = form.query_one("#verdict")
        for keys, words in (("abc", "not an angle"), ("1e99", "out of range"), ("", "not an angle")):
            await theatre.press("home", "shift+end", "delete", *keys)
            await theatre.pilot.pause()
            assert words in str(verdict.render())
            await theatre.press("enter")
            assert theatre.app.screen is form
        await theatre.press("escape")
        await theatre.pilot.pause()
        assert theatre.app.screen is theatre.stage
        assert theatre.source.scene == DEFAULT_SCENE


async def test_help_and_palette_open_and_close_and_the_lab_runs_on_behind():
    async with lab() as theatre:
        await theatre.press("question_mark")
        assert isinstance(theatre.app.screen, TextScreen)
        await theatre.run(1)
        assert theatre.source.sample.t == pytest.approx(1)
        await theatre.press("escape")
        assert theatre.app.screen is theatre.stage
        await theatre.press("ctrl+p")
        await theatre.pilot.pause()
        await theatre.press(*"double speed")
        await theatre.pilot.pause(0.3)
        await theatre.press("enter")
        await theatre.pilot.pause(0.1)
        assert theatre.source.playhead.speed == 2


async def test_q_leaves():
    async with lab() as theatre:
        await theatre.press("q")
        assert theatre.app.return_value is None
        assert not theatre.app.is_running or theatre.app._exit


async def test_a_click_on_the_key_line_does_what_the_key_does():
    async with lab() as theatre:
        row = theatre.text("KeyLine")
        for label, check in (
            ("Pause", lambda: theatre.source.playhead.paused),
            ("Larger h", lambda: theatre.source.stepping.h == 0.1),
        ):
            assert not check()
            await theatre.pilot.click("KeyLine", offset=(row.index(label) + 1, 0))
            await theatre.pilot.pause()
            assert check()


async def test_a_click_on_the_chart_the_events_or_the_title_of_phase_space_does_what_their_keys_do():
    async with lab() as theatre:
        await theatre.run(1)
        await theatre.pilot.click(TimeChart, offset=(20, 5))
        await theatre.run(0.1)
        assert theatre.stage.shown.quantity == "theta_error"
        await theatre.pilot.click("EventList", offset=(5, 2))
        await theatre.pilot.pause()
        assert theatre.app.screen.text_title == "Events"
        await theatre.press("escape")
        run = theatre.source.sample.run
        await theatre.pilot.click("PhasePane", offset=(5, 0))
        await theatre.pilot.pause()
        assert (theatre.stage.view, theatre.source.sample.run) == ("phase", run)


@pytest.mark.parametrize("keys", [(*LIVE, *COMMON), (*REPLAY, *COMMON)], ids=["lab", "replay"])
def test_the_help_names_every_key_and_no_key_has_two_meanings(keys):
    said = help_text(keys, Live(DEFAULT_SCENE))
    for key in keys:
        assert f"  {key.shown:<14}{key.does}" in said
    names = [name for key in keys if key.names for name in key.names.split(",")]
    assert len(names) == len(set(names))
